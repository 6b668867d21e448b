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

statics::Figure EmptyFigure(const ModuleSeries& series) {
  statics::Figure figure;
  figure.axis = 1;
  figure.base_radius = 1.3 * series.first().r_2;
  figure.drive_name = "pressure line";
  figure.idle_drive_name = "vented line";
  figure.load_name = "sum of pressures [kPa]";
  return figure;
}

statics::Shape ShapeOf(const ModuleSeries& series, Direction direction, const Case& row,
                       const Solution& solution, const std::vector<statics::Line>& axes) {
  const Eigen::VectorXd& pressure = direction == Direction::kForward ? row.given : solution.answer;
  statics::Shape shape;
  shape.label = row.label;
  shape.diameter = 2 * series.first().r_2;
  for (const statics::Line& axis : axes) {
    shape.backbone.insert(shape.backbone.end(), axis.begin(), axis.end());
  }
  const std::vector<Eigen::Quaterniond> turns = Carried(shape.backbone);
  std::size_t start = 0;
  for (std::size_t j = 0; j < series.size(); ++j) {
    const Module& module = series[j];
    const Eigen::VectorXd p = series.PressuresOf(j, pressure);
    for (std::size_t i = 0; i < module.lines.size(); ++i) {
      const LineAngle& angle = module.lines[i];
      const Eigen::Vector3d place(module.r_o * angle[0], 0, -module.r_o * angle[1]);
      statics::Drive drive{{}, p[static_cast<Eigen::Index>(i)] != 0};
      for (std::size_t k = 0; k < axes[j].size(); ++k) {
        drive.line.emplace_back(axes[j][k] + turns[start + k] * place);
      }
      shape.drives.push_back(std::move(drive));
    }
    start += axes[j].size();
  }
  const double l_fs = series.last().l_fs;
  if (l_fs > 0)
    shape.mount = {shape.backbone.back(), shape.backbone.back() + l_fs * solution.tangent};
  shape.force = row.load.force;
  shape.gravity = row.load.gravity;
  shape.load = 1e-3 * pressure.sum();
  return shape;
}

}  // namespace continuum::stiff_flop
