#include "identification/diagnosis/numbers_off.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "identification/diagnosis/correction.h"
#include "identification/diagnosis/lengths_and_masses.h"

namespace continuum {
namespace {

bool ACorrectionDoesAsWell(const CandidateSearch& search, const Criteria& criteria) {
  const std::vector<LikelihoodRecord> records = search.Records();
  double most = 0;
  for (const LikelihoodRecord& one : records) most = std::max(most, one.likelihood);
  return std::any_of(records.begin(), records.end(), [&](const LikelihoodRecord& one) {
    return one.corrects && one.likelihood > criteria.correction_share * most;
  });
}

// Lengths and masses that may be and do what a named cause corrects, and does; null where they do
// less.
std::optional<ByLengthsAndMasses> InsteadOf(const CandidateResult& c, const CandidateFitter& fitter,
                                            const Diagnosis& d) {
  if (!NumbersMayDoAsMuch(c) || !OnlyCorrects(c.hypothesis, c.fitted, c.first_extra(),
                                              *fitter.experiment, d.sizes, d.criteria))
    return {};
  const ByLengthsAndMasses by =
      ExplainedByLengthsAndMasses(fitter, d.sizes, d.system, {}, d.before);
  if (by.squares + d.criteria.parameter_cost < d.before.cost - c.fitted.cost) return {};
  return by;
}

// Whether a cause takes anything to speak of off the error, on logs left out where there are any.
bool Helps(const CandidateResult& c, const Diagnosis& d) {
  const TwoErrors &before = d.before.error, &after = c.fitted.error;
  const double least = 1 - d.criteria.median_gain;
  return before.validate > 0 ? after.validate <= least * before.validate
                             : after.train <= least * before.train;
}

void NothingIsMissing(const ByLengthsAndMasses& by, Diagnosis& d) {
  const std::string numbers =
      fmt::format("lengths and masses that are at most {:.1f} % off", 100 * by.off);
  const std::optional<std::size_t> leading = d.verdict.leading;
  d.verdict = Verdict::Adequate(numbers + " do what shows");
  d.verdict.leading = leading, d.verdict.numbers_off = by.off, d.verdict.complete = false;
  d.remaining.would_take = numbers + " would take it";
}

}  // namespace

bool NumbersMayDoAsMuch(const CandidateResult& c) {
  const Hypothesis& h = c.hypothesis;
  if (h.extra.empty() || !c.fitted.complete()) return false;
  const Eigen::VectorXd& by = c.fitted.sensitivities->uncertainty.by_numbers;
  const Eigen::VectorXd own = c.fitted.fit.x.tail(static_cast<Eigen::Index>(h.extra.size()));
  const std::size_t main = h.Main({own.data(), h.extra.size()});
  const Eigen::Index at = c.first_extra() + static_cast<Eigen::Index>(main);
  return at < by.size() && std::abs(own[static_cast<Eigen::Index>(main)] - h.null[main]) <= by[at];
}

bool AllowForNumbers(const CandidateFitter& fitter, const CandidateSearch& search,
                     const std::optional<Pair>& pair, Diagnosis& d) {
  const CandidateResult* const best = pair ? pair->search.leading() : search.leading();
  if (d.Is(Verdict::Kind::kAdequate) || !best || !best->fitted.complete()) return false;
  const bool wanted = pair ? pair->first.correction == Partner::Correction::kBoth
                           : ACorrectionDoesAsWell(search, d.criteria);
  if (!wanted) return false;
  const double explained = d.before.cost - best->fitted.cost,
               above = d.before.cost - d.before.sensitivities->freedom;
  const ByLengthsAndMasses by =
      ExplainedByLengthsAndMasses(fitter, d.sizes, d.system, {}, d.before);
  if (!AreNumbersEnough(by, above, explained, d.criteria)) return false;
  NothingIsMissing(by, d);
  return true;
}

void AllowInIntervals(const CandidateFitter& fitter, const DiagnosisOptions& options,
                      Diagnosis& d) {
  std::vector<std::size_t> told = d.verdict.named;
  told.insert(told.end(), d.verdict.siblings.begin(), d.verdict.siblings.end());
  for (const std::size_t i : told) {
    CandidateResult& c = d.candidates[i];
    options.Say(DiagnosisStage::kJudgement, "lengths and masses beside " + c.hypothesis.Name());
    AllowForLengthsAndMasses(fitter, d.sizes, c.hypothesis.system, c.hypothesis.Free(),
                             !d.verdict.complete, c.fitted);
  }
}

void DoubtByNumbers(const CandidateFitter& fitter, Diagnosis& d) {
  if (!d.Is(Verdict::Kind::kNamed) || d.partner) return;
  const CandidateResult& named = *d.chosen();
  const auto numbers = InsteadOf(named, fitter, d);
  if (!numbers) return;
  if (!Helps(named, d)) return NothingIsMissing(*numbers, d);
  d.verdict.kind = Verdict::Kind::kAmbiguous, d.verdict.numbers = true;
  d.verdict.reason += "; lengths and masses that are a little off do as much";
}

}  // namespace continuum
