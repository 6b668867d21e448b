#include "identification/problem/path_choice.h"

#include <algorithm>
#include <atomic>
#include <vector>

#include <fmt/format.h>

#include "engine.h"
#include "identification/sensitivity/smooth_path.h"
#include "sim/numerics/shared_loop.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

// Of the model of one log, at a start that lies a little beside the null of every parameter.
std::string ObstacleOf(const Problem& problem, std::size_t thread, const Problem::Vector& x,
                       std::size_t log) {
  const ModelAndData machine = problem.system(thread).Build(problem.ChangesFor(x, log));
  return ContinuousDynamics::Obstacle(*machine.model, *machine.data);
}

bool ActsContactOrLimit(const mjData& d) {
  const auto acts = [](int type) {
    return type >= mjCNSTR_LIMIT_JOINT;  // after equalities and friction
  };
  return std::any_of(d.efc_type, d.efc_type + d.nefc, acts);
}

bool ActsCableFriction(const mjModel& m, const mjData& d) {
  for (int i = 0; i < m.nplugin; ++i) {
    const BoundLaw& law = BoundOf(m, d, i);
    if (law.NeedsAllForces() && !law.WhyNoBristles(m).empty() && law.LargestTension() > 0)
      return true;
  }
  return false;
}

// Whether a contact, a limit or a cable under tension acts on the way.
std::string ObstacleOnTheWay(const Problem& problem, std::size_t thread, std::size_t log) {
  ModelAndData machine = problem.system(thread).Build(problem.ChangesFor(problem.Start(), log));
  const char* what = nullptr;
  double when = 0;
  Hooks hooks;
  hooks.step = [&](const mjModel& m, const mjData& d) {
    if (what) return;
    when = d.time;
    if (ActsContactOrLimit(d)) what = "a contact or limit acts";
    if (ActsCableFriction(m, d)) what = "a cable whose friction is no bristle is under tension";
  };
  const Log& logged = problem.experiment().logs[log];
  Simulate(machine, problem.experiment(), logged, {}, hooks);
  return what ? fmt::format("{}: {} at {:g} s", logged.label, what, when) : "";
}

// A rate of the equation of motion costs what a step does.
std::string SlowerThanSteps(const Problem& problem) {
  const Experiment& e = problem.experiment();
  const Log& log = e.logs[0];
  ContinuousDynamics dynamics(problem.system().Build(problem.ChangesFor(problem.Start(), 0)), e,
                              log);
  if (!dynamics.rubs()) return "";
  const double length = log.time.back() - log.time.front(), steps = length / problem.step();
  const SmoothTraces traces =
      SimulateSmooth(dynamics, {}, e, log, {.most_rates = static_cast<long>(steps)});
  if (static_cast<double>(traces.work.rates) > steps) {
    const double done =
        traces.trace.diverged ? traces.trace.diverged_at - log.time.front() : length;
    return fmt::format(
        "dry friction takes CVODES {} evaluations of the motion for the first {:.2g} s, and all "
        "{:.2g} s take {:.0f} steps",
        traces.work.rates, done, length, steps);
  }
  if (traces.trace.diverged) return "CVODES cannot follow the dry friction: " + traces.trace.why;
  return "";
}

// That of the first log which has one; later logs need not be looked at then.
std::string FirstObstacle(const Problem& problem, const Problem::Vector& beside) {
  std::vector<std::string> why(problem.experiment().logs.size());
  std::atomic<std::size_t> first = why.size();
  const auto look = [&](std::size_t thread, std::size_t l) {
    if (l > first) return;
    why[l] = ObstacleOf(problem, thread, beside, l);
    if (why[l].empty()) why[l] = ObstacleOnTheWay(problem, thread, l);
    if (why[l].empty()) return;
    for (std::size_t before = first; l < before && !first.compare_exchange_weak(before, l);) {
    }
  };
  ShareOut(why.size(), look, [&](auto& archive, std::size_t l) { archive(why[l]); });
  const auto found = std::find_if(why.begin(), why.end(), [](const auto& w) { return !w.empty(); });
  return found == why.end() ? "" : *found;
}

}  // namespace

std::string SmoothObstacle(const Problem& problem) {
  const Experiment& e = problem.experiment();
  if (e.quasi_static) return "the logs are quasi-static";
  if (e.start == Experiment::Start::kEstimate) return "where the trials begin is a parameter";
  Problem::Vector beside = problem.Start();
  for (Eigen::Index k = 0; k < beside.size(); ++k) {
    if (problem.parameters()[k].change.attribute == "skew") return "the clock is a parameter";
    beside[k] += problem.StepOf(beside, k, kPerturbation);
  }
  return FirstObstacle(problem, beside);
}

std::string SmoothCost(const Problem& problem) {
  constexpr double kMost = 0.1;  // of the rows
  const Experiment& e = problem.experiment();
  std::size_t rows = 0, breaks = 0;
  for (const Log& log : e.logs) {
    rows += log.rows();
    for (std::size_t row = 1; row < log.rows(); ++row) breaks += BreaksAt(e, log, row);
  }
  const double share = static_cast<double>(breaks) / static_cast<double>(rows);
  if (share > kMost)
    return fmt::format("the inputs jump or bend at {:.0f} % of the rows", 100 * share);
  return OnFirstRank([&] { return SlowerThanSteps(problem); });
}

}  // namespace continuum
