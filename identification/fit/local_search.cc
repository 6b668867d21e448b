#include "identification/fit/local_search.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/fit/bounded_least_squares.h"
#include "identification/fit/wide_slope_fit.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/portable_random.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

constexpr std::size_t kFits = 4;
constexpr double kHigher = 0.1;  // of the cost
constexpr double kLower = 1e-4;  // of the cost

bool Rubs(const mjModel& m) {
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

// Where the cost is higher by a share of it, in a random direction, as the slopes at x say. So a
// parameter that the logs say little of moves far.
Vector Beside(const Problem& problem, const Fit& fit, const Matrix& slopes, Random& random) {
  Vector z(fit.x.size());
  for (double& one : z) one = random.Normal();
  const Eigen::HouseholderQR<Matrix> qr(slopes);
  const Matrix R = qr.matrixQR().topRows(z.size()).triangularView<Eigen::Upper>();
  for (Eigen::Index i = 0; i < z.size(); ++i)
    if (!(std::abs(R(i, i)) > 0)) return fit.x;  // nothing depends on it
  const Vector step =
      R.triangularView<Eigen::Upper>().solve(std::sqrt(2 * kHigher * fit.cost) / z.norm() * z);
  const Vector y = Scaled(problem, fit.x) + step;
  return Unscaled(problem, y.data());
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

LocalMinima SearchAround(const Problem& problem, const Vector& start, const std::vector<bool>& use,
                         std::uint64_t seed, const FitOptions& options, Fit& fit) {
  LocalMinima minima;
  if (fit.x.size() < 2 || problem.path() != Path::kStepped || !Rubs(problem.system().model()))
    return minima;
  Random random(seed);
  Matrix slopes;  // where the fit has ended
  FitOptions plain = options, secants = options;
  plain.idle = secants.idle = true, secants.rough = true;
  enum { kFromStart, kFromFit, kBeside };
  for (std::size_t k = 0; k < kBeside + kFits && !StopRequested(); ++k) {
    Matrix own = k < kBeside ? Matrix() : slopes;
    secants.slopes = &own;
    secants.progress = Within({"fits from beside it", k, kBeside + kFits}, options.progress);
    try {
      const Vector from = k == kFromStart ? start
                          : k == kFromFit ? fit.x
                                          : Beside(problem, fit, slopes, random);
      const Fit other = FitParameters(problem, from, use, secants);
      const bool lower = other.cost < fit.cost * (1 - kLower);
      if (k != kFromFit)
        minima.found.push_back(lower ? LocalMinimum{fit.x, fit.cost}
                                     : LocalMinimum{other.x, other.cost});
      Take(other, fit);
      if (lower) Take(FitWithWideSlopes(problem, fit.x, use, plain), fit);
      if (lower || k == kFromFit) slopes = std::move(own);
    } catch (const Error& error) {
      if (error.kind() != Error::Kind::kJob || k == kFromFit) throw;
    }
  }
  return minima;
}

}  // namespace continuum
