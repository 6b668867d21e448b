#include "identification/diagnosis/size_over_folds.h"

#include <cmath>

namespace continuum {
namespace {

using Vector = Problem::Vector;

double FromAbsence(const CandidateResult& c, const Vector& x, std::size_t i) {
  const double null = c.hypothesis.null[i];
  return x[c.first_extra() + static_cast<Eigen::Index>(i)] - (std::isinf(null) ? 0 : null);
}

// J a of every log.
std::vector<Vector> EffectOf(const CandidateResult& c, const Vector& x) {
  std::vector<Vector> all;
  for (const Problem::Matrix& J : c.fitted.sensitivities.value().jacobian) {
    all.push_back(Vector::Zero(J.rows()));
    for (const std::size_t i : c.hypothesis.Amplitudes())
      all.back() += FromAbsence(c, x, i) * J.col(c.first_extra() + static_cast<Eigen::Index>(i));
  }
  return all;
}

}  // namespace

std::vector<double> SizeOverFolds(const CandidateResult& c) {
  const Vector& fit = c.fitted.fit.x;
  const std::vector<Vector> whole = EffectOf(c, fit);
  const std::size_t main =
      c.hypothesis.Main({fit.data() + c.first_extra(), c.hypothesis.extra.size()});
  const double unit = FromAbsence(c, fit, main) / SumOfSquares(whole);
  std::vector<double> sizes;
  for (const Vector& x : c.fitted.folds.x) {
    const std::vector<Vector> there = EffectOf(c, x);
    double along = 0;
    for (std::size_t l = 0; l < whole.size(); ++l) along += there[l].dot(whole[l]);
    sizes.push_back(unit * along);
  }
  return sizes;
}

}  // namespace continuum
