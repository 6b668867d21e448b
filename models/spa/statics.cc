#include "models/spa/statics.h"

#include <ceres/jet.h>
#include <fmt/format.h>

#include "error.h"
#include "sim/numerics/newton.h"

namespace continuum {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
using Dual = ceres::Jet<double, 3>;

// Generalized forces out of balance under constant pressures, in units of k_dL1 L0, by δ/L0.
class Balance {
 public:
  Balance(const Spa<double>& spa, const Vector3d& pressure, const SpaBase<double>& base)
      : spa_(spa), dual_(spa.parameters().Cast<Dual>(), spa.options()), pressure_(pressure) {
    at_rest_.R_WB = base.R_WB;
    dual_at_rest_.R_WB = base.R_WB.cast<Dual>();
  }

  bool operator()(const double* x, double* f) const {
    const Vector3d delta = Vector3d(x) * spa_.parameters().L0;
    (Eigen::Map<Vector3d>(f)) = Excess(spa_, delta, at_rest_) / Unit();
    return true;
  }

  // False where the equilibrium would not be stable. The paper's tip load is a follower: its
  // stiffness is not symmetric, stability is that of the symmetric part.
  bool Jacobian(const Vector3d& x, Vector3d& f, Matrix3d& stiffness) const {
    Eigen::Matrix<Dual, 3, 1> delta;
    for (int i = 0; i < 3; ++i) delta[i] = Dual(x[i] * spa_.parameters().L0, i);
    const Eigen::Matrix<Dual, 3, 1> excess = Excess(dual_, delta, dual_at_rest_);
    for (int i = 0; i < 3; ++i) {
      f[i] = excess[i].a / Unit();
      stiffness.row(i) = excess[i].v.transpose() / spa_.parameters().k_dL1;
    }
    const Matrix3d symmetric = 0.5 * (stiffness + stiffness.transpose());
    return symmetric.llt().info() == Eigen::Success;
  }

 private:
  double Unit() const { return spa_.parameters().k_dL1 * spa_.parameters().L0; }

  template <class T>
  Eigen::Matrix<T, 3, 1> Excess(const Spa<T>& spa, const Eigen::Matrix<T, 3, 1>& delta,
                                const SpaBase<T>& base) const {
    SpaState<T> state;
    state.delta = delta;
    return spa.InverseDynamics(state, Eigen::Matrix<T, 3, 1>::Zero(), base).template tail<3>() -
           spa.Actuation(delta, pressure_.cast<T>());
  }

  const Spa<double>& spa_;
  Spa<Dual> dual_;
  Vector3d pressure_;
  SpaBase<double> at_rest_;
  SpaBase<Dual> dual_at_rest_;
};

}  // namespace

Vector3d SpaEquilibrium(const Spa<double>& spa, const Vector3d& pressure,
                        const SpaBase<double>& base) {
  const Balance balance(spa, pressure, base);
  numerics::Options options;
  options.tolerance = 0;  // until rounding allows no further decrease
  options.max_step = 0.2;
  Vector3d x = Vector3d::Zero(), f;
  Matrix3d stiffness;
  const numerics::Outcome outcome = numerics::Newton(balance, x, options);
  const Vector3d delta = spa.parameters().L0 * x;
  if (outcome.ok() && balance.Jacobian(x, f, stiffness)) return delta;
  throw Error::Job(
      fmt::format("soft actuator: no stable equilibrium under {:.6g}, {:.6g}, {:.6g} Pa (last "
                  "tried δ = {:.6g}, "
                  "{:.6g}, {:.6g} m)",
                  pressure[0], pressure[1], pressure[2], delta[0], delta[1], delta[2]));
}

}  // namespace continuum
