#include "models/twin_pivot/geometry.h"

#include <cmath>
#include <numbers>

namespace continuum::twin_pivot {

using Eigen::VectorXd;

std::vector<Joint<double>> JointsAt(const Robot& robot, const VectorXd& beta) {
  std::vector<Joint<double>> joint;
  joint.reserve(static_cast<std::size_t>(beta.size()));
  for (const Link& link : robot.Links()) {
    joint.emplace_back(link, beta[static_cast<Eigen::Index>(joint.size())]);
  }
  return joint;
}

Eigen::MatrixXd CableLengths(const Robot& robot, const VectorXd& beta) {
  Eigen::MatrixXd length = Eigen::MatrixXd::Zero(robot.Joints(), robot.Cables());
  const std::vector<Joint<double>> joint = JointsAt(robot, beta);
  for (int j = 0; j < robot.Cables(); ++j) {
    const int last = robot.Anchor(j);
    const double y = robot.r[j] * std::cos(robot.phi[j]), z = robot.r[j] * std::sin(robot.phi[j]);
    for (int m = 0; m < last; ++m) length(m, j) = joint[m].Length(m % 2 == 0 ? y : z);
  }
  return length;
}

std::vector<Eigen::Isometry3d> DiscFrames(const Robot& robot, const VectorXd& beta) {
  std::vector<Eigen::Isometry3d> frames = {Eigen::Isometry3d::Identity()};
  const std::vector<Joint<double>> joints = JointsAt(robot, beta);
  for (int m = 0; m < beta.size(); ++m) {
    const Joint<double>& joint = joints[static_cast<std::size_t>(m)];
    const double turn = (m % 2 == 0 ? 0.5 : -0.5) * std::numbers::pi;
    frames.push_back(frames.back() * Eigen::Translation3d(joint.origin.x, joint.origin.y, 0) *
                     Eigen::AngleAxisd(beta[m], Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitX()));
  }
  return frames;
}

std::vector<Eigen::Vector3d> CentreLine(const Robot& robot, const VectorXd& beta, int per_rod) {
  const std::vector<Eigen::Isometry3d> discs = DiscFrames(robot, beta);
  const std::vector<Link> links = robot.Links();
  std::vector<Eigen::Vector3d> points = {Eigen::Vector3d::Zero()};
  for (int m = 0; m < beta.size(); ++m) {
    const auto at = static_cast<std::size_t>(m);
    for (int i = 0; i < per_rod; ++i) {
      const double share = static_cast<double>(i) / (per_rod - 1);
      const auto c = Stumpff(share * beta[m]);
      const double s = share * links[at].L;
      points.emplace_back(
          discs[at] * Eigen::Vector3d(links[at].before + s * c[1], s * share * beta[m] * c[2], 0));
    }
    points.emplace_back(discs[at + 1].translation());
  }
  return points;
}

}  // namespace continuum::twin_pivot
