#include "models/twin_pivot/reach.h"

#include <algorithm>

#include "models/statics/length_driven.h"
#include "models/statics/nearest.h"
#include "models/statics/wind.h"
#include "models/twin_pivot/geometry.h"
#include "models/twin_pivot/response.h"
#include "models/twin_pivot/rising.h"

namespace continuum::twin_pivot {

using Eigen::VectorXd;

namespace {

// Contacts go on from the case before.
void GoOn(Load& load, const Before* before) {
  if (before == nullptr) return;
  load.reference = before->solution.length;
  load.slide = before->solution.slide;
}

VectorXd PointsOf(const Robot& robot, const VectorXd& beta) {
  const auto discs = DiscFrames(robot, beta);
  VectorXd points(3 * robot.Joints());
  for (int m = 0; m < robot.Joints(); ++m) {
    points.segment<3>(3 * m) = discs[static_cast<std::size_t>(m) + 1].translation();
  }
  return points;
}

// The target's coordinates at a solution, and their slopes by what drives the robot `sloped`, whose
// contacts may turn more widely.
std::optional<statics::Stand> StandAt(const Robot& robot, const Robot& sloped, const Load& load,
                                      Method method, const Solution& s,
                                      const statics::Target& target) {
  const auto response = Respond(sloped, load, method, s);
  if (!response) return std::nullopt;
  const VectorXd points = PointsOf(robot, s.beta);
  const Eigen::MatrixXd slopes =
      response->slope.bottomRows(points.size()).rightCols(robot.Cables());
  return statics::Stand{points(target.coordinate), slopes(target.coordinate, Eigen::all)};
}

// How a search solves a case: along its loads from the case before, or, many times faster, beside
// the shape that was solved last, where there is one. Both are roots of the same equations, as
// contacts remember only the case before; a stable root beside a stable one is as a rule the one
// along the loads.
enum class Way { kAlongLoads, kBesideLast };

// The discs of a case under tensions, with the slopes of contacts that turn within `width` [m].
class Standing {
 public:
  Standing(const Robot& robot, double width, const Load& load, Method method,
           const statics::Target& target, const Before* before, Way way)
      : robot_(robot),
        wide_(robot),
        load_(load),
        method_(method),
        target_(target),
        before_(before),
        way_(way) {
    wide_.eps = width;
  }

  std::optional<statics::Stand> operator()(const VectorXd& drives) {
    const Solution s = Solved(drives);
    if (!s.outcome.ok()) return std::nullopt;
    return StandAt(robot_, wide_, load_, method_, s, target_);
  }

  std::optional<VectorXd> Points(const VectorXd& drives) {
    const Solution s = Solved(drives);
    if (!s.outcome.ok()) return std::nullopt;
    return PointsOf(robot_, s.beta)(target_.coordinate);
  }

 private:
  Solution Solved(const VectorXd& drives) {
    load_.tension.assign(drives.begin(), drives.end());
    Solution s = Found();
    if (s.outcome.ok()) last_ = s.beta;
    return s;
  }

  Solution Found() {
    constexpr double kBeside = 0.1;  // rad in one joint
    if (way_ == Way::kBesideLast && last_.size() > 0) {
      GoOn(load_, before_);
      const Task task(robot_, load_, method_);
      RisingSystem system(task, task);
      Solution s;
      s.beta = last_;
      s.outcome = system.Correct(1, s.beta);
      const bool near = (s.beta - last_).cwiseAbs().maxCoeff() < kBeside;
      if (s.outcome.ok() && (!near || system.Unstable(1, s.beta) != 0)) {
        s.outcome.status = numerics::Status::kNoConvergence;
      }
      return s;
    }
    return SolveGoingOn(robot_, load_, method_, before_);
  }

