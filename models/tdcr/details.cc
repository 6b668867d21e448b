#include "models/tdcr/details.h"

#include <algorithm>
#include <cmath>

#include "models/tdcr/disks.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;
using statics::Details;

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

// Of a point of the straight rod.
Vector3d Straight(double s) { return {0, 0, s}; }

double ElasticPerLength(const Robot& robot, const Vector3d& u) {
  return (robot.EI() * u.head<2>().squaredNorm() + robot.GJ() * u.z() * u.z()) / 2;
}

// Kappa and tau of an arc as u = (-kappa_y, kappa_x, tau).
void DescribeArcs(const Robot& robot, const Loads& loads, const Solution& solution,
                  Details& details) {
  const double mass = robot.disk_mass + robot.density * robot.area() * robot.arc();
  for (int i = 0; i < robot.disks; ++i) {
    const Vector3d u = solution.u.col(i);
    const Arc arc(robot.arc(), u);
    Chord chord;
    for (int k = 0; k < robot.tendons; ++k) {
      if (TendonChord(arc, robot.Hole(k), false, chord)) details.length[k] += chord.length;
    }
    details.energy += robot.arc() * ElasticPerLength(robot, u);
    details.strain = std::max(details.strain, u.head<2>().norm() * robot.diameter / 2);
    AddDead(mass * loads.gravity, solution.disks.col(i), Straight((i + 1) * robot.arc()), details);
  }
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

void DescribeRod(const Robot& robot, const Loads& loads, const Solution& solution,
                 Details& details) {
  const Line& line = solution.line;
  details.length = TendonLengths(robot, line);
  const Eigen::VectorXd weights = Simpson(line.s);
  const Vector3d per_length = robot.density * robot.area() * loads.gravity;
  for (Eigen::Index i = 0; i < line.s.size(); ++i) {
    const Vector3d u = line.u.col(i);
    details.energy += weights[i] * ElasticPerLength(robot, u);
    details.strain = std::max(details.strain, u.head<2>().norm() * robot.diameter / 2);
    AddDead(weights[i] * per_length, line.points.col(i), Straight(line.s[i]), details);
  }
  for (int i = 0; i < robot.disks; ++i) {
    AddDead(robot.disk_mass * loads.gravity, solution.disks.col(i), Straight((i + 1) * robot.arc()),
            details);
  }
}

}  // namespace

Details Describe(const Robot& robot, const Loads& loads, Method method, const Solution& solution) {
  Details details;
  details.length = Eigen::VectorXd::Zero(robot.tendons);
  details.pull = solution.pull;
  details.tip = LineOf(robot, loads, method, solution).frames.back();
  if (OfDisks(method)) {
    DescribeArcs(robot, loads, solution, details);
  } else {
    DescribeRod(robot, loads, solution, details);
  }
  AddDead(loads.tip_force, solution.disks.rightCols<1>(), Straight(robot.length), details);
  for (int k = 0; k < robot.tendons; ++k) {
    const double tension = loads.tension[static_cast<std::size_t>(k)];
    details.energy += tension * (details.length[k] - robot.length);
  }
  return details;
}

Eigen::VectorXd TendonLengths(const Robot& robot, const Line& line) {
  const Eigen::VectorXd weights = Simpson(line.s);
  Eigen::VectorXd length = Eigen::VectorXd::Zero(robot.tendons);
  for (int k = 0; k < robot.tendons; ++k) {
    const Vector3d hole(robot.Hole(k).x(), robot.Hole(k).y(), 0);
    for (Eigen::Index i = 0; i < line.s.size(); ++i) {
      length[k] += weights[i] * (Vector3d::UnitZ() + line.u.col(i).cross(hole)).norm();
    }
  }
  return length;
}

Line LineOf(const Robot& robot, const Loads& loads, Method method, const Solution& solution) {
  return OfDisks(method) ? LineOfArcs(robot, solution.u, Tensions(robot, loads, solution))
                         : solution.line;
}

}  // namespace continuum::tdcr
