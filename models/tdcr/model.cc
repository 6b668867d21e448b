#include "models/tdcr/model.h"

#include <cmath>
#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "models/tdcr/contacts.h"
#include "models/tdcr/cosserat.h"
#include "models/tdcr/disks.h"
#include "models/tdcr/equilibrium.h"
#include "models/tdcr/unit_rod.h"
#include "models/tdcr/winches.h"
#include "sim/numerics/solver.h"
#include "sim/numerics/work_limit.h"

namespace continuum::tdcr {
namespace {

using numerics::Outcome;

// Linear systems of a row. Of the 864 loads of the README the hardest takes 14889 (crt_friction).
constexpr long kMostSystems = 150000;

// find(balance, x): an equilibrium from x = 0.
template <int C, class Find>
Solution SolveDisks(const Robot& robot, const Loads& loads, const Loads* earlier, Find&& find) {
  Solution solution;
  solution.outcome = numerics::Limited(kMostSystems, [&] {
    DiskBalance<C> balance(robot, loads, earlier);
    typename DiskBalance<C>::Vector x = DiskBalance<C>::Vector::Zero(balance.unknowns());
    const Found found = find(balance, x);
    solution.stability = found.stability;
    balance.SetLoad(1);
    solution.x = x;
    solution.u = balance.Curvatures(x);
    solution.disks = Positions(EqualArcs(robot), solution.u);
    solution.from = balance.from();
    if (found.outcome.ok()) solution.contacts = balance.ContactsAt(x);
    return found.outcome;
  });
  return solution;
}

// Steps of the integrator: about 9 along the rod, a whole number in every piece. The shape is
// taken from twice as many, so that every piece has a middle.
int Steps(int arcs) { return std::max(1, (9 + arcs - 1) / arcs); }

Outcome Refine(const Robot& robot, RodBalance& balance, Outcome outcome, Eigen::Vector3d& x,
               Solution& solution) {
  constexpr double kAccuracy = 2e-8;  // of L; the contract asks for 1e-7
  constexpr double kLeast = 1e-7;     // friction has a kink where a tendon is straight
  for (int refinement = 0; outcome.ok(); ++refinement) {
    const int steps = balance.steps();
    const auto coarse = balance.Integrate(x);
    balance.SetSteps(2 * steps);
    const auto fine = balance.Integrate(x);
    const double error = (fine.disks - coarse.disks).colwise().norm().maxCoeff() / robot.length +
                         (fine.residual - coarse.residual).norm();
    solution.u = fine.middles;
    solution.disks = fine.disks;
    if (error <= (refinement == 7 ? kLeast : kAccuracy)) {
      solution.line = balance.LineOf(fine);
      break;
    }
    if (refinement == 7) {
      outcome.status = numerics::Status::kNoConvergence;
      outcome.why = "the rod is too strongly bent for the integrator";
      break;
    }
    const int spent = outcome.iterations;
    outcome = Polish(balance, x);
    outcome.iterations += spent;
  }
  return outcome;
}

template <class Find>
Solution SolveRod(const Robot& robot, const Loads& loads, bool friction, Find&& find) {
  Solution solution;
  solution.outcome = numerics::Limited(kMostSystems, [&] {
    RodBalance balance(robot, loads, friction, Steps(CountArcs(robot)));
    Eigen::Vector3d x = balance.Natural();
    const Found found = find(balance, x);
    solution.stability = found.stability;
    balance.SetLoad(1);
    const Outcome outcome = Refine(robot, balance, found.outcome, x, solution);
    solution.x = x;
    return outcome;
  });
  return solution;
}

// Why a rod has more contacts than a matrix of them should hold; empty where it has not. 5000 take
// 0.5 GB.
std::string TooManyContacts(const Robot& robot, const Loads& loads) {
  constexpr int kMostContacts = 5000;
  const int arcs = CountArcs(robot), contacts = arcs * ContactSteps(arcs) * robot.tendons;
  if (!loads.AsItSlides() || loads.mu == 0 || contacts <= kMostContacts) return "";
  return fmt::format(
      "{} contacts that remember, at most {}: give every tendon a direction (1, -1 or 0), or the "
      "robot fewer disks",
      contacts, kMostContacts);
}

// The rod whose contacts remember: its integrator's steps are the contacts, so they are not
// refined.
template <class Find>
Solution SolveRemembering(const Robot& robot, const Loads& loads, const Loads* earlier,
                          Find&& find) {
  Solution solution;
  solution.outcome.why = TooManyContacts(robot, loads);
  if (!solution.outcome.why.empty()) return solution;
  solution.outcome = numerics::Limited(kMostSystems, [&] {
    RodBalance balance =
        RodBalance::Remembering(robot, loads, ContactSteps(CountArcs(robot)), earlier);
    Eigen::VectorXd x = balance.Unslid(balance.Natural());
    const Found found = find(balance, x);
    solution.stability = found.stability;
    balance.SetLoad(1);
    solution.x = x;
    solution.from = balance.from();
    const RodBalance::Shape& shape = balance.Integrate(x);
    solution.u = shape.middles;
    solution.disks = shape.disks;
    if (found.outcome.ok()) {
      solution.contacts = balance.ContactsAt(x);
      solution.line = balance.LineOf(shape);
    }
    return found.outcome;
  });
  return solution;
}

// Where winches begin: those of the straight robot, or of a row before with its x and tensions.
struct Wound {
  Eigen::VectorXd length, tension;
  const Loads* loads = nullptr;
  const Eigen::VectorXd* x = nullptr;
};

Wound Unwound(const Robot& robot) {
  return {RestLengths(robot), Eigen::VectorXd::Zero(robot.tendons)};
}

// To where the row before ended.
template <int C>
void GoOn(const Eigen::VectorXd& before, const DiskBalance<C>& /*balance*/,
          typename DiskBalance<C>::Vector& x) {
  x = before;
}
void GoOn(const Eigen::VectorXd& before, const RodBalance& balance, Eigen::VectorXd& x) {
  x = balance.Unslid(before.head<3>());
}

Solution SolveWinches(const Robot& robot, const Loads& loads, Method method, const Wound& before) {
  Eigen::VectorXd tension = before.tension;
  const auto find = [&](auto& balance, auto& x) {
    if (before.x != nullptr) GoOn(*before.x, balance, x);
    return FindByWinches(robot, loads, before.length, balance, x, tension);
  };
  Loads smooth = loads;
  if (method == Method::kCrt) smooth.mu = 0;
  Solution solution = method == Method::kEas ? SolveDisks<6>(robot, loads, before.loads, find)
                      : method == Method::kPcca
                          ? SolveDisks<Eigen::Dynamic>(robot, loads, before.loads, find)
                          : SolveRemembering(robot, smooth, before.loads, find);
  solution.pull = tension;
  return solution;
}

// A row whose directions were given with its contacts.
Solution WithContacts(const Robot& robot, const Loads& loads, Solution solution) {
  Remembered remembered = AllSlid(robot, loads, solution.x.head<3>());
  solution.x = std::move(remembered.x);
  solution.contacts = std::move(remembered.contacts);
  return solution;
}

template <int C>
Solution DisksNear(const Robot& robot, const Loads& loads, const Eigen::VectorXd& start) {
  return SolveDisks<C>(robot, loads, nullptr, [&](auto& balance, auto& x) {
    x = start;
    Found found{Polish(balance, x), {}};
    if (found.outcome.ok()) {
      found.stability.unstable_directions = UnstableDirections<C>(balance, x);
    }
    return found;
  });
}

}  // namespace

std::string NameOf(Method method) {
  const char* const names[] = {"eas", "pcca", "crt", "crt_friction"};
  return names[static_cast<int>(method)];
}

Method ParseMethod(const std::string& name) {
  for (const Method method : {Method::kEas, Method::kPcca, Method::kCrt, Method::kCrtFriction}) {
    if (name == NameOf(method)) return method;
  }
  throw Error::Input("--method", "eas, pcca, crt, crt_friction or fit", "'" + name + "'");
}

void RequireTaken(const Robot& robot, const Loads& loads, Method method, const std::string& where) {
  if (method == Method::kCrt || method == Method::kCrtFriction) return;
  const bool at_disks = loads.disk_force.size() > 0 || loads.disk_moment.size() > 0;
  const bool bent = !robot.natural.isZero(0);
  if (!robot.has_sections() && !at_disks && !bent) return;
  const char* const what = at_disks ? "loads at disks" : bent ? "precurvature" : "sections";
  throw Error::Input(where, std::string("the method crt or crt_friction for a robot with ") + what,
                     method == Method::kEas ? "eas" : "pcca");
}

Solution SolveFrom(const Robot& robot, const Loads& earlier, const Solution& before, Loads loads,
                   Method method) {
  RequireTaken(robot, loads, method);
  const bool rod = method == Method::kCrtFriction;
  const Solution state =
      rod && before.contacts.share.size() == 0 ? WithContacts(robot, earlier, before) : before;
  loads.from = state.contacts;
  if (loads.length.size() > 0) {
    return SolveWinches(robot, loads, method, {earlier.length, before.pull, &earlier, &state.x});
  }
  const auto find = [&](auto& balance, auto& x) {
    GoOn(state.x, balance, x);
    return ContinueEquilibrium(robot, loads, balance, x);
  };
  switch (method) {
    case Method::kEas:
      return SolveDisks<6>(robot, loads, &earlier, find);
    case Method::kPcca:
      return SolveDisks<Eigen::Dynamic>(robot, loads, &earlier, find);
    case Method::kCrt:
      return SolveCase(robot, loads, method);
    case Method::kCrtFriction:
      break;
  }
  return SolveRemembering(robot, loads, &earlier, find);
}

Solution SolveCase(const Robot& robot, const Loads& loads, Method method,
                   const Eigen::VectorXd* start) {
  RequireTaken(robot, loads, method);
  if (loads.length.size() > 0) return SolveWinches(robot, loads, method, Unwound(robot));
  const auto find = [&](auto& balance, auto& x) {
    return FindEquilibrium(robot, loads, balance, x, start);
  };
  if (method == Method::kEas) return SolveDisks<6>(robot, loads, nullptr, find);
  if (method == Method::kPcca) return SolveDisks<Eigen::Dynamic>(robot, loads, nullptr, find);
  const bool friction = method == Method::kCrtFriction;
  if (friction && loads.AsItSlides()) return SolveRemembering(robot, loads, nullptr, find);
  return SolveRod(robot, loads, friction, find);
}

Solution SolveNear(const Robot& robot, const Loads& loads, Method method,
                   const Eigen::VectorXd& start) {
  RequireTaken(robot, loads, method);
  if (method == Method::kEas) return DisksNear<6>(robot, loads, start);
  if (method == Method::kPcca) return DisksNear<Eigen::Dynamic>(robot, loads, start);
  const auto find = [&](RodBalance& balance, auto& x) {
    if (!balance.remembers()) balance.SetSteps(4 * balance.steps());  // as fine as the search
    if constexpr (std::is_same_v<std::decay_t<decltype(x)>, Eigen::VectorXd>) {
      x = balance.Slid(start.head<3>());
    } else {
      x = start.head<3>();
    }
    Found found{Polish(balance, x), {}};
    if (found.outcome.ok()) {
      found.stability.unstable_directions = UnstableDirections(robot, balance, x);
    }
    return found;
  };
  const bool friction = method == Method::kCrtFriction;
  if (friction && loads.AsItSlides()) return SolveRemembering(robot, loads, nullptr, find);
  return SolveRod(robot, loads, friction, find);
}

}  // namespace continuum::tdcr
