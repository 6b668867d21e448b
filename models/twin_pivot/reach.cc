#include "models/twin_pivot/reach.h"

#include "models/twin_pivot/geometry.h"
#include "models/twin_pivot/response.h"

namespace continuum::twin_pivot {

using Eigen::VectorXd;

statics::Reached Reach(const Robot& robot, const Load& load, Method method,
                       const statics::Target& target, const Before* before) {
  Load at = load;
  if (before != nullptr) {
    at.reference = before->solution.length;
    at.slide = before->solution.slide;
  }
  const int cables = robot.Cables();
  const auto stand = [&](const VectorXd& drives) -> std::optional<statics::Stand> {
    at.tension.assign(drives.begin(), drives.end());
    const Solution s = before ? SolveFrom(robot, before->load, before->solution, at, method)
                              : Solve(robot, at, method);
    if (!s.outcome.ok()) return std::nullopt;
    const auto response = Respond(robot, at, method, s);
    if (!response) return std::nullopt;
    const auto discs = DiscFrames(robot, s.beta);
    VectorXd points(3 * robot.Joints());
    for (int m = 0; m < robot.Joints(); ++m) {
      points.segment<3>(3 * m) = discs[static_cast<std::size_t>(m) + 1].translation();
    }
    const Eigen::MatrixXd slopes = response->slope.bottomRows(points.size()).rightCols(cables);
    return statics::Stand{points(target.coordinate), slopes(target.coordinate, Eigen::all)};
  };
  const VectorXd start = VectorXd::Map(load.tension.data(), cables);
  return statics::Reach(stand, start, target, robot.Stiffness() / robot.r.front(),
                        robot.Length());
}

}  // namespace continuum::twin_pivot
