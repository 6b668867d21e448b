#include "identification/fit/multi_start.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "error.h"
#include "identification/fit/wide_slope_fit.h"
#include "identification/result/fit_bytes.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/portable_random.h"
#include "sim/numerics/shared_loop.h"

namespace continuum {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kBeside = 8;  // fits that know nothing of each other

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

// Where a fit begins, and what it finds; nothing where the simulation diverges there.
struct Attempt {
  Problem::Vector x;
  std::optional<Fit> fit = {};
};

// Of one start. best: the cost that it must come near.
FitOptions OptionsOf(const FitOptions& options, std::size_t start, std::size_t starts,
                     double best) {
  FitOptions own = options;
  own.progress = Within({"fits from several starts", start, starts}, options.progress);
  own.hopeless = best;
  own.patience = 10;      // far away, steps say little of the next ones
  own.idle |= start > 0;  // far away a parameter may have none
  return own;
}

}  // namespace

// The first one alone, then several that know what those before them have reached, but nothing of
// each other: as many on every machine.
MultiStart FitFromMany(const Problem& problem, const Problem::Vector& x,
                       const std::vector<bool>& use, int starts, std::uint64_t seed,
                       const FitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const auto count = static_cast<std::size_t>(starts);
  std::size_t evaluations = 0;
  Random random(seed);
  MultiStart all;
  all.best.cost = kInfinity;
  while (all.starts.size() < count && !StopRequested()) {
    const std::size_t first = all.starts.size();
    std::vector<Attempt> beside;
    for (std::size_t k = first; k < std::min(count, first == 0 ? 1 : first + kBeside); ++k)
      beside.push_back({k == 0 ? x : RandomStart(problem, random)});
    const auto fit = [&](std::size_t i) {
      if (StopRequested()) return;
      const FitOptions own = OptionsOf(options, first + i, count, all.best.cost);
      try {
        beside[i].fit = FitWithWideSlopes(problem, beside[i].x, use, own);
      } catch (const Error& error) {
        if (error.kind() != Error::Kind::kJob) throw;
      }
    };
    ShareTasks(beside.size(), fit, [&](auto& archive, std::size_t i) { archive(beside[i].fit); });
    for (Attempt& one : beside) {
      if (!one.fit && StopRequested()) break;
      all.starts.push_back({std::move(one.x), one.fit ? one.fit->cost : kInfinity});
      if (!one.fit) continue;
      evaluations += one.fit->evaluations;
      if (one.fit->cost < all.best.cost) all.best = std::move(*one.fit);
    }
  }
  if (all.best.x.size() == 0) StopIfRequested();
  if (all.best.x.size() == 0) throw Error::Job("the simulation diverges from every start");
  all.best.evaluations = evaluations;
  all.best.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return all;
}

}  // namespace continuum
