#include "identification/diagnosis/candidate_search.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "binding/effect_catalog.h"
#include "identification/diagnosis/correction.h"
#include "identification/diagnosis/family_starts.h"
#include "identification/diagnosis/lack_of_fit.h"
#include "identification/diagnosis/needless_sizes.h"
#include "identification/diagnosis/probing.h"
#include "identification/statistics/uncertainty.h"

namespace continuum {
namespace {

bool FollowsTheSameMotion(const CandidateFitter& fitter, const CandidateResult& b,
                          const CandidateResult& a) {
  if (!a.was_fitted || !b.was_fitted) return false;
  const auto train = TrainLogs(*fitter.experiment);
  std::vector<Problem::Vector> between(train.size());
  for (std::size_t l = 0; l < train.size(); ++l)
    if (train[l]) between[l] = b.fitted.residuals[l] - a.fitted.residuals[l];
  const double difference = fitter.whitening.Stack(between, train).squaredNorm();
  return SaysTheSame({b.likelihood - a.likelihood, difference, a.likelihood},
                     fitter.whitening.active(), fitter.criteria);
}

// The candidates of the options, if any, in place of the experiment's.
std::vector<Hypothesis> CandidatesAskedFor(const Experiment& e, const DiagnosisOptions& options,
                                           const SearchBase& from, const Sizes& sizes,
                                           std::vector<std::string>& skipped, SearchScope scope) {
  if (options.candidates.empty()) return MakeCandidates(e, from, sizes, skipped, scope);
  std::vector<Candidate> wanted;
  for (const auto& name : options.candidates) {
    const Candidate* const written = e.Written(name);
    wanted.push_back(written ? *written : Candidate{name, "", false});
  }
  return MakeCandidates(wanted, e, from, sizes, skipped, scope);
}

}  // namespace

bool Contains(const CandidateFitter& fitter, const CandidateResult& b, const CandidateResult& a) {
  if (ContainsByCard(b.hypothesis, a.hypothesis)) return true;
  if (NumbersThatShow(b) <= NumbersThatShow(a)) return false;
  if (FollowsTheSameMotion(fitter, b, a)) return true;
  if (a.probes.empty() || b.probes.empty()) return false;
  const Problem::Matrix &A = a.probes.front().AtStart(), &B = b.probes.front().AtStart();
  if (A.cols() >= B.cols()) return false;
  const Problem::Matrix rest = A - B * B.completeOrthogonalDecomposition().solve(A);
  return Contains(rest.squaredNorm(), A.squaredNorm(), fitter.criteria);
}

CandidateSearch::CandidateSearch(const SearchContext& context, const BaseFit& base,
                                 SearchScope scope)
    : fitter_(context.fitter),
      base_(base),
      base_problem_(*context.fitter.experiment, *base.system, base.given),
      noise_(context.noise),
      sizes_(context.sizes),
      options_(context.options),
      criteria_(context.fitter.criteria) {
  if (base.problem) base_problem_.Recall(*base.problem);
  const SearchBase here{base.system, base.given, base_problem_.CommonChanges(base.fitted->fit.x)};
  for (Hypothesis& h :
       CandidatesAskedFor(*fitter_.experiment, options_, here, sizes_, skipped, scope)) {
    candidates.push_back({std::move(h)});
    candidates.back().record.name = candidates.back().hypothesis.Name();
  }
}

double CandidateSearch::MostExplained() const {
  double best = 0;
  for (const CandidateResult& c : candidates) best = std::max(best, c.explained);
  return best;
}

double CandidateSearch::ExplainableShare() const {
  const double above = base_.fitted->cost - base_.fitted->sensitivities.value().freedom;
  return above > 0 ? MostExplained() / above : 0;
}

void CandidateSearch::Join(CandidateSearch other) {
  for (CandidateResult& c : other.candidates) {
    c.likelihood = Likelihood(c.fitted);  // in this search's unit of noise
    candidates.push_back(std::move(c));
  }
  for (CandidateResult& c : other.dismissed) dismissed.push_back(std::move(c));
  for (std::string& s : other.skipped) skipped.push_back(std::move(s));
  for (std::string& s : other.left_out) left_out.push_back(std::move(s));
  Rank();
}

void CandidateSearch::JoinUnlisted(CandidateSearch other) {
  for (CandidateResult& c : other.candidates) {
    c.listed = false;
    c.likelihood = Likelihood(c.fitted);
    candidates.push_back(std::move(c));
  }
  for (std::string& s : other.left_out) left_out.push_back(std::move(s));
}

double CandidateSearch::Likelihood(const Fitted& fitted) const {
  const double promised = base_.fitted->cost - fitted.cost;
  if (!fitted.complete() || !base_.fitted->complete()) return promised / inflation_;
  const SimulatedSquares before = base_.fitted->sensitivities->simulated,
                         after = fitted.sensitivities->simulated;
  return GainKept(promised, before.here - after.here, before.there - after.there, criteria_) /
         inflation_;
}

void CandidateSearch::CountAs(const CandidateSearch& other) {
  for (CandidateResult& c : candidates) c.likelihood *= inflation_ / other.inflation_;
  inflation_ = other.inflation_;
}

void CandidateSearch::Dismiss() {
  std::vector<CandidateResult> kept;
  for (CandidateResult& c : candidates) {
    if (c.was_fitted) {
      kept.push_back(std::move(c));
    } else if (!c.error.empty()) {
      skipped.push_back(c.hypothesis.Name() + ": " + c.error);
    } else {
      dismissed.push_back(std::move(c));
    }
  }
  candidates = std::move(kept);
  Rank();
}

void CandidateSearch::Rank() {
  smallest_p_ = 1;
  for (CandidateResult& c : candidates) {
    if (c.probes.empty() && c.was_fitted && noise_.known())
      c.p = ChanceOfGain(c.likelihood, c.hypothesis.extra.size(), candidates.size());
  }
  for (const auto* all : {&candidates, &dismissed}) {
    for (const CandidateResult& c : *all) smallest_p_ = std::min(smallest_p_, c.p);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.likelihood > b.likelihood; });
  ComputeLambda();
}

