#include "models/tdcr/held.h"

#include <algorithm>
#include <cmath>

#include "models/tdcr/disks.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;

bool OfDisks(Method method) { return method == Method::kEas || method == Method::kPcca; }

// Weights of an integral over the places by Simpson's rule, times their distance; the number of
// places is odd.
Eigen::VectorXd Simpson(const Eigen::VectorXd& s) {
  const Eigen::Index last = s.size() - 1;
  const double h = s[last] / static_cast<double>(last);
  Eigen::VectorXd weights(s.size());
  for (Eigen::Index i = 0; i <= last; ++i) {
    weights[i] = h / 3 * (i == 0 || i == last ? 1 : i % 2 == 1 ? 4 : 2);
  }
  return weights;
}

// Adds dead forces F at p, and takes their work from the straight robot, where they act at s.
void AddDead(const Vector3d& force, const Vector3d& p, double s, Held& held) {
  held.force += force;
  held.moment += p.cross(force);
  held.energy -= force.dot(p - Vector3d(0, 0, s));
}

double ElasticPerLength(const Robot& robot, const Vector3d& u) {
  return (robot.EI() * u.head<2>().squaredNorm() + robot.GJ() * u.z() * u.z()) / 2;
}

// Kappa and tau of an arc as u = (-kappa_y, kappa_x, tau).
Held OfArcs(const Robot& robot, const Loads& loads, const Solution& solution) {
  Held held{Eigen::VectorXd::Zero(robot.tendons), Vector3d::Zero(), Vector3d::Zero(), 0, 0};
  const double mass = robot.disk_mass + robot.density * robot.area() * robot.arc();
  for (int i = 0; i < robot.disks; ++i) {
    const Vector3d u = solution.u.col(i);
    const Arc arc(robot.arc(), u);
    Chord chord;
    for (int k = 0; k < robot.tendons; ++k) {
      if (TendonChord(arc, robot.Hole(k), false, chord)) held.length[k] += chord.length;
    }
    held.energy += robot.arc() * ElasticPerLength(robot, u);
    held.strain = std::max(held.strain, u.head<2>().norm() * robot.diameter / 2);
    AddDead(mass * loads.gravity, solution.disks.col(i), (i + 1) * robot.arc(), held);
  }
  AddDead(loads.tip_force, solution.disks.rightCols<1>(), robot.length, held);
  return held;
}

// Of every tendon in every arc, n x m [N], by (13) with the contacts' shares.
Eigen::MatrixXd Tensions(const Robot& robot, const Loads& loads, const Solution& solution) {
  Eigen::MatrixXd tension(robot.disks, robot.tendons);
  const Eigen::MatrixXd& share = solution.contacts.share;
  for (int k = 0; k < robot.tendons; ++k) {
    double pull = loads.tension[static_cast<std::size_t>(k)];
    Chord chord, before;
    for (int i = 0; i < robot.disks; ++i) {
      TendonChord(Arc(robot.arc(), solution.u.col(i)), robot.Hole(k), false, chord);
      const double s = i > 0 ? share(i - 1, k) : 0;
      if (s != 0 && loads.mu > 0) {
        const int side = s < 0 ? -1 : 1;
        pull *= FrictionRatio(before.end, chord.start, loads.mu * std::abs(s), side).x;
      }
      tension(i, k) = pull;
      before = chord;
    }
  }
  return tension;
}

Held OfRod(const Robot& robot, const Loads& loads, const Solution& solution) {
  const Line& line = solution.line;
  Held held{Eigen::VectorXd::Zero(robot.tendons), Vector3d::Zero(), Vector3d::Zero(), 0, 0};
  const Eigen::VectorXd weights = Simpson(line.s);
  const Vector3d per_length = robot.density * robot.area() * loads.gravity;
  for (Eigen::Index i = 0; i < line.s.size(); ++i) {
    const Vector3d u = line.u.col(i);
    for (int k = 0; k < robot.tendons; ++k) {
      const Vector3d hole(robot.Hole(k).x(), robot.Hole(k).y(), 0);
      held.length[k] += weights[i] * (Vector3d::UnitZ() + u.cross(hole)).norm();
    }
    held.energy += weights[i] * ElasticPerLength(robot, u);
    held.strain = std::max(held.strain, u.head<2>().norm() * robot.diameter / 2);
    AddDead(weights[i] * per_length, line.points.col(i), line.s[i], held);
  }
  for (int i = 0; i < robot.disks; ++i) {
    AddDead(robot.disk_mass * loads.gravity, solution.disks.col(i), (i + 1) * robot.arc(), held);
  }
  AddDead(loads.tip_force, solution.disks.rightCols<1>(), robot.length, held);
  return held;
}

}  // namespace

Held Describe(const Robot& robot, const Loads& loads, Method method, const Solution& solution) {
  Held held = OfDisks(method) ? OfArcs(robot, loads, solution) : OfRod(robot, loads, solution);
  for (int k = 0; k < robot.tendons; ++k) {
    held.energy += loads.tension[static_cast<std::size_t>(k)] * (held.length[k] - robot.length);
  }
  return held;
}

Line LineOf(const Robot& robot, const Loads& loads, Method method, const Solution& solution) {
  return OfDisks(method) ? LineOfArcs(robot, solution.u, Tensions(robot, loads, solution))
                         : solution.line;
}

}  // namespace continuum::tdcr
