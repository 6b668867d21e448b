#include "models/twin_pivot/reach.h"

#include <algorithm>

#include "models/statics/nearest.h"
#include "models/twin_pivot/geometry.h"
#include "models/twin_pivot/response.h"

namespace continuum::twin_pivot {

using Eigen::VectorXd;

namespace {

// The discs of a case under tensions, with the slopes of contacts that turn within `width` [m].
class Standing {
 public:
  Standing(const Robot& robot, double width, const Load& load, Method method,
           const statics::Target& target, const Before* before)
      : robot_(robot),
        wide_(robot),
        load_(load),
        method_(method),
        target_(target),
        before_(before) {
    wide_.eps = width;
  }

  std::optional<statics::Stand> operator()(const VectorXd& drives) {
    load_.tension.assign(drives.begin(), drives.end());
    const Solution s = SolveGoingOn(robot_, load_, method_, before_);
    if (!s.outcome.ok()) return std::nullopt;
    const auto response = Respond(wide_, load_, method_, s);
    if (!response) return std::nullopt;
    const auto discs = DiscFrames(robot_, s.beta);
    VectorXd points(3 * robot_.Joints());
    for (int m = 0; m < robot_.Joints(); ++m) {
      points.segment<3>(3 * m) = discs[static_cast<std::size_t>(m) + 1].translation();
    }
    const Eigen::MatrixXd slopes =
        response->slope.bottomRows(points.size()).rightCols(robot_.Cables());
    return statics::Stand{points(target_.coordinate), slopes(target_.coordinate, Eigen::all)};
  }

 private:
  const Robot& robot_;
  Robot wide_;
  Load load_;
  Method method_;
  const statics::Target& target_;
  const Before* before_;
};

template <class Search>
statics::Reached ReachBy(const Search& search, const Robot& robot, double width, const Load& load,
                         Method method, const statics::Target& target, const Before* before) {
  const VectorXd start = VectorXd::Map(load.tension.data(), robot.Cables());
  return search(Standing(robot, width, load, method, target, before), start, target,
                robot.Stiffness() / robot.r.front(), robot.Length());
}

}  // namespace

statics::Reached Reach(const Robot& robot, const Load& load, Method method,
                       const statics::Target& target, const Before* before) {
  const auto most = [&](int disc) { return robot.Place(disc + 1); };
  if (auto far = statics::TooFar(target, most)) return *far;
  return ReachBy(statics::Reach, robot, robot.eps, load, method, target, before);
}

statics::Reached Approach(const Robot& robot, const Load& load, Method method,
                          const statics::Target& target, const Before* before) {
  // Within 1 um slopes say nothing of a step that turns the contacts.
  const double width = std::max(robot.eps, 1e-4);
  return ReachBy(statics::Nearest, robot, width, load, method, target, before);
}

Solution SolveGoingOn(const Robot& robot, Load& load, Method method, const Before* before) {
  Solution s;
  if (before == nullptr) {
    s = Solve(robot, load, method);
  } else {
    s = SolveFrom(robot, before->load, before->solution, load, method);
    load.reference = before->solution.length;
    load.slide = before->solution.slide;
  }
  s.pull = VectorXd::Map(load.tension.data(), robot.Cables());
  return s;
}

}  // namespace continuum::twin_pivot
