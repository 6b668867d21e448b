#include "identification/inverse_dynamics/search_fit.h"

#include <utility>

#include "identification/fit/multi_start.h"
#include "identification/fit/multiple_shooting.h"
#include "identification/fit/wide_slope_fit.h"
#include "identification/inverse_dynamics/equation_error_fit.h"
#include "identification/inverse_dynamics/short_horizon.h"

namespace continuum {

SearchedFit FitBySearch(const Problem& problem, const Problem::Vector& x,
                        const std::vector<bool>& use, const FitSearch& search,
                        const FitOptions& options) {
  SearchedFit found;
  if (search.segments) found.segments = FitByMultipleShooting(problem, x, use, options);
  const Problem::Vector& begin = found.segments ? found.segments->x : x;
  if (search.starts > 1) {
    found.starts = FitFromMany(problem, begin, use, search.starts, search.seed, options);
    found.fit = found.starts->best;
  } else {
    found.fit = FitWithWideSlopes(problem, begin, use, options);
  }
  found.fit = FitByEquations(problem, std::move(found.fit), use, options);
  found.fit = FitByShortHorizons(problem, std::move(found.fit), use, options);
  if (found.starts) found.starts->best = found.fit;
  if (found.segments) {
    found.fit.seconds += found.segments->seconds;
    found.fit.evaluations += found.segments->evaluations;
  }
  return found;
}

}  // namespace continuum
