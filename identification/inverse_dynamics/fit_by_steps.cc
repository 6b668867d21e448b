#include "identification/inverse_dynamics/fit_by_steps.h"

#include <chrono>

#include "error.h"
#include "identification/fit/intervals.h"
#include "identification/fit/local_search.h"
#include "identification/inverse_dynamics/search_fit.h"
#include "sim/io/interrupt.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;

Vector AtFineStep(const Problem& problem, const Fit& fit, const std::vector<bool>& use,
                  const ProgressCallback& progress) {
  const Uncertainty u = IntervalsOf(problem, fit.x, problem.Residuals(fit.x, use), progress);
  return u.step.size() == 0 ? fit.x : problem.Clamp(fit.x + u.step);
}

}  // namespace

Fit FitBySteps(const Problem& smooth, const Vector& start, const std::vector<bool>& use,
               std::uint64_t seed, const FitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  Problem stepped = smooth;
  stepped.Follow(Path::kStepped);
  FitOptions own = options;
  own.progress = Within({"fit by steps first"}, options.progress);
  Fit fit;
  fit.x = start;
  try {
    fit = FitBySearch(stepped, start, use, {}, own).fit;
    SearchAround(stepped, start, use, seed, own, fit);
    if (!StopRequested()) fit.x = AtFineStep(stepped, fit, use, own.progress);
  } catch (const Error& error) {
    if (error.kind() != Error::Kind::kJob) throw;  // it diverges
    fit.x = start;
  }
  fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return fit;
}

}  // namespace continuum
