#include "models/tdcr/reach.h"

#include "models/statics/wind.h"
#include "models/tdcr/details.h"
#include "models/tdcr/response.h"

namespace continuum::tdcr {

using Eigen::VectorXd;

namespace {

Solution SolveGoingOn(const Robot& robot, const Loads& loads, Method method, const Before* before) {
  return before ? SolveFrom(robot, before->loads, before->solution, loads, method)
                : SolveCase(robot, loads, method);
}

// The target's coordinates at a solution, and their slopes by what drives the robot.
std::optional<statics::Stand> StandAt(const Robot& robot, const Loads& loads, Method method,
                                      const Solution& s, const statics::Target& target) {
  const auto response = Respond(robot, loads, method, s);
  if (!response) return std::nullopt;
  const VectorXd disks = s.disks.reshaped();
  const Eigen::MatrixXd slopes = response->slope.bottomRows(disks.size()).rightCols(robot.tendons);
  return statics::Stand{disks(target.coordinate), slopes(target.coordinate, Eigen::all)};
}

}  // namespace

statics::Reached Reach(const Robot& robot, const Loads& loads, Method method,
                       const statics::Target& target, const Before* before) {
  const auto most = [&](int disk) { return robot.Place(disk + 1); };
  if (auto far = statics::TooFar(target, most)) return *far;
  Loads at = loads;
  const auto stand = [&](const VectorXd& drives) -> std::optional<statics::Stand> {
    at.tension.assign(drives.begin(), drives.end());
    const Solution s = SolveGoingOn(robot, at, method, before);
    if (!s.outcome.ok()) return std::nullopt;
    return StandAt(robot, at, method, s, target);
  };
  const VectorXd start = VectorXd::Map(loads.tension.data(), robot.tendons);
  return statics::Reach(stand, start, target, robot.tension(), robot.length);
}

statics::Reached ReachByLengths(const Robot& robot, const Loads& loads, Method method,
                                const statics::Target& target, const Before* before) {
  if (auto no = statics::NoPretension(target, robot.tendon_EA)) return *no;
  Loads wound = loads, pulled = loads;
  const Solution start = SolveGoingOn(robot, wound, method, before);
  pulled.length.resize(0);
  pulled.tension.assign(static_cast<std::size_t>(robot.tendons), 0);
  if (start.outcome.ok()) pulled.tension.assign(start.pull.begin(), start.pull.end());
  const auto by_tension = Reach(robot, pulled, method, target, before);
  if (!by_tension.outcome.ok()) return by_tension;
  pulled.tension.assign(by_tension.drives.begin(), by_tension.drives.end());
  const Solution s = SolveGoingOn(robot, pulled, method, before);
  VectorXd lengths = Describe(robot, pulled, method, s).length;
  if (robot.tendon_EA > 0) {
    lengths -= lengths.cwiseProduct(by_tension.drives) / robot.tendon_EA;
  }
  const auto stand = [&](const VectorXd& L) -> std::optional<statics::Stand> {
    wound.length = L;
    const Solution at = SolveGoingOn(robot, wound, method, before);
    if (!at.outcome.ok()) return std::nullopt;
    wound.tension.assign(at.pull.begin(), at.pull.end());
    return StandAt(robot, wound, method, at, target);
  };
  return statics::Wind(stand, statics::WithRoom(lengths, by_tension.drives), target, robot.length);
}

}  // namespace continuum::tdcr
