#include "identification/study/random_effects.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "error.h"

namespace continuum {
namespace {

namespace bm = boost::math;

struct Weighted {
  double mean, weight, q;
};

Weighted At(const std::vector<UnitValue>& units, double variance) {
  double weight = 0, sum = 0, q = 0;
  for (const UnitValue& u : units) {
    const double w = 1 / (u.standard_error * u.standard_error + variance);
    weight += w;
    sum += w * u.value;
  }
  const double mean = sum / weight;
  for (const UnitValue& u : units)
    q += (u.value - mean) * (u.value - mean) / (u.standard_error * u.standard_error + variance);
  return {mean, weight, q};
}

// τ² at which Q, which falls with it, has a value; 0 where it is less from the beginning.
double VarianceAt(const std::vector<UnitValue>& units, double q) {
  if (At(units, 0).q <= q) return 0;
  double low = 0, high = units.front().standard_error * units.front().standard_error;
  while (At(units, high).q > q) low = high, high *= 2;
  for (int k = 0; k < 200 && high - low > 1e-14 * high; ++k) {
    const double middle = (low + high) / 2;
    (At(units, middle).q > q ? low : high) = middle;
  }
  return (low + high) / 2;
}

void RequireUnits(const std::vector<UnitValue>& units, std::size_t least) {
  const auto bad = [](const UnitValue& u) {
    return !std::isfinite(u.value) || !std::isfinite(u.standard_error) || u.standard_error <= 0;
  };
  if (units.size() < least || std::any_of(units.begin(), units.end(), bad)) {
    throw Error::Input("random effects",
                       std::to_string(least) + " units or more with positive standard errors",
                       std::to_string(units.size()));
  }
}

}  // namespace

RandomEffects FitRandomEffects(const std::vector<UnitValue>& units) {
  RequireUnits(units, 2);
  const auto freedom = static_cast<double>(units.size() - 1);
  const bm::chi_squared chi(freedom);
  const double variance = VarianceAt(units, freedom);
  const Weighted at = At(units, variance);
  const double half = bm::quantile(bm::students_t(freedom), 0.975) *
                      std::sqrt(std::max(1.0, at.q / freedom) / at.weight);
  return {at.mean,
          at.mean - half,
          at.mean + half,
          std::sqrt(variance),
          std::sqrt(VarianceAt(units, bm::quantile(chi, 0.975))),
          std::sqrt(VarianceAt(units, bm::quantile(chi, 0.025))),
          bm::cdf(bm::complement(chi, At(units, 0).q))};
}

std::vector<UnitDeviation> DeviationsOf(const std::vector<UnitValue>& units) {
  RequireUnits(units, 3);
  const auto count = static_cast<double>(units.size());
  const bm::students_t student(count - 2);
  std::vector<UnitDeviation> all;
  for (std::size_t i = 0; i < units.size(); ++i) {
    std::vector<UnitValue> others = units;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const double variance = VarianceAt(others, count - 2);
    const Weighted at = At(others, variance);
    const double own = units[i].standard_error;
    const double t = (units[i].value - at.mean) / std::sqrt(own * own + variance + 1 / at.weight);
    const double p = 2 * bm::cdf(bm::complement(student, std::abs(t)));
    all.push_back({t, p, p < 0.05 / count});
  }
  return all;
}

}  // namespace continuum
