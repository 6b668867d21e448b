#include "models/tdcr/figure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "models/tdcr/disks.h"

namespace continuum::tdcr {
namespace {

constexpr double kRim = 1.2;  // radius of a disk over that of its holes; the file does not give it
constexpr int kParts = 4;     // points of the rod for each arc

/// The rod as it is drawn: frames at its disks and between them.
struct Drawn {
  Chain chain;
  std::vector<std::size_t> disks{0};  ///< places of the disks; 0 is the base
};

// kParts for each arc of constant curvature, or the places along the Cosserat rod.
Drawn FineChain(const Robot& robot, const Solution& solution) {
  const Line& line = solution.line;
  if (line.s.size() == 0) {
    Eigen::Matrix3Xd fine(3, kParts * robot.disks);
    for (int i = 0; i < fine.cols(); ++i) fine.col(i) = solution.u.col(i / kParts);
    Drawn drawn{Forward(Eigen::VectorXd::Constant(fine.cols(), robot.arc() / kParts), fine)};
    for (int i = 1; i <= robot.disks; ++i)
      drawn.disks.push_back(static_cast<std::size_t>(i * kParts));
    return drawn;
  }
  Drawn drawn;
  for (Eigen::Index i = 0; i < line.s.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    drawn.chain.O.emplace_back(line.points.col(i));
    drawn.chain.R.push_back(line.frames[at].toRotationMatrix());
    if (line.disk[at] > 0) drawn.disks.push_back(at);
  }
  return drawn;
}

statics::Drive Tendon(const Robot& robot, const Loads& loads, const Drawn& drawn, int tendon) {
  statics::Drive drive;
  drive.active = loads.tension[static_cast<std::size_t>(tendon)] > 0;
  const Route route = robot.RouteOf(tendon);
  for (std::size_t disk = 0; disk < route.radius.size(); ++disk) {
    const std::size_t i = drawn.disks[disk];
    const Eigen::Vector3d hole(route.radius[disk] * std::cos(route.angle[disk]),
                               route.radius[disk] * std::sin(route.angle[disk]), 0);
    drive.line.emplace_back(drawn.chain.O[i] + drawn.chain.R[i] * hole);
  }
  return drive;
}

// Its given radius, or kRim times that of its outermost hole.
double RadiusOf(const Robot& robot, const std::vector<Section>& sections, int disk) {
  double radius = 0;
  for (int k = 0; k < robot.tendons; ++k) {
    const Route route = robot.RouteOf(k);
    if (disk <= route.end())
      radius = std::max(radius, route.radius[static_cast<std::size_t>(disk)]);
  }
  auto rest = static_cast<std::size_t>(disk);
  for (const Section& section : sections) {
    if (rest <= section.disks.size()) {
      return section.disk_radius > 0 ? section.disk_radius
                                     : kRim * std::max(radius, section.diameter / 2);
    }
    rest -= section.disks.size();
  }
  return kRim * radius;
}

}  // namespace

statics::Figure EmptyFigure(const Robot& robot) {
  statics::Figure figure;
  figure.axis = 2;
  figure.base_radius = 1.5 * robot.tendon_radius;
  return figure;
}

statics::Shape ShapeOf(const Robot& robot, const Loads& loads, const Solution& solution,
                       const Measured* measured) {
  const Drawn drawn = FineChain(robot, solution);
  const std::vector<Section> sections = robot.Sections();
  statics::Shape shape;
  shape.backbone = drawn.chain.O;
  shape.diameter = robot.diameter;
  for (int i = 0; i < robot.disks; ++i) {
    const std::size_t at = drawn.disks[static_cast<std::size_t>(i + 1)];
    shape.discs.push_back(
        {solution.disks.col(i), drawn.chain.R[at].col(2), RadiusOf(robot, sections, i + 1)});
  }
  for (int k = 0; k < robot.tendons; ++k) shape.drives.push_back(Tendon(robot, loads, drawn, k));
  if (measured != nullptr) {
    const Eigen::Matrix3Xd points = robot.MeasuringToBase() * measured->disks;
    for (int i = 0; i < robot.disks; ++i) {
      if (measured->Has(i)) shape.measured.emplace_back(points.col(i));
    }
  }
  shape.force = loads.tip_force;
  shape.gravity = loads.gravity;
  shape.load = std::accumulate(loads.tension.begin(), loads.tension.end(), 0.0);
  return shape;
}

}  // namespace continuum::tdcr
