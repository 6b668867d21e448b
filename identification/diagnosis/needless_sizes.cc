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

// Whether a cause has several sizes, in one unit, and is not another law without one of them.
bool MayLoseSizes(const Hypothesis& h) {
  const auto sizes = h.Amplitudes();
  if (sizes.size() < 2 || EffectNamed(h.Card()).coulomb_level) return false;
  return std::all_of(sizes.begin(), sizes.end(), [&](std::size_t i) {
    const Parameter& p = h.extra[i];
    return p.unit == h.extra[sizes.front()].unit && p.per == Parameter::Per::kAll &&
           p.condition.empty();
  });
}

void TakeOut(std::size_t i, Hypothesis& h) {
  const auto at = static_cast<std::ptrdiff_t>(i);
  h.extra.erase(h.extra.begin() + at);
  h.null.erase(h.null.begin() + at);
  for (std::vector<double>& start : h.starts) start.erase(start.begin() + at);
}

Vector Without(const Vector& x, Eigen::Index k) {
  Vector less(x.size() - 1);
  less << x.head(k), x.tail(x.size() - 1 - k);
  return less;
}

// Squares of the simulation itself: to first order a size that does nothing would promise much.
double Simulated(const CandidateResult& c) { return c.fitted.sensitivities->simulated.here; }

// A fit without one of the sizes of a cause.
struct Fewer {
  CandidateResult candidate;
  std::size_t size;
};

// The last one that is not missed, as a law begins with its plainest size; null where all are, or
// diverge. of: the candidate's own cause, or the one beside which it acts. most: squares that one
// has to earn.
std::optional<Fewer> WithoutOne(const CandidateFitter& fitter, const CandidateResult& c,
                                const Hypothesis& of, double most) {
  const bool own = &of == &c.hypothesis;
  const auto count = static_cast<Eigen::Index>(own ? 0 : c.hypothesis.given.size());
  auto sizes = of.Amplitudes();
  std::reverse(sizes.begin(), sizes.end());
  for (const std::size_t i : sizes) {
    Fewer less{c, i};
    Hypothesis& h = less.candidate.hypothesis;
    const auto at = static_cast<std::ptrdiff_t>(i);
    if (own) {
      TakeOut(i, h);
    } else {
      h.given.erase(h.given.begin() + at);
    }
    const Vector start = Without(c.fitted.fit.x, c.first_extra() - count + at);
    try {
      less.candidate.fitted = fitter.FitAll(ProblemOf(less.candidate, *fitter.experiment), start);
    } catch (const Error&) {
      continue;
    }
    if (Simulated(less.candidate) - Simulated(c) <= most) return less;
  }
  return {};
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

// Squares that a fit leaves over those of noise, at least 1.
double OverNoise(const CandidateResult& c) {
  return std::max(1.0, c.fitted.cost / c.fitted.sensitivities->freedom);
}

// Takes a size of a cause out of the candidate's fit where the squares rise by less than what a
// parameter has to earn. Returns which.
std::optional<std::size_t> DropOne(const CandidateFitter& fitter, const Hypothesis& of,
                                   CandidateResult& c) {
  if (!fitter.whitening.active() || !MayLoseSizes(of) || !c.fitted.complete() ||
      c.at_quarter_step || fitter.TimeIsOver())
    return {};
  const double most =
      OverNoise(c) * (fitter.criteria.parameter_cost + fitter.criteria.nested_margin);
  std::optional<Fewer> less = WithoutOne(fitter, c, of, most);
  if (!less) return {};
  CandidateResult& fewer = less->candidate;
  fewer.likelihood -= Simulated(fewer) - Simulated(c);
  fewer.probes.clear(), fewer.at_quarter_x.reset(), fewer.falls_with_step.reset();
  c = std::move(fewer);
  return less->size;
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
  while (DropOne(fitter, c.hypothesis, c)) dropped = true;
  return dropped;
}

bool DropNeedlessSizes(const CandidateFitter& fitter, CandidateResult& c, Hypothesis& beside) {
  bool dropped = false;
  while (const auto size = DropOne(fitter, beside, c)) TakeOut(*size, beside), dropped = true;
  return dropped;
}

}  // namespace continuum
