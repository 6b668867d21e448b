#include "models/twin_pivot/winches.h"

#include <algorithm>
#include <optional>

#include "models/statics/length_driven.h"
#include "models/twin_pivot/geometry.h"
#include "models/twin_pivot/rising.h"
#include "sim/numerics/linearize.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The robot for statics::LengthDriven; f over a joint's stiffness.
class Plant {
 public:
  Plant(const Task& from, const Task& to, const VectorXd& given)
      : from_(from), to_(to), now_(to), stretch_(to.robot.cable_EA, given) {}

  double unit() const { return to_.robot.Stiffness() / reach(); }
  double reach() const { return to_.robot.r.front(); }

  void SetLoad(double load) {
    const std::vector<double> tension = now_->tension;
    now_.emplace(to_.Between(from_, load));
    now_->tension = tension;
  }
  void SetWidth(double width) { width_ = width; }
  void SetTension(const VectorXd& tension) { now_->tension.assign(tension.begin(), tension.end()); }

  bool Residual(const VectorXd& x, VectorXd& f) {
    if (!Now()(x.data(), f.data())) return false;
    f /= to_.robot.Stiffness();
    return true;
  }
  bool Linearize(const VectorXd& x, VectorXd& f, MatrixXd& k) {
    if (!numerics::Linearize(Now(), x, f, k)) return false;
    f /= to_.robot.Stiffness();
    k /= to_.robot.Stiffness();
    return true;
  }
  VectorXd Lengths(const VectorXd& x) {
    return CableLengths(to_.robot, x).colwise().sum().transpose();
  }
  MatrixXd LengthSlopes(const VectorXd& x) { return CableSlopes(to_, x); }
  VectorXd Compliance(const VectorXd& tension) const { return stretch_.Compliance(tension); }
  VectorXd Stretch(const VectorXd& x) {
    std::vector<double> force;
    // Residual() has refused the x that have no forces.
    if (!CableForces(*now_, JointsAt(to_.robot, x), 1, eps(), force)) {
      return VectorXd::Zero(to_.cables);
    }
    const Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>> tension(
        force.data(), to_.joints, to_.cables);
    return stretch_.Of(tension, CableLengths(to_.robot, x));
  }
  int Unstable(const VectorXd& x, const VectorXd& held) {
    return UnstableDirections(Now(), x, held);
  }

 private:
  double eps() const { return std::max(width_, to_.robot.eps); }
  Balance Now() const { return Balance{*now_, 1, 1, eps()}; }

  const Task& from_;
  const Task& to_;
  std::optional<Task> now_;
  double width_ = 0;
  statics::CableStretch stretch_;
};

}  // namespace

numerics::Outcome FollowWinches(const Task& from, const Task& to, const VectorXd& before,
                                const VectorXd& given, VectorXd& beta, VectorXd& tension,
                                statics::Stability& stability) {
  Plant plant(from, to, given);
  return statics::FollowLengths(plant, before, given, beta, tension, stability);
}

}  // namespace continuum::twin_pivot
