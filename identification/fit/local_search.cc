#include "identification/fit/local_search.h"

#include <algorithm>
#include <chrono>

#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/fit/bounded_least_squares.h"
#include "identification/fit/evolution.h"
#include "identification/fit/ripples.h"
#include "identification/fit/wide_slope_fit.h"
#include "identification/statistics/noise_model.h"
#include "identification/statistics/uncertainty.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/shared_loop.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

constexpr double kLower = 1e-4;  // of the cost
constexpr int kRounds = 2;
constexpr double kAgain = 0.02;  // of the cost that a round takes off, for another one

// As a friction that went to zero: nothing rubs there, and slopes do not lead back.
bool IsAtBound(const Problem& problem, const Vector& x) {
  const std::vector<bool> at = AtBounds(problem, x);
  return std::find(at.begin(), at.end(), true) != at.end();
}

// As in a minimum that is none of the machine's. Where far more is left the model lacks something,
// and the least of its minima says little.
bool LeavesSome(const Problem& problem, const Vector& x, const std::vector<bool>& use) {
  const std::vector<Vector> r = problem.Residuals(x, use);
  return !IsFarOver(NoiseOf(problem.experiment()), TypicalRms(problem, r, use)) &&
         IsMoreThanNoise(problem, x, r, use);
}

// The costs of points; outside of the bounds that on them, and more by the distance.
std::vector<double> CostsOf(const Problem& problem, const std::vector<Vector>& points,
                            const std::vector<bool>& use, const FitOptions& options) {
  std::vector<double> costs(points.size());
  const auto evaluate = [&](std::size_t i) {
    const Vector x = problem.Clamp(Unscaled(problem, points[i].data()));
    const double beyond = (Scaled(problem, x) - points[i]).norm();
    costs[i] = (1 + beyond) * CostAt(problem, x, use, options);
  };
  ShareTasks(points.size(), evaluate, [&](auto& archive, std::size_t i) { archive(costs[i]); });
  return costs;
}

// Where the cost is least around a fit, which bears the effort.
Vector LeastAround(const Problem& problem, const Matrix& slopes, const std::vector<bool>& use,
                   std::uint64_t seed, const FitOptions& options, Fit& fit) {
  constexpr std::size_t kGenerations = 40, kInVain = 12;
  constexpr double kMuchLower = 1e-3;
  const auto begin = std::chrono::steady_clock::now();
  std::size_t generation = 0;
  const auto costs = [&](const std::vector<Vector>& points) {
    if (options.progress) options.progress({"look around it", generation++, kGenerations});
    return CostsOf(problem, points, use, options);
  };
  const Evolved best = Evolve(costs, Scaled(problem, fit.x), SpreadOf(fit, slopes),
                              {.generations = kGenerations,
                               .in_vain = kInVain,
                               .lower = fit.cost * (1 - kMuchLower),
                               .flat = kLower,
                               .seed = seed});
  fit.evaluations += best.evaluations;
  fit.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return problem.Clamp(Unscaled(problem, best.y.data()));
}

// The lower one of both, as one more iteration, with the effort of both.
void Take(const Fit& next, Fit& fit) {
  fit.evaluations += next.evaluations, fit.seconds += next.seconds;
  if (!(next.cost < fit.cost)) return;
  fit.x = next.x, fit.cost = next.cost;
  fit.converged = next.converged, fit.message = next.message;
  fit.trace.push_back(fit.cost), ++fit.iterations;
}

}  // namespace

bool HasDryFriction(const mjModel& m) {
  const auto positive = [](double value) { return value > 0; };
  if (std::any_of(m.dof_frictionloss, m.dof_frictionloss + m.nv, positive)) return true;
  if (std::any_of(m.tendon_frictionloss, m.tendon_frictionloss + m.ntendon, positive)) return true;
  for (int i = 0; i < m.nplugin; ++i) {
    const EffectInfo* const effect = EffectOf(m, i);
    if (effect &&
        (effect->kind == EffectInfo::Kind::kFriction || effect->kind == EffectInfo::Kind::kPath))
      return true;
  }
  return false;
}

LocalMinima SearchAround(const Problem& problem, const Vector& start, const std::vector<bool>& use,
                         std::uint64_t seed, const FitOptions& options, Fit& fit) {
  LocalMinima minima;
  if (fit.x.size() < 2 || problem.path() != Path::kStepped ||
      !HasDryFriction(problem.system().model()))
    return minima;
  const bool from_start = start.size() > 0;
  const bool elsewhere =
      IsAtBound(problem, fit.x) || (from_start && LeavesSome(problem, fit.x, use));
  if (fit.smooth && !elsewhere) return minima;
  FitOptions plain = options, secants = options;
  plain.idle = secants.idle = true, secants.rough = true;
  const auto take = [&](const Fit& other) {
    const bool lower = other.cost < fit.cost * (1 - kLower);
    minima.found.push_back(lower ? LocalMinimum{fit.x, fit.cost}
                                 : LocalMinimum{other.x, other.cost});
    Take(other, fit);
    return lower;
  };
  const auto try_from = [&](const Vector& x) {
    try {
      if (take(FitParameters(problem, x, use, secants)))
        Take(FitWithWideSlopes(problem, fit.x, use, plain), fit);
    } catch (const Error& error) {
      if (error.kind() != Error::Kind::kJob) throw;  // it diverges there
    }
  };
  const auto slopes_here = [&] {
    Matrix slopes;
    secants.slopes = &slopes;
    Take(FitParameters(problem, fit.x, use, secants), fit);
    secants.slopes = nullptr;
    return slopes;
  };
  Matrix slopes = slopes_here();
  if (!(fit.cost > 0) || StopRequested()) return minima;
  if (!elsewhere && !IsAtBound(problem, fit.x) && !HasRipples(problem, fit, slopes, use, options))
    return minima;
  if (from_start) try_from(start);
  for (int round = 0; round < kRounds && fit.cost > 0 && !StopRequested(); ++round) {
    if (round > 0 || from_start) slopes = slopes_here();
    const double before = fit.cost;
    const Vector x = LeastAround(problem, slopes, use, seed + round, plain, fit);
    if (!StopRequested()) try_from(x);
    if (fit.cost > (1 - kAgain) * before) break;
  }
  return minima;
}

}  // namespace continuum
