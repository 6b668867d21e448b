#include "identification/diagnosis/search_rules.h"

#include <algorithm>
#include <cmath>

namespace continuum {

double ProbeTarget(double squares, double freedom, bool calibrated, const Criteria& criteria) {
  return calibrated ? std::sqrt(std::max<double>(criteria.probe_least, squares - freedom))
                    : std::sqrt(0.5 * squares);
}

double SmallerShare(double norm, double target, const Criteria& criteria) {
  return norm > criteria.probe_far * target ? target / norm : 1;
}

double LargerShare(double norm, double target, double most, const Criteria& criteria) {
  return norm > 0 && criteria.probe_far * norm < target ? std::min(target / norm, most) : 1;
}

double StartShare(double explained, double probed, const Criteria& criteria) {
  const double least = criteria.start_share * probed;
  return std::abs(explained) > least ? explained : least;
}

bool IsAsGood(double explained, double best, const Criteria& criteria) {
  return explained >= criteria.as_good * best;
}

double GainKept(double promised, double here, double there, const Criteria& criteria) {
  const double kept = std::max(here, there);  // `here` where `there` is no number
  return kept < criteria.kept_share * promised ? kept : promised;
}

bool ReachesNoise(double error, const ErrorParts& parts, const Criteria& criteria) {
  return error < std::hypot(criteria.at_noise * parts.noise, criteria.step_tolerance * parts.step);
}

bool IsWithinNoise(double error, const ErrorParts& parts) {
  return error <= std::hypot(parts.noise, parts.step);
}

bool HasSignal(double smallest_p, double squares, double freedom, const Criteria& criteria) {
  return smallest_p < criteria.significance ||
         squares > criteria.model_limited * criteria.model_limited * freedom;
}

// Where little is to be explained first order is right to a few units, else wrong about sizes by
// factors but not by orders of magnitude.
double FitThreshold(double most, double squares, bool noise_known, const Criteria& criteria) {
  if (!noise_known) return criteria.worth_a_fit * squares;
  const double near = std::min<double>(most - criteria.fit_behind, criteria.fit_always);
  return std::max(near, criteria.fit_share * most);
}

double FitThresholdAtNoise(double most, const Criteria& criteria) {
  return criteria.outdoes * most;
}

double UnlistedThreshold(double most, const Criteria& criteria) {
  return criteria.rival_share * most;
}

bool ExplainsForce(double share, double most, const Criteria& criteria) {
  return share >= std::max<double>(criteria.force_least, criteria.force_share * most);
}

bool TooManyUnseen(std::size_t unseen, std::size_t all, const Criteria& criteria) {
  return static_cast<double>(unseen) > criteria.unseen * static_cast<double>(all);
}

// The upper tail of chi squared at an even number of degrees of freedom 2 k, which is a sum.
double ChanceOfGain(double gain, std::size_t parameters, std::size_t fits) {
  if (!(gain > 0)) return 1;
  const std::size_t k = (parameters + 1) / 2;
  double term = 1, sum = 1;
  for (std::size_t j = 1; j < k; ++j) sum += term *= 0.5 * gain / static_cast<double>(j);
  return std::min(1.0, static_cast<double>(fits) * std::exp(-0.5 * gain) * sum);
}

bool WorthFinishing(std::size_t finished, double explained, double most, const Criteria& criteria) {
  return static_cast<double>(finished) < criteria.second_chances &&
         explained >= FitThresholdAtNoise(most, criteria);
}

bool GoOnInVain(std::size_t since_better, const Criteria& criteria) {
  return static_cast<double>(since_better) >= criteria.fits_in_vain;
}

double HopelessCost(double rival, const Criteria& criteria) {
  return criteria.hopeless_factor * rival + criteria.hopeless_offset;
}

bool StillGains(double last_gain, double cost, bool noise_known, const Criteria& criteria) {
  return last_gain > (noise_known ? +criteria.still_gains : criteria.still_gains_share * cost);
}

bool WorthCompleting(double squares, double best, double step_reduction, const Criteria& criteria) {
  return squares - best < criteria.completed_within + 2 * step_reduction;
}

bool ExplainedByStep(double squares, double freedom, double step_squares,
                     const Criteria& criteria) {
  const double most = criteria.step_tolerance * criteria.step_tolerance * step_squares;
  return step_squares > criteria.step_seen && squares - freedom <= most;
}

bool FallsWithStep(double before, double after, const Criteria& criteria) {
  return after < criteria.step_falls * before;
}

bool IsRough(double roughness, const Criteria& criteria) {
  return roughness >= criteria.step_rough;
}

bool IsResolved(double step, double base_step, double removed, double noise,
                const Criteria& criteria) {
  return step < base_step + removed + criteria.step_resolved * noise;
}

// Nested fits are as far apart as the larger one gains; others that gain as much are farther. Where
// the noise is not known they are as near as nothing to what either changes.
bool SaysTheSame(const FitPair& pair, bool noise_known, const Criteria& criteria) {
  if (!noise_known) return pair.difference < criteria.same_share * pair.likelihood;
  return std::abs(pair.gain) <= criteria.same_gain &&
         pair.difference < 2 * std::max(pair.gain, 0.0) + criteria.same_noise;
}

bool Contains(double missed, double squares, const Criteria& criteria) {
  return missed < criteria.contained * squares;
}

bool WorthFolds(double before, double after, const Criteria& criteria) {
  return after <= (1 - criteria.fit_gain) * before;
}

// Something is left that matters, or only the time step may have left it; and the best one's
// residual is not a hundred times the noise's squares.
bool MayBeTwo(const Verdict& verdict, const LackOfFit& lack, double smallest_p, double over_noise,
              const Criteria& criteria) {
  const bool adequate = verdict.kind == Verdict::Kind::kAdequate;
  const bool left = 1 - verdict.leading_share >= criteria.second_share ||
                    (!lack.of_step && over_noise >= criteria.rest_noise);
  const bool more = !adequate && (!verdict.complete || lack.of_step) && left;
  return more && verdict.explained_by.empty() && smallest_p < criteria.significance &&
         over_noise < criteria.pair_hopeless;
}

bool MayBeTwoPlainer(const Verdict& verdict, bool rich, double over_noise,
                     const Criteria& criteria) {
  return rich && verdict.kind != Verdict::Kind::kAdequate && !verdict.complete &&
         verdict.explained_by.empty() && over_noise >= criteria.at_noise;
}

bool WorthPartner(double smallest_p, double share, bool of_step, const Criteria& criteria) {
  return smallest_p < criteria.significance && (!of_step || share >= criteria.pair_share);
}

bool MayDoBesideAnother(double plain, double richer, const Criteria& criteria) {
  return plain >= criteria.pair_plain * richer;
}

bool WorthFallback(double ceiling_gain, bool noise_limited, const Criteria& criteria) {
  return noise_limited || ceiling_gain >= criteria.fallback_ceiling * criteria.median_gain;
}

bool Distinguishes(double separation, const Criteria& criteria) {
  return separation >= criteria.separation;
}

}  // namespace continuum
