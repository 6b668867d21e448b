#include "identification/diagnosis/gain.h"

#include <algorithm>
#include <cmath>

namespace continuum {
Gain GainOf(const Diagnosis& d, const TwoErrors& after) {
  const double before2 = d.before.error.validate * d.before.error.validate;
  const double after2 = after.validate * after.validate;
  const double noise2 = d.noise.rms * d.noise.rms;
  Gain gain;
  gain.removed = before2 > 0 ? 1 - std::sqrt(after2 / before2) : 0;
  if (before2 > noise2) gain.explainable = (before2 - after2) / (before2 - noise2);
  return gain;
}

bool NothingHelps(const Diagnosis& d) {
  return !d.chosen() && !d.Is(Verdict::Kind::kAdequate) &&
         !(d.ceiling_error.validate < d.before.error.validate);
}

double ShareReached(const Diagnosis& d, const TwoErrors& after) {
  if (NothingHelps(d)) return 0;
  const double possible =
      d.before.error.validate - std::min(d.ceiling_error.validate, after.validate);
  return possible > 0 ? std::clamp((d.before.error.validate - after.validate) / possible, 0.0, 1.0)
                      : 1;
}

double Share(const Diagnosis& d, const CandidateResult& c) {
  if (!d.noise_limited) return Median(Gains(c.record));
  const double freedom = d.before.complete() ? d.before.sensitivities->freedom : 0;
  const double explainable = std::max(d.before.cost - freedom, 1.0);
  return std::clamp(c.likelihood / explainable, 0.0, 1.0);  // a fit cut short may be below the null
}

bool ModelLimited(const Diagnosis& d, const TwoErrors& after) {
  return after.train > d.criteria.model_limited * d.noise.floor();
}

double Separation(const Diagnosis& d) {
  if (d.candidates.size() < 2) return 0;
  if (d.noise_limited) return std::abs(d.candidates[0].likelihood - d.candidates[1].likelihood);
  const auto& a = d.candidates[0].record;
  const auto& b = d.candidates[1].record;
  if (b.after.empty()) return 0;
  const double n = static_cast<double>(a.after.size());
  double mean = 0, squares = 0;
  for (std::size_t f = 0; f < a.after.size(); ++f) mean += (b.after[f] - a.after[f]) / n;
  for (std::size_t f = 0; f < a.after.size(); ++f) {
    squares += std::pow(b.after[f] - a.after[f] - mean, 2);
  }
  return squares > 0 ? std::abs(mean) / std::sqrt(squares / (n - 1) / n) : 0;
}

double FoldsWon(const Diagnosis& d, const CandidateResult& c) {
  std::size_t won = 0;
  for (std::size_t f = 0; f < c.record.after.size(); ++f) {
    won += std::all_of(d.candidates.begin(), d.candidates.end(), [&](const CandidateResult& other) {
      return other.record.after.empty() || other.record.after[f] >= c.record.after[f];
    });
  }
  return static_cast<double>(won) /
         static_cast<double>(std::max<std::size_t>(c.record.after.size(), 1));
}

}  // namespace continuum