  const Robot& robot_;
  Robot wide_;
  Load load_;
  Method method_;
  const statics::Target& target_;
  const Before* before_;
  Way way_;
  VectorXd last_;
};

VectorXd Drives(const Robot& robot, const Load& load) {
  return VectorXd::Map(load.tension.data(), robot.Cables());
}

// A tension that bends a joint by 1 rad.
double DriveUnit(const Robot& robot) { return robot.Stiffness() / robot.r.front(); }

}  // namespace

statics::Reached Reach(const Robot& robot, const Load& load, Method method,
                       const statics::Target& target, const Before* before) {
  const auto most = [&](int disc) { return robot.Place(disc + 1); };
  if (auto far = statics::TooFar(target, most)) return *far;
  Standing standing(robot, robot.eps, load, method, target, before, Way::kAlongLoads);
  return statics::Reach([&](const VectorXd& w) { return standing(w); }, Drives(robot, load), target,
                        DriveUnit(robot), robot.Length());
}

statics::Reached ReachByLengths(const Robot& robot, const Load& load, Method method,
                                const statics::Target& target, const Before* before) {
  if (auto no = statics::NoPretension(target, robot.cable_EA)) return *no;
  Load wound = load, pulled = load;
  const Solution start = SolveGoingOn(robot, wound, method, before);
  pulled.length.resize(0);
  pulled.tension.assign(static_cast<std::size_t>(robot.Cables()), 0);
  if (start.outcome.ok()) pulled.tension.assign(start.pull.begin(), start.pull.end());
  const auto by_tension = Reach(robot, pulled, method, target, before);
  if (!by_tension.outcome.ok()) return by_tension;
  pulled.tension.assign(by_tension.drives.begin(), by_tension.drives.end());
  const Solution s = SolveGoingOn(robot, pulled, method, before);
  const VectorXd path = s.length.colwise().sum().transpose();
  const statics::CableStretch stretch(robot.cable_EA, path);
  const auto stand = [&](const VectorXd& lengths) -> std::optional<statics::Stand> {
    wound.length = lengths;
    const Solution at = SolveGoingOn(robot, wound, method, before);
    if (!at.outcome.ok()) return std::nullopt;
    wound.tension.assign(at.pull.begin(), at.pull.end());
    return StandAt(robot, robot, wound, method, at, target);
  };
  const VectorXd lengths = path - stretch.Of(s.tension, s.length);
  return statics::Wind(stand, statics::WithRoom(lengths, by_tension.drives), target,
                       robot.Length());
}

statics::Reached Approach(const Robot& robot, const Load& load, Method method,
                          const statics::Target& target, const Before* before) {
  // Within 1 um slopes say nothing of a step that turns the contacts.
  const double width = std::max(robot.eps, 1e-4);
  const auto by = [&](Way way) {
    Standing standing(robot, width, load, method, target, before, way);
    return statics::Nearest([&](const VectorXd& w) { return standing(w); },
                            [&](const VectorXd& w) { return standing.Points(w); },
                            Drives(robot, load), target, DriveUnit(robot), robot.Length());
  };
  const statics::Reached fast = by(Way::kBesideLast);
  if (fast.drives.size() == 0) return fast;
  // The shape along the loads decides.
  Load at = load;
  at.tension.assign(fast.drives.begin(), fast.drives.end());
  const Solution s = SolveGoingOn(robot, at, method, before);
  constexpr double kSame = 1e-6;  // of the length
  if (s.outcome.ok() && target.Miss(PointsOf(robot, s.beta)(target.coordinate)) <=
                            fast.miss + kSame * robot.Length()) {
    return fast;
  }
  return by(Way::kAlongLoads);
}

Solution SolveGoingOn(const Robot& robot, Load& load, Method method, const Before* before) {
  Solution s = before ? SolveFrom(robot, before->load, before->solution, load, method)
                      : Solve(robot, load, method);
  load.reference = s.reference;
  load.slide = s.reference_slide;
  if (load.length.size() == 0) s.pull = VectorXd::Map(load.tension.data(), robot.Cables());
  return s;
}

}  // namespace continuum::twin_pivot
