#include "models/tdcr/details.h"

#include <algorithm>
#include <cmath>

#include "models/tdcr/disks.h"
#include "models/tdcr/unit_rod.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;
using statics::Details;

bool OfDisks(Method method) { return method == Method::kEas || method == Method::kPcca; }

// The integral of f(u) over an arc by Simpson's rule: u at its places, which are of an odd number;
// at the last one that of the line's `ends`, just before the disk.
template <class F>
double OverArc(const Line& line, int arc, F&& f) {
  const Eigen::Index parts = (line.s.size() - 1) / line.ends.cols(), first = arc * parts;
  const double h = (line.s[first + parts] - line.s[first]) / static_cast<double>(parts);
  double sum =
      f(Vector3d(line.u.col(first)), first) + f(Vector3d(line.ends.col(arc)), first + parts);
  for (Eigen::Index i = 1; i < parts; ++i) {
    sum += (i % 2 == 1 ? 4 : 2) * f(Vector3d(line.u.col(first + i)), first + i);
  }
  return h / 3 * sum;
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

// What an arc of a section holds; `natural` as a rotation vector.
void DescribeArc(const Section& section, const Vector3d& gravity, int arc, const Line& line,
                 Details& details) {
  const Vector3d natural(-section.natural.y(), section.natural.x(), section.natural.z());
  const Vector3d stiffness(section.EI, section.EI, section.GJ);
  details.energy += OverArc(line, arc, [&](const Vector3d& u, Eigen::Index /*place*/) {
    const Vector3d strain = u - natural;
    const double bend = strain.head<2>().norm() * section.diameter / 2;
    details.strain = std::max(details.strain, bend);
    return strain.dot(stiffness.cwiseProduct(strain)) / 2;
  });
  Vector3d middle;
  for (int axis = 0; axis < 3; ++axis) {
    middle[axis] = OverArc(line, arc, [&](const Vector3d& /*u*/, Eigen::Index place) {
      return line.points(axis, place);
    });
  }
  const Eigen::Index parts = (line.s.size() - 1) / line.ends.cols();
  const double from = line.s[arc * parts], to = line.s[(arc + 1) * parts];
  AddDead(section.mass_per_length * (to - from) * gravity, middle / (to - from),
          Straight((from + to) / 2), details);
}

void DescribeRod(const Robot& robot, const Loads& loads, const Solution& solution,
                 Details& details) {
  details.length = TendonLengths(robot, solution.line);
  const RodShape shape(robot);
  int disk = 0;
  for (const Section& section : robot.Sections()) {
    for (std::size_t i = 0; i < section.disks.size(); ++i, ++disk) {
      for (auto arc = shape.ArcsTo(disk); arc < shape.ArcsTo(disk + 1); ++arc) {
        DescribeArc(section, loads.gravity, static_cast<int>(arc), solution.line, details);
      }
      AddDead(section.disk_mass * loads.gravity, solution.disks.col(disk),
              Straight(robot.Place(disk + 1)), details);
    }
  }
  for (Eigen::Index i = 0; i < loads.disk_force.cols(); ++i) {
    AddDead(loads.disk_force.col(i), solution.disks.col(i),
            Straight(robot.Place(static_cast<int>(i) + 1)), details);
  }
  details.moment += loads.disk_moment.rowwise().sum();
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
  const Eigen::VectorXd rest = RestLengths(robot);
  for (int k = 0; k < robot.tendons; ++k) {
    const double tension = loads.tension[static_cast<std::size_t>(k)];
    details.energy += tension * (details.length[k] - rest[k]);
  }
  return details;
}

Eigen::VectorXd TendonLengths(const Robot& robot, const Line& line) {
  const RodShape shape(robot);
  Eigen::VectorXd length = Eigen::VectorXd::Zero(robot.tendons);
  for (int k = 0; k < robot.tendons; ++k) {
    const auto tendon = static_cast<std::size_t>(k);
    for (std::size_t arc = 0; arc < shape.ends[tendon]; ++arc) {
      const Channel& channel = shape.At(tendon, arc);
      length[k] += OverArc(line, static_cast<int>(arc), [&](const Vector3d& u, Eigen::Index place) {
        const Vector3d unit = robot.length * u;
        return Along(channel.At(line.s[place] / robot.length), unit).norm();
      });
    }
  }
  return length;
}

Line LineOf(const Robot& robot, const Loads& loads, Method method, const Solution& solution) {
  return OfDisks(method) ? LineOfArcs(robot, solution.u, Tensions(robot, loads, solution))
                         : solution.line;
}

}  // namespace continuum::tdcr
