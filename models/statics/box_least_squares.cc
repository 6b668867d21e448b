#include "models/statics/box_least_squares.h"

#include <algorithm>
#include <vector>

#include "sim/numerics/decompositions.h"

namespace continuum::statics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The minimum over the free unknowns, the others as they are.
VectorXd Free(const MatrixXd& H, const VectorXd& g, const VectorXd& w,
              const std::vector<bool>& held) {
  std::vector<Index> free;
  VectorXd fixed = w;
  for (Index i = 0; i < w.size(); ++i) {
    if (held[static_cast<std::size_t>(i)]) continue;
    free.push_back(i);
    fixed[i] = 0;
  }
  VectorXd best = w;
  if (free.empty()) return best;
  const VectorXd right = g - H * fixed;
  const Eigen::LDLT<MatrixXd> factors(MatrixXd(H(free, free)));
  const VectorXd solved = factors.solve(VectorXd(right(free)));
  best(free) = solved;
  return best;
}

// Moves w towards `best` until it meets a limit, and holds the unknown that does; false when none
// does.
bool MoveToLimit(const VectorXd& best, const VectorXd& low, const VectorXd& high, VectorXd& w,
                 std::vector<bool>& held) {
  double share = 1;
  Index first = -1;
  for (Index i = 0; i < w.size(); ++i) {
    const double step = best[i] - w[i];
    const double limit = step < 0 ? low[i] : high[i];
    if (held[static_cast<std::size_t>(i)] || step == 0 || (best[i] - limit) * step <= 0) continue;
    const double its = std::max(0.0, (limit - w[i]) / step);
    if (its >= share) continue;
    share = its;
    first = i;
  }
  w += share * (best - w);
  if (first < 0) return false;
  w[first] = best[first] < low[first] ? low[first] : high[first];
  held[static_cast<std::size_t>(first)] = true;
  return true;
}

}  // namespace

VectorXd WithinLimits(const MatrixXd& H, const VectorXd& g, const VectorXd& low,
                      const VectorXd& high) {
  VectorXd w = VectorXd::Zero(g.size()).cwiseMax(low).cwiseMin(high);
  std::vector<bool> held(static_cast<std::size_t>(g.size()), false);
  const double small = 1e-12 * (1 + g.cwiseAbs().maxCoeff());
  for (Index round = 0; round < 20 * g.size(); ++round) {
    while (MoveToLimit(Free(H, g, w, held), low, high, w, held)) {
    }
    const VectorXd downhill = g - H * w;
    Index worst = -1;
    double most = small;
    for (Index i = 0; i < w.size(); ++i) {
      if (!held[static_cast<std::size_t>(i)]) continue;
      const double inward = w[i] <= low[i] ? downhill[i] : -downhill[i];
      if (inward <= most || low[i] == high[i]) continue;
      most = inward;
      worst = i;
    }
    if (worst < 0) break;
    held[static_cast<std::size_t>(worst)] = false;
  }
  return w;
}

}  // namespace continuum::statics
