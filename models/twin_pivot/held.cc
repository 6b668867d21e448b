#include "models/twin_pivot/held.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "models/twin_pivot/balance.h"
#include "models/twin_pivot/geometry.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

struct Body {
  double mass;
  Vector3d place;
};

// Everything that weighs, in the base frame.
std::vector<Body> Bodies(const Task& task, const VectorXd& beta) {
  const Robot& robot = task.robot;
  const auto discs = DiscFrames(robot, beta);
  const auto joint = JointsAt(robot, beta);
  std::vector<Body> bodies = {{task.payload, discs.back().translation()}};
  for (int m = 0; m < task.joints; ++m) {
    const auto at = static_cast<std::size_t>(m);
    const Eigen::Isometry3d& before = discs[at];
    bodies.push_back({task.m_D, discs[at + 1].translation()});
    bodies.push_back({task.m_NiTi, before * Vector3d(joint[at].centre.x, joint[at].centre.y, 0)});
    for (int j = 0; j < task.cables; ++j) {
      const auto cable = static_cast<std::size_t>(j);
      if (m >= task.anchor[cable]) continue;
      const double y = task.Y(m, j);
      const auto hole = joint[at].Hole(y);
      const Vector3d middle(0.5 * (0.5 * robot.h + hole.x), 0.5 * (y + hole.y), task.Z(m, j));
      bodies.push_back({task.rho * joint[at].Length(y), before * middle});
      if (task.anchor[cable] != m + 1) continue;
      const Vector3d lock(0.5 * robot.h, task.hole_y[cable], task.hole_z[cable]);
      bodies.push_back({task.m_CL, discs[at + 1] * lock});
    }
  }
  return bodies;
}

double Potential(const Task& task, const VectorXd& beta) {
  double energy = 0.5 * task.robot.Stiffness() * beta.squaredNorm();
  const VectorXd length = CableLengths(task.robot, beta).colwise().sum();
  for (int j = 0; j < task.cables; ++j) {
    energy += task.tension[static_cast<std::size_t>(j)] * length[j];
  }
  for (const Body& body : Bodies(task, beta)) energy -= body.mass * task.gravity.dot(body.place);
  return energy - task.force.dot(DiscFrames(task.robot, beta).back().translation());
}

}  // namespace

double Energy(const Robot& robot, const Load& load, const VectorXd& beta) {
  if (!load.moment.isZero(0)) return std::numeric_limits<double>::quiet_NaN();
  const Task task(robot, load, Method::kVirtualWork);
  return Potential(task, beta) - Potential(task, VectorXd::Zero(beta.size()));
}

Held Describe(const Robot& robot, const Load& load, const Solution& solution) {
  const Task task(robot, load, Method::kVirtualWork);
  const Eigen::Isometry3d tip = DiscFrames(robot, solution.beta).back();
  Held held{{}, solution.length.colwise().sum(), Energy(robot, load, solution.beta)};
  held.hold.tip = Eigen::Quaterniond(tip.rotation());
  held.hold.force = task.force;
  held.hold.moment = task.moment + tip.translation().cross(task.force);
  for (const Body& body : Bodies(task, solution.beta)) {
    held.hold.force += body.mass * task.gravity;
    held.hold.moment += body.place.cross(body.mass * task.gravity);
  }
  const double diameter = std::pow(64 * robot.I_z / std::numbers::pi, 0.25);
  held.hold.strain = 0.5 * diameter / robot.L * solution.beta.cwiseAbs().maxCoeff();
  return held;
}

std::vector<statics::ShapeTable::Place> Places(const Robot& robot, const Solution& solution,
                                               int per_rod) {
  const auto discs = DiscFrames(robot, solution.beta);
  const auto points = CentreLine(robot, solution.beta, per_rod);
  const double pitch = robot.L + robot.h;
  std::vector<statics::ShapeTable::Place> places;
  std::size_t point = 0;
  for (int m = 0; m <= robot.Joints(); ++m) {
    const auto at = static_cast<std::size_t>(m);
    const bool last = m == robot.Joints();
    const VectorXd tension = last ? VectorXd(VectorXd::Zero(robot.Cables()))
                                  : VectorXd(solution.tension.row(m).transpose());
    const Eigen::Quaterniond frame(discs[at].rotation());
    places.push_back({m * pitch, m, points[point++], frame, tension});
    for (int i = 0; i < per_rod && !last; ++i) {
      const double share = static_cast<double>(i) / (per_rod - 1);
      const Eigen::AngleAxisd bent(share * solution.beta[m], Vector3d::UnitZ());
      places.push_back({m * pitch + 0.5 * robot.h + share * robot.L, -1, points[point++],
                        frame * Eigen::Quaterniond(bent), tension});
    }
  }
  return places;
}

}  // namespace continuum::twin_pivot
