#include "identification/diagnosis/needless_sizes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "error.h"

namespace continuum {
namespace {

using Matrix = Problem::Matrix;
using Vector = Problem::Vector;

bool MayLoseSizes(const CandidateResult& c) {
  const Hypothesis& h = c.hypothesis;
  const auto sizes = h.Amplitudes();
  if (sizes.size() < 2 || !c.fitted.complete() || c.at_quarter_step) return false;
  return !EffectNamed(h.Card()).coulomb_level &&
         std::all_of(sizes.begin(), sizes.end(), [&](std::size_t i) {
           const Parameter& p = h.extra[i];
           return p.unit == h.extra[sizes.front()].unit && p.per == Parameter::Per::kAll &&
                  p.condition.empty();
         });
}

Hypothesis Without(Hypothesis h, std::size_t i) {
  const auto at = static_cast<std::ptrdiff_t>(i);
  h.extra.erase(h.extra.begin() + at);
  h.null.erase(h.null.begin() + at);
  for (std::vector<double>& start : h.starts) start.erase(start.begin() + at);
  return h;
}

Vector Without(const Vector& x, Eigen::Index k) {
  Vector less(x.size() - 1);
  less << x.head(k), x.tail(x.size() - 1 - k);
  return less;
}

// The fit without one of the sizes, the one that costs least; null where all diverge.
std::optional<CandidateResult> WithoutOne(const CandidateFitter& fitter, const CandidateResult& c) {
  std::optional<CandidateResult> best;
  for (const std::size_t i : c.hypothesis.Amplitudes()) {
    CandidateResult less = c;
    less.hypothesis = Without(c.hypothesis, i);
    const Vector start = Without(c.fitted.fit.x, c.first_extra() + static_cast<Eigen::Index>(i));
    try {
      less.fitted = fitter.FitAll(ProblemOf(less, *fitter.experiment), start);
    } catch (const Error&) {
      continue;
    }
    if (!best || less.fitted.cost < best->fitted.cost) best = std::move(less);
  }
  return best;
}

// Products of the columns of its own numbers, each over its whole range.
Matrix SquaresOfOwn(const CandidateResult& c) {
  const auto n = static_cast<Eigen::Index>(c.hypothesis.extra.size());
  Matrix squares = Matrix::Zero(n, n);
  for (const Matrix& J : c.fitted.sensitivities->jacobian) {
    if (J.size() == 0) continue;
    const auto own = J.middleCols(c.first_extra(), n);
    squares += own.transpose() * own;
  }
  Vector range(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Parameter& p = c.hypothesis.extra[static_cast<std::size_t>(i)];
    range[i] = p.upper - p.lower;
  }
  return range.asDiagonal() * squares * range.asDiagonal();
}

}  // namespace

std::size_t NumbersThatShow(const CandidateResult& c) {
  constexpr double kLeast = 1e-6;  // of squares, which differences of simulations resolve
  const std::size_t n = c.hypothesis.extra.size();
  if (!c.fitted.complete() || n < 2) return n;
  const Matrix squares = SquaresOfOwn(c);
  const double most = squares.diagonal().maxCoeff();
  if (!(most > 0) || !std::isfinite(most)) return n;
  Vector unit = squares.diagonal();
  for (double& square : unit) square = square > kLeast * kLeast * most ? 1 / std::sqrt(square) : 0;
  const Matrix alike = unit.asDiagonal() * squares * unit.asDiagonal();
  const Vector shares = alike.selfadjointView<Eigen::Lower>().eigenvalues();
  return static_cast<std::size_t>((shares.array() > kLeast).count());
}

bool DropNeedlessSizes(const CandidateFitter& fitter, CandidateResult& c) {
  bool dropped = false;
  while (MayLoseSizes(c) && !fitter.TimeIsOver()) {
    std::optional<CandidateResult> less = WithoutOne(fitter, c);
    if (!less) break;
    const double scale = std::max(1.0, c.fitted.cost / c.fitted.sensitivities->freedom);
    const double rises = less->fitted.cost - c.fitted.cost;
    if (rises > scale * (fitter.criteria.parameter_cost + fitter.criteria.nested_margin)) break;
    less->likelihood -= rises;
    less->probes.clear(), less->at_quarter_x.reset(), less->falls_with_step.reset();
    c = std::move(*less), dropped = true;
  }
  return dropped;
}

}  // namespace continuum
