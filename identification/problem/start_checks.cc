#include "identification/problem/start_checks.h"

#include <algorithm>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "error.h"
#include "sim/experiment/measurement_model.h"
#include "sim/model/attribute_bounds.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

using Changes = std::vector<Change>;

std::string InWords(const FreeParameter& p, double value) {
  return fmt::format("{} = {:g} ({})", p.name, value, p.where);
}

// The parameters of a log whose values at x alone make it fail, beside what the log sets, or what
// does without any.
std::string Culprits(const Problem& problem, const Problem::Vector& x, std::size_t log,
                     const std::function<bool(const Changes&)>& fails) {
  Changes set = SettingsOfModel(problem.experiment().logs[log]);
  if (fails(set)) return set.empty() || fails({}) ? " as the model stands" : " with its `set`";
  std::vector<std::string> alone, all;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const FreeParameter& p = problem.parameters()[k];
    if (!p.log[log] || p.where.empty() || p.IsStart() ||
        IsMeasurement(p.change.target, p.change.attribute))
      continue;
    all.push_back(InWords(p, x[k]));
    set.push_back(p.change);
    set.back().value = x[k];
    if (fails(set)) alone.push_back(all.back());
    set.pop_back();
  }
  return fmt::format(" with {}", fmt::join(alone.empty() ? all : alone, ", "));
}

bool Compiles(const Problem& problem, const Changes& changes) {
  try {
    problem.system().Build(changes);
    return true;
  } catch (const Error&) {
    return false;
  }
}

bool Diverges(const Problem& problem, const Changes& changes, std::size_t log) {
  try {
    ModelAndData machine = problem.system().Build(changes);
    return Simulate(machine, problem.experiment(), problem.experiment().logs[log]).diverged;
  } catch (const Error&) {
    return true;
  }
}

void RequirePossibleAt(const std::string& where, Change change, double value) {
  change.value = value;
  try {
    RequirePossible(change);
  } catch (const Error& error) {
    throw Error::Input(where, error.what());
  }
}

// A bound of zero may be one that is never reached, so it is allowed where zero itself is not.
void RequirePossibleRange(const Parameter& p) {
  const Change change{p.target, p.attribute, 0, p.operation};
  if (p.has_initial) RequirePossibleAt(p.where + ".initial", change, p.initial);
  if (p.lower < 0) RequirePossibleAt(p.where + ".lower", change, p.lower);
}

}  // namespace

void RequireStartModels(const Problem& problem) {
  const Experiment& e = problem.experiment();
  for (const Parameter& p : e.parameters) RequirePossibleRange(p);
  const Problem::Vector x = problem.Start();
  std::vector<Changes> seen;
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    const Changes changes = problem.ChangesFor(x, l);
    if (std::find(seen.begin(), seen.end(), changes) != seen.end()) continue;
    seen.push_back(changes);
    try {
      problem.system().Build(changes);
    } catch (const Error& error) {
      const auto fails = [&](const Changes& some) { return !Compiles(problem, some); };
      throw Error::Input(
          e.file.string() + ": log '" + e.logs[l].label + "'" + Culprits(problem, x, l, fails),
          error.what());
    }
  }
}

void RequireFiniteSlopes(const Problem& problem, const Problem::Vector& x,
                         const std::vector<Problem::Matrix>& J) {
  std::vector<std::string> moved;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const auto diverges = [&](const Problem::Matrix& part) {
      return part.size() && !part.col(k).allFinite();
    };
    if (std::any_of(J.begin(), J.end(), diverges))
      moved.push_back(InWords(problem.parameters()[k], x[k]));
  }
  if (moved.empty()) return;
  throw Error::Job(fmt::format(
      "the simulation diverges next to the start of the fit, where one of these moves a little: "
      "{}; are its bounds too wide?",
      fmt::join(moved, ", ")));
}

void RequireEffect(const Problem& problem, const Problem::Vector& x,
                   const std::vector<Problem::Matrix>& J) {
  const Problem::Vector start = problem.Start();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    if (p.IsStart() || x[i] != start[i]) continue;  // start: of a log that is not in use
    double norm = 0;
    for (const Problem::Matrix& part : J) {
      if (part.size()) norm += part.col(i).squaredNorm();
    }
    if (norm * p.scale * p.scale > 0) continue;
    throw Error::Input((p.where.empty() ? "" : p.where + ": ") + "parameter '" + p.name + "' (" +
                           p.change.target + ", " + p.change.attribute + ")",
                       "an effect on some output at its start " + fmt::format("{:g}", x[i]),
                       "none");
  }
}

std::string WhyItDiverges(const Problem& problem, const Problem::Vector& x, std::size_t log) {
  const auto fails = [&](const Changes& some) { return Diverges(problem, some, log); };
  return problem.Predict(x, log).Failure() + Culprits(problem, x, log, fails);
}

}  // namespace continuum
