#include "models/twin_pivot/figure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "models/twin_pivot/geometry.h"

namespace continuum::twin_pivot {
namespace {

constexpr double kRim = 1.4;  // radius of a disc over that of its holes; the file does not give it

double Rim(const Robot& robot) { return kRim * *std::max_element(robot.r.begin(), robot.r.end()); }

// From face to face of every disc up to the one that holds its end.
statics::Drive Cable(const Robot& robot, const Load& load,
                     const std::vector<Eigen::Isometry3d>& discs, int cable) {
  const auto j = static_cast<std::size_t>(cable);
  const double y = robot.r[j] * std::cos(robot.phi[j]), z = robot.r[j] * std::sin(robot.phi[j]);
  statics::Drive drive{{}, load.tension[j] > 0};
  for (int m = 0; m <= robot.Anchor(cable); ++m) {
    const bool odd = m % 2 == 1;
    for (const double face : {-0.5, 0.5}) {
      const Eigen::Vector3d hole(face * robot.Thickness(m), odd ? z : y, odd ? -y : z);
      drive.line.emplace_back(discs[static_cast<std::size_t>(m)] * hole);
    }
  }
  return drive;
}

}  // namespace

statics::Figure EmptyFigure(const Robot& robot) {
  statics::Figure figure;
  figure.axis = 0;
  figure.base_radius = 1.3 * Rim(robot);
  figure.drive_name = "cable";
  figure.idle_drive_name = "slack cable";
  return figure;
}

statics::Shape ShapeOf(const Robot& robot, const Load& load, const Solution& solution) {
  const std::vector<Eigen::Isometry3d> discs = DiscFrames(robot, solution.beta);
  statics::Shape shape;
  shape.backbone = CentreLine(robot, solution.beta);
  for (const Eigen::Isometry3d& disc : discs) {
    const double thickness = robot.Thickness(static_cast<int>(shape.discs.size()));
    shape.discs.push_back({disc.translation(), disc.linear().col(0), Rim(robot), thickness});
  }
  for (int j = 0; j < robot.Cables(); ++j) shape.drives.push_back(Cable(robot, load, discs, j));
  shape.force = load.force;
  for (const DiscLoad& on_disc : load.on_discs) {
    if (on_disc.disc == robot.Joints()) shape.force += on_disc.force;
  }
  if (load.condition == Condition::kV) shape.force += load.payload * load.gravity;
  shape.gravity = load.gravity;
  shape.load = std::accumulate(load.tension.begin(), load.tension.end(), 0.0);
  return shape;
}

}  // namespace continuum::twin_pivot
