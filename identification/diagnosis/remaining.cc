#include "identification/diagnosis/remaining.h"

#include <cmath>

#include <fmt/format.h>

#include "identification/diagnosis/fold_comparison.h"

namespace continuum {
namespace {

// Root mean square over the measured rows of one channel; residuals of rows that were not are zero.
double RmsOf(const Eigen::Ref<const Problem::Vector>& rows) {
  const double measured = static_cast<double>((rows.array() != 0).count());
  return measured > 0 ? rows.norm() / std::sqrt(measured) : 0;
}

}  // namespace

Remaining RemainingOf(const Problem& problem, const Fitted& fitted, const Noise& noise) {
  Remaining remaining;
  const double floor = noise.floor();
  if (noise.rms > 0) remaining.over_noise = fitted.error.train / floor;
  const Experiment& e = problem.experiment();
  const auto& channels = problem.channels();
  double most = 0;
  for (std::size_t l = 0; l < fitted.residuals.size(); ++l) {
    const auto rows = static_cast<Eigen::Index>(e.logs[l].rows());
    for (std::size_t c = 0; c < channels.size() && fitted.residuals[l].size() > 0; ++c) {
      const double rms =
          RmsOf(fitted.residuals[l].segment(static_cast<Eigen::Index>(c) * rows, rows));
      if (rms <= most) continue;
      most = rms;
      remaining.where =
          fmt::format("{} of log '{}'", e.channels[channels[c]].name, e.logs[l].label);
    }
  }
  return remaining;
}

bool LeavesMuch(const Diagnosis& d, const CandidateResult* best) {
  const TwoErrors& left = best ? best->fitted.error : d.before.error;
  return left.train > d.criteria.model_limited * d.noise.floor();
}

std::string WouldTake(const Diagnosis& d) {
  if (!d.noise_limited) {
    if (d.ceiling.error.empty() || CeilingGain(d) < d.criteria.median_gain) return "";
    return fmt::format("{} takes {:.0f} % off the error", d.ceiling_by, 100 * CeilingGain(d));
  }
  if (!d.lack_of_fit.significant(d.criteria)) return "";
  return d.lack_of_fit.force <= d.lack_of_fit.channel
             ? "a smooth force of angle, speed and load takes some of it"
             : "constants or shifts in time of the channels take some of it";
}

}  // namespace continuum
