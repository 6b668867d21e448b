#include "models/stiff_flop/figure.h"

#include <Eigen/Geometry>

namespace continuum::stiff_flop {
namespace {

// Turns that carry the base frame along a line without twist about its tangent.
std::vector<Eigen::Quaterniond> Carried(const std::vector<Eigen::Vector3d>& line) {
  std::vector<Eigen::Quaterniond> turns = {Eigen::Quaterniond::Identity()};
  for (std::size_t i = 1; i < line.size(); ++i) {
    const std::size_t next = std::min(i + 1, line.size() - 1);
    const Eigen::Vector3d before = turns.back() * Eigen::Vector3d::UnitY();
    const Eigen::Vector3d tangent = line[next] - line[i - 1];
    turns.push_back(Eigen::Quaterniond::FromTwoVectors(before, tangent) * turns.back());
  }
  return turns;
}

}  // namespace

statics::Figure EmptyFigure(const Module& module) {
  statics::Figure figure;
  figure.axis = 1;
  figure.base_radius = 1.3 * module.r_2;
  figure.drive_name = "pressure line";
  figure.idle_drive_name = "vented line";
  figure.load_name = "sum of pressures [kPa]";
  return figure;
}

statics::Shape ShapeOf(const Module& module, Direction direction, const Case& row,
                       const Solution& solution, const std::vector<Eigen::Vector3d>& axis) {
  const Eigen::Vector3d& pressure = direction == Direction::kForward ? row.given : solution.answer;
  statics::Shape shape;
  shape.label = row.label;
  shape.backbone = axis;
  shape.diameter = 2 * module.r_2;
  const std::vector<Eigen::Quaterniond> turns = Carried(axis);
  for (std::size_t i = 0; i < kLine.size(); ++i) {
    const Eigen::Vector3d place(module.r_o * kLine[i][0], 0, -module.r_o * kLine[i][1]);
    statics::Drive drive{{}, pressure[static_cast<Eigen::Index>(i)] != 0};
    for (std::size_t k = 0; k < axis.size(); ++k)
      drive.line.emplace_back(axis[k] + turns[k] * place);
    shape.drives.push_back(std::move(drive));
  }
  if (module.l_fs > 0) shape.mount = {axis.back(), axis.back() + module.l_fs * solution.tangent};
  shape.force = row.load.force;
  shape.gravity = row.load.gravity;
  shape.load = 1e-3 * pressure.sum();
  return shape;
}

}  // namespace continuum::stiff_flop
