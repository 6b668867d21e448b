#include "models/twin_pivot/response.h"

#include <algorithm>
#include <utility>

#include "models/statics/length_driven.h"
#include "models/twin_pivot/balance.h"
#include "models/twin_pivot/geometry.h"
#include "sim/numerics/linearize.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kLoads = 6;

/// Inputs: tip force over k/length, tip moment over k, tensions over k/r_1; k a joint's stiffness.
class RespondingRobot : public statics::Responding {
 public:
  RespondingRobot(const Robot& robot, const Load& load, Method method)
      : robot_(robot), load_(load), method_(method), stretch_(robot.cable_EA, load.length) {}

  VectorXd Units() const {
    VectorXd units(kLoads + robot_.Cables());
    const double k = robot_.Stiffness(), length = robot_.Length();
    units.head<3>().setConstant(k / length);
    units.segment<3>(3).setConstant(k);
    units.tail(robot_.Cables()).setConstant(k / robot_.r.front());
    return units;
  }

  bool Residual(const VectorXd& z, const VectorXd& w, VectorXd& f) const override {
    const Task task(robot_, At(w), method_);
    if (!Balance{task, 1, 1, robot_.eps}(z.data(), f.data())) return false;
    f /= robot_.Stiffness();
    return true;
  }
  bool Tangent(const VectorXd& z, MatrixXd& k) const override {
    const auto slope = ResidualSlope(robot_, load_, method_, z);
    if (!slope) return false;
    k = *slope / robot_.Stiffness();
    return true;
  }
  std::optional<statics::Shown> Show(const VectorXd& z, const VectorXd& w) const override {
    const auto discs = DiscFrames(robot_, z);
    const MatrixXd length = CableLengths(robot_, z);
    VectorXd rest = length.colwise().sum().transpose();
    if (load_.length.size() > 0) {
      const Task task(robot_, At(w), method_);
      std::vector<double> force;
      if (!CableForces(task, JointsAt(robot_, z), 1, robot_.eps, force)) return std::nullopt;
      const Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>> tension(
          force.data(), task.joints, task.cables);
      rest -= stretch_.Of(tension, length);
    }
    VectorXd points(3 * robot_.Joints());
    for (int m = 0; m < robot_.Joints(); ++m) {
      points.segment<3>(3 * m) = discs[static_cast<std::size_t>(m) + 1].translation();
    }
    const Eigen::Quaterniond frame(discs.back().rotation());
    return statics::Shown{discs.back().translation(), frame, rest, points};
  }
  // Contacts turn within eps.
  double Step(Eigen::Index /*unknown*/) const override {
    return std::min(1e-5, 1e-3 * robot_.eps / robot_.r.front());
  }

 private:
  Load At(const VectorXd& w) const {
    const VectorXd change = Units().cwiseProduct(w);
    Load load = load_;
    load.force += change.head<3>();
    load.moment += change.segment<3>(3);
    for (int j = 0; j < robot_.Cables(); ++j) {
      load.tension[static_cast<std::size_t>(j)] += change[kLoads + j];
    }
    return load;
  }

  const Robot& robot_;
  const Load& load_;
  Method method_;
  statics::CableStretch stretch_;
};

}  // namespace

std::optional<statics::TipResponse> Respond(const Robot& robot, const Load& load, Method method,
                                            const Solution& solution) {
  const RespondingRobot responding(robot, load, method);
  const VectorXd units = responding.Units();
  auto slopes = statics::Respond(responding, solution.beta, units.size());
  if (!slopes) return std::nullopt;
  statics::TipResponse response{{"fx", "fy", "fz", "Mx", "My", "Mz"}, kLoads, {}};
  response.slope = *slopes * units.cwiseInverse().asDiagonal();
  for (const auto& name : statics::Numbered("F", robot.Cables())) response.input.push_back(name);
  if (load.length.size() == 0) return response;
  return statics::HoldLengths(response, VectorXd::Map(load.tension.data(), robot.Cables()));
}

}  // namespace continuum::twin_pivot
