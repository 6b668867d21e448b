#include "models/tdcr/reach.h"

#include "models/tdcr/response.h"

namespace continuum::tdcr {

using Eigen::VectorXd;

statics::Reached Reach(const Robot& robot, const Loads& loads, Method method,
                       const statics::Target& target, const Before* before) {
  const auto most = [&](int disk) { return robot.Place(disk + 1); };
  if (auto far = statics::TooFar(target, most)) return *far;
  Loads at = loads;
  if (before != nullptr) at.from = LeftBy(robot, before->loads, method, before->solution);
  const auto stand = [&](const VectorXd& drives) -> std::optional<statics::Stand> {
    at.tension.assign(drives.begin(), drives.end());
    const Solution s = before ? SolveFrom(robot, before->loads, before->solution, at, method)
                              : SolveCase(robot, at, method);
    if (!s.outcome.ok()) return std::nullopt;
    const auto response = Respond(robot, at, method, s);
    if (!response) return std::nullopt;
    const VectorXd disks = s.disks.reshaped();
    const Eigen::MatrixXd slopes =
        response->slope.bottomRows(disks.size()).rightCols(robot.tendons);
    return statics::Stand{disks(target.coordinate), slopes(target.coordinate, Eigen::all)};
  };
  const VectorXd start = VectorXd::Map(loads.tension.data(), robot.tendons);
  return statics::Reach(stand, start, target, robot.tension(), robot.length);
}

}  // namespace continuum::tdcr
