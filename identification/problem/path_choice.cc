#include "identification/problem/path_choice.h"

#include <fmt/format.h>

#include "identification/sensitivity/smooth_path.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

// Of the model of one log, at a start that lies a little beside the null of every parameter.
std::string ObstacleOf(const Problem& problem, const Problem::Vector& x, std::size_t log) {
  const ModelAndData machine = problem.system().Build(problem.ChangesFor(x, log));
  return ContinuousDynamics::Obstacle(*machine.model, *machine.data);
}

// Whether a contact or a limit acts on the way; of the rows the first d.ne are equalities.
std::string ContactObstacle(const Problem& problem, std::size_t log) {
  ModelAndData machine = problem.system().Build(problem.ChangesFor(problem.Start(), log));
  double when = -1;
  Hooks hooks;
  hooks.step = [&](const mjModel&, const mjData& d) {
    if (d.nefc > d.ne && when < 0) when = d.time;
  };
  const Log& logged = problem.experiment().logs[log];
  Simulate(machine, problem.experiment(), logged, {}, hooks);
  return when < 0 ? "" : fmt::format("{}: a contact or limit acts at {:g} s", logged.label, when);
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
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    std::string why = ObstacleOf(problem, beside, l);
    if (why.empty()) why = ContactObstacle(problem, l);
    if (!why.empty()) return why;
  }
  return "";
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
  return share <= kMost
             ? ""
             : fmt::format("the inputs jump or bend at {:.0f} % of the rows", 100 * share);
}

}  // namespace continuum
