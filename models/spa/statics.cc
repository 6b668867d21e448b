#include "models/spa/statics.h"

#include <ceres/jet.h>
#include <fmt/format.h>

#include "error.h"

namespace continuum {
namespace {

using Dual = ceres::Jet<double, 3>;

SpaBase<Dual> AtRest(const SpaBase<double>& base) {
  SpaBase<Dual> at_rest;
  at_rest.R_WB = base.R_WB.cast<Dual>();
  return at_rest;
}

}  // namespace

Eigen::Vector3d SpaEquilibrium(const Spa<double>& spa, const Eigen::Vector3d& pressure,
                               const SpaBase<double>& base) {
  const Spa<Dual> dual(spa.parameters().Cast<Dual>(), spa.options());
  const SpaBase<Dual> at_rest = AtRest(base);
  const double longest_step = 0.2 * spa.parameters().L0;
  Eigen::Vector3d delta = Eigen::Vector3d::Zero();
  for (int iteration = 0; iteration < 50; ++iteration) {
    SpaState<Dual> state;
    for (int i = 0; i < 3; ++i) state.delta[i] = Dual(delta[i], i);
    const Eigen::Matrix<Dual, 3, 1> excess =
        dual.InverseDynamics(state, Eigen::Matrix<Dual, 3, 1>::Zero(), at_rest).tail<3>() -
        dual.Actuation(state.delta, pressure.cast<Dual>());
    Eigen::Vector3d residual;
    Eigen::Matrix3d stiffness;
    for (int i = 0; i < 3; ++i) {
      residual[i] = excess[i].a;
      stiffness.row(i) = excess[i].v.transpose();
    }
    // The paper's tip load is a follower: its stiffness is not symmetric, stability is that of the
    // symmetric part.
    const Eigen::Matrix3d symmetric = 0.5 * (stiffness + stiffness.transpose());
    if (!(symmetric.llt().info() == Eigen::Success)) break;
    Eigen::Vector3d step = stiffness.partialPivLu().solve(residual);
    if (step.norm() > longest_step) step *= longest_step / step.norm();
    delta -= step;
    if (step.norm() <= 1e-15 * spa.parameters().L0) return delta;
  }
  throw Error::Job(
      fmt::format("soft actuator: no stable equilibrium under {:.6g}, {:.6g}, {:.6g} Pa (last "
                  "tried δ = {:.6g}, "
                  "{:.6g}, {:.6g} m)",
                  pressure[0], pressure[1], pressure[2], delta[0], delta[1], delta[2]));
}

}  // namespace continuum
