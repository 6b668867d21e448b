#include "identification/far.h"

#include <utility>

#include <fmt/format.h>

#include "sim/stop.h"

namespace continuum {
namespace {

// From x with slopes over a fifth of the parameters' sizes; goes on only if the first step helps.
Fit FitWide(const Problem& problem, const Problem::Vector& x, const std::vector<bool>& use,
            FitOptions options) {
  Problem wide = problem;
  wide.DifferBy(0.2);
  options.tolerance = 1e-3, options.idle = true;
  options.progress = [tell = options.progress](const std::string& line) {
    if (tell) tell("slopes over a fifth: " + line);
  };
  const int iterations = std::exchange(options.iterations, 1);
  Fit first = FitParameters(wide, x, use, options);
  if (first.cost >= first.trace.front()) return first;
  options.iterations = iterations;
  Fit fit = FitParameters(wide, first.x, use, options);
  AddEffort(first, fit);
  return fit;
}

}  // namespace

Fit FitFar(const Problem& problem, const Problem::Vector& x, const std::vector<bool>& use,
           const FitOptions& options) {
  constexpr double kLower = 1e-3;  // of the cost, that is worth another fit
  constexpr int kFits = 4;
  Fit best = FitParameters(problem, x, use, options);
  for (int k = 1; k < kFits && problem.path() == Path::kStepped && !StopRequested(); ++k) {
    const Fit wide = FitWide(problem, best.x, use, options);
    best.evaluations += wide.evaluations, best.seconds += wide.seconds;
    if (wide.cost > best.cost * (1 - kLower)) break;
    Fit next = FitParameters(problem, wide.x, use, options);
    AddEffort(best, next);
    best = std::move(next);
  }
  return best;
}

}  // namespace continuum
