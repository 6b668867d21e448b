#include "identification/fit/multi_start.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "error.h"
#include "identification/fit/wide_slope_fit.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/portable_random.h"

namespace continuum {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double Drawn(const FreeParameter& p, double share) {
  constexpr double kWide = 10;  // of the bounds: their sizes matter, not their difference
  if (p.lower > 0 && p.upper > kWide * p.lower) return p.lower * std::pow(p.upper / p.lower, share);
  return p.lower + share * (p.upper - p.lower);
}

Problem::Vector RandomStart(const Problem& problem, Random& random) {
  Problem::Vector x = problem.Start();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    if (!p.IsStart()) x[i] = Drawn(p, random.Uniform());
  }
  return problem.Clamp(x);
}

}  // namespace

MultiStart FitFromMany(const Problem& problem, const Problem::Vector& x,
                       const std::vector<bool>& use, int starts, std::uint64_t seed,
                       const FitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  std::size_t evaluations = 0;
  Random random(seed);
  MultiStart all;
  all.best.cost = kInfinity;
  for (int k = 0; k < starts && !StopRequested(); ++k) {
    all.starts.push_back({k == 0 ? x : RandomStart(problem, random), kInfinity});
    FitOptions own = options;
    own.progress = Within(
        {"fits from several starts", static_cast<std::size_t>(k), static_cast<std::size_t>(starts)},
        options.progress);
    own.hopeless = all.best.cost;
    own.patience = 10;  // far away, steps say little of the next ones
    own.idle |= k > 0;  // far away a parameter may have none
    try {
      Fit fit = FitWithWideSlopes(problem, all.starts.back().x, use, own);
      all.starts.back().cost = fit.cost;
      evaluations += fit.evaluations;
      if (fit.cost < all.best.cost) all.best = std::move(fit);
    } catch (const Error& error) {
      if (error.kind() != Error::Kind::kJob) throw;
    }
  }
  if (all.best.x.size() == 0) throw Error::Job("the simulation diverges from every start");
  all.best.evaluations = evaluations;
  all.best.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return all;
}

}  // namespace continuum
