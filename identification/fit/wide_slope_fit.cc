#include "identification/fit/wide_slope_fit.h"

#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "identification/fit/ripples.h"
#include "identification/statistics/noise_model.h"
#include "sim/io/interrupt.h"

namespace continuum {
namespace {

using Matrix = Problem::Matrix;

// On top of a fit, the effort of one before it.
void AddEffort(const Fit& before, Fit& to) {
  to.iterations += before.iterations;
  to.evaluations += before.evaluations;
  to.seconds += before.seconds;
  // Where it ended is where this one began.
  to.trace.insert(to.trace.begin(), before.trace.begin(), before.trace.end() - 1);
}

// To a fit, the effort of one after it that led nowhere.
void AddVain(const Fit& after, Fit& to) {
  to.iterations += after.iterations;
  to.evaluations += after.evaluations;
  to.seconds += after.seconds;
  to.trace.resize(to.trace.size() + static_cast<std::size_t>(after.iterations), to.cost);
}

// From x with slopes over a fifth of the parameters' sizes; goes on only if the first step helps.
Fit FitWide(const Problem& problem, const Problem::Vector& x, const std::vector<bool>& use,
            FitOptions options) {
  Problem wide = problem;
  wide.DifferBy(0.2);
  options.tolerance = 1e-3, options.idle = true;
  options.progress = Within({"fit with wide slopes"}, options.progress);
  const int most = std::exchange(options.iterations, 1);
  Fit first = FitParameters(wide, x, use, options);
  if (first.cost >= first.trace.front() || most == first.iterations) return first;
  options.iterations = most - first.iterations;
  Fit fit = FitParameters(wide, first.x, use, options);
  AddEffort(first, fit);
  return fit;
}

// Where no effect of ours acts a fit is done that has reached the noise, or that has no ripples
// around it: then wider slopes find nothing better. Notes the latter.
bool IsDone(const Problem& problem, const Matrix& slopes, const std::vector<bool>& use,
            const FitOptions& options, Fit& fit) {
  if (!problem.LinearisesCheaply()) return false;
  if (IsNear(NoiseOf(problem.experiment()),
             TypicalRms(problem, problem.Residuals(fit.x, use), use)))
    return true;
  if (slopes.cols() == 0 || !fit.converged) return false;
  fit.smooth = !HasRipples(problem, fit, slopes, use, options);
  return fit.smooth;
}

}  // namespace

Fit FitWithWideSlopes(const Problem& problem, const Problem::Vector& x,
                      const std::vector<bool>& use, const FitOptions& options) {
  constexpr double kLower = 1e-3;  // of the cost, that is worth another fit
  constexpr int kFits = 4;
  Matrix slopes;
  FitOptions first = options;
  if (!options.slopes) first.slopes = &slopes;
  Fit best = FitParameters(problem, x, use, first);
  const bool may_go_on = problem.path() == Path::kStepped && x.size() > 0 &&
                         !IsDone(problem, *first.slopes, use, options, best);
  for (int k = 1; k < kFits && may_go_on && !StopRequested(); ++k) {
    FitOptions left = options;
    left.iterations -= best.iterations;
    left.idle = true;  // out there a parameter may have no effect
    if (left.iterations <= 0) break;
    Fit wide = best;
    try {
      wide = FitWide(problem, best.x, use, left);
    } catch (const Error& error) {
      if (error.kind() != Error::Kind::kJob) throw;
      break;  // it diverges that far from the best
    }
    if (wide.cost > best.cost * (1 - kLower)) {
      AddVain(wide, best);
      break;
    }
    left.iterations -= wide.iterations;
    AddEffort(best, wide);
    best = std::move(wide);
    if (left.iterations <= 0) break;
    Fit next = FitParameters(problem, best.x, use, left);
    AddEffort(best, next);
    best = std::move(next);
  }
  return best;
}

}  // namespace continuum