// |M (r_1 − r)|² between the fits, M what the other one's parameters cannot follow; without both
// fits |v − P v|², v what the leading candidate's directions explain, P onto the other's.
void CandidateSearch::ComputeLambda() {
  if (!noise_.known() || candidates.empty() || candidates.front().probes.empty()) return;
  const CandidateResult& first = candidates.front();
  const ProjectedResidual residual = fitter_.ProjectedResidualOf(*base_.fitted);
  const Probe& lead = first.probes.front();
  const Problem::Vector v = lead.columns * ExplainedBy(lead, residual.vector()).coefficients;
  for (CandidateResult& c : candidates) {
    if (c.probes.empty()) continue;
    const Problem::Matrix& B = c.probes.front().columns;
    const double apart = first.fitted.complete() && c.fitted.complete()
                             ? DistanceOf(first.fitted, c.fitted)
                             : (v - B * B.completeOrthogonalDecomposition().solve(v)).squaredNorm();
    c.lambda = apart / inflation_;
  }
}

double CandidateSearch::DistanceOf(const Fitted& a, const Fitted& b) const {
  std::vector<Problem::Matrix> difference(a.residuals.size());
  for (std::size_t l = 0; l < difference.size(); ++l)
    difference[l] = a.residuals[l] - b.residuals[l];
  return fitter_.ProjectedResidualOf(b).Project(difference).squaredNorm();
}

const CandidateResult* CandidateSearch::leading() const {
  return candidates.empty() || !candidates.front().was_fitted ? nullptr : &candidates.front();
}

CandidateResult* CandidateSearch::leading() {
  return std::as_const(*this).leading() ? &candidates.front() : nullptr;
}

double CandidateSearch::BestOverNoise() const {
  return (leading() ? leading()->fitted : *base_.fitted).over_noise();
}

LackOfFit CandidateSearch::TestsOf(const CandidateResult& c) const {
  const Problem problem = ProblemOf(c, *fitter_.experiment);
  return c.at_quarter_step ? LackAt(AtQuarter(problem), c, *c.at_quarter_step)
                           : LackAt(problem, c, c.fitted);
}
LackOfFit CandidateSearch::LackAt(const Problem& problem, const CandidateResult& c,
                                  const Fitted& fitted) const {
  return TestLackOfFit(fitter_, problem, c.hypothesis.Free(), fitted, sizes_, inflation_,
                       options_.seed);
}

LackOfFit CandidateSearch::LackOf(CandidateResult* c) const {
  LackOfFit lack = c ? TestsOf(*c)
                     : TestLackOfFit(fitter_, base_problem_, base_.given, *base_.fitted, sizes_,
                                     inflation_, options_.seed);
  lack.of_step = lack.significant(criteria_) &&
                 fitter_.ExplainedByStep(c ? c->fitted : *base_.fitted) &&
                 (!c || FallsWithStep(*c));
  return lack;
}

BaseSquares CandidateSearch::Base() const {
  return {base_.fitted->cost / inflation_, base_.fitted->sensitivities.value().freedom / inflation_,
          noise_.floor()};
}

// Of the train logs or of those left out, whichever shows more: what else is wrong may hide in one
// of them what the fit does in the other, and logs left out confirm a name later on.
double CandidateSearch::ErrorShare(const Fitted& fitted) const {
  const double floor = noise_.floor();
  const auto above = [&](double error) { return SquaresWithoutPart(error, floor); };
  const auto share = [&](double before, double after) {
    return above(before) > 0 ? 1 - above(after) / above(before) : 1;
  };
  const TwoErrors &before = base_.fitted->error, &after = fitted.error;
  const double train = share(before.train, after.train);
  return before.validate > 0 ? std::max(train, share(before.validate, after.validate)) : train;
}

// What noise and time step make says nothing of a model; 0: there are no such logs.
double CandidateSearch::HeldOutError(const Fitted& fitted) const {
  const double error = fitted.error.validate;
  return error > 0 ? std::max(error, noise_.floor()) : 0;
}

std::vector<LikelihoodRecord> CandidateSearch::Records() const {
  std::vector<LikelihoodRecord> records;
  for (const CandidateResult& c : candidates) {
    LikelihoodRecord record{c.hypothesis.Name(),
                            NumbersThatShow(c),
                            c.likelihood,
                            {},
                            StepReduction(c.fitted) / inflation_,
                            c.listed,
                            KinOf(c.hypothesis.Card()),
                            ErrorShare(c.fitted),
                            HeldOutError(c.fitted)};
    record.corrects = c.was_fitted && OnlyCorrects(c.hypothesis, c.fitted, c.first_extra(),
                                                   *fitter_.experiment, sizes_, criteria_);
    record.far_off = c.was_fitted && IsFarOff(c.hypothesis, c.fitted, c.first_extra(), criteria_);
    for (std::size_t a = 0; a < candidates.size(); ++a) {
      if (&candidates[a] != &c && Contains(fitter_, c, candidates[a])) record.contains.push_back(a);
    }
    records.push_back(std::move(record));
  }
  return records;
}

}  // namespace continuum
