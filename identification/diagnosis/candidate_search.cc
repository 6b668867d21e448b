#include "identification/diagnosis/candidate_search.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Dense>

#include "error.h"
#include "identification/diagnosis/quantisation.h"
#include "identification/statistics/uncertainty.h"

namespace continuum {
namespace {
constexpr int kDraws = 399;  // of rounding errors

// Nested fits are as far apart as the larger one gains; others that gain as much are farther. Where
// the noise is not known: they are as near as nothing to what either changes.
bool SaysTheSame(const CandidateFitter& trials, const CandidateResult& b,
                 const CandidateResult& a) {
  constexpr double kNoise = 10;      // of twice the log-likelihood
  constexpr double kNothing = 0.02;  // of the squares that one takes off
  if (!a.fits || !b.fits) return false;
  const double gain = b.likelihood - a.likelihood;
  const bool known = trials.whitening.active();
  if (known && std::abs(gain) > 3 * kNoise) return false;
  const auto train = TrainLogs(*trials.experiment);
  std::vector<Problem::Vector> between(train.size());
  for (std::size_t l = 0; l < train.size(); ++l)
    if (train[l]) between[l] = b.fitted.residuals[l] - a.fitted.residuals[l];
  const double apart = trials.whitening.Stack(between, train).squaredNorm();
  return apart < (known ? 2 * std::max(gain, 0.0) + kNoise : kNothing * a.likelihood);
}

}  // namespace

bool Contains(const CandidateFitter& trials, const CandidateResult& b, const CandidateResult& a) {
  if (b.hypothesis.extra.size() > a.hypothesis.extra.size() && SaysTheSame(trials, b, a))
    return true;
  if (a.probes.empty() || b.probes.empty()) return false;
  const Problem::Matrix &A = a.probes.front().AtStart(), &B = b.probes.front().AtStart();
  if (A.cols() >= B.cols()) return false;
  const Problem::Matrix rest = A - B * B.completeOrthogonalDecomposition().solve(A);
  return rest.squaredNorm() < 0.01 * A.squaredNorm();
}

CandidateSearch::CandidateSearch(const CandidateFitter& trials, const Base& base,
                                 const Noise& noise, const Sizes& sizes,
                                 const DiagnosisOptions& options, SearchScope places)
    : trials_(trials),
      base_(base),
      base_problem_(*trials.experiment, *base.system, base.given),
      noise_(noise),
      sizes_(sizes),
      options_(options) {
  Experiment wanted = *trials.experiment;
  if (!options.candidates.empty()) {
    wanted.all_candidates = false;
    wanted.candidates.clear();
    for (const auto& name : options.candidates) {
      const Candidate* const written = trials.experiment->Written(name);
      wanted.candidates.push_back(written ? *written : Candidate{name, "", false});
    }
  }
  const SearchBase here{base.system, base.given, base_problem_.CommonChanges(base.fitted->fit.x)};
  for (Hypothesis& h : MakeCandidates(wanted, here, sizes, skipped, places)) {
    candidates.push_back({std::move(h)});
    candidates.back().record.name = candidates.back().hypothesis.Name();
  }
}

void CandidateSearch::Screen() {
  const Remainder left = trials_.LeftBy(*base_.fitted);
  left_ = left.cost();
  base_problem_.Residuals(base_.fitted->fit.x, TrainLogs(*trials_.experiment));
  std::vector<std::vector<Probe>> probes;
  for (CandidateResult& c : candidates) {
    options_.Say("screen " + c.hypothesis.Name());
    probes.emplace_back();
    try {
      Problem problem = c.ProblemOf(*trials_.experiment);
      if (c.hypothesis.OnlyMeasured()) problem.Recall(base_problem_);
      probes.back() = trials_.Probes(c.hypothesis, problem, *base_.fitted, left);
    } catch (const Error& error) {
      c.error = error.what();
    }
  }
  options_.Say("significance");
  const Significance found =
      noise_.known() ? Significant(left, probes) : BestOfProbes(probes, left.residual());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    CandidateResult& c = candidates[i];
    c.explained = found.explained[i];
    c.p = found.p[i];
    c.probes = std::move(probes[i]);
    smallest_p_ = std::min(smallest_p_, c.p);
    if (c.probes.empty()) continue;
    const std::size_t best = found.best[i];
    const Probe& probe = c.probes[best];
    c.start =
        trials_.StartFrom(c.hypothesis, *base_.fitted, probe, ExplainedBy(probe, left.residual()));
    c.rivals = StartsAsGood(c, best, left);
    std::swap(c.probes[0], c.probes[best]);
  }
}

Significance CandidateSearch::Significant(const Remainder& left,
                                          const std::vector<std::vector<Probe>>& probes) {
  const Quantisation rounding(base_problem_, noise_, base_.fitted->fit.x);
  Problem::Matrix draws;
  if (rounding.any()) {
    inflation_ = rounding.Inflation(left, probes, options_.seed);
    draws = rounding.Draws(left, kDraws, options_.seed);
  }
  return SignificanceOf(probes, left.residual(), options_.seed, draws);
}

// First order says little of what acts on top of another amplitude, as a Stribeck excess, nor of
// what belongs to it, as its speed: starts that explain as much as the best, with little and much
// of it.
std::vector<Problem::Vector> CandidateSearch::StartsAsGood(const CandidateResult& c,
                                                           std::size_t best,
                                                           const Remainder& left) const {
  constexpr double kAsGood = 0.99;
  std::set<std::size_t> seen;
  std::vector<Problem::Vector> starts;
  for (const Probe& probe : c.probes) {
    const auto& on_top = probe.on_top;
    if (std::find(on_top.begin(), on_top.end(), true) == on_top.end()) continue;
    const Explained e = ExplainedBy(probe, left.residual());
    if (e.amount < kAsGood * c.explained || !seen.insert(probe.start).second) continue;
    for (const double excess : {1.0, 10.0}) {
      if (&probe == &c.probes[best] && excess == 1) continue;  // where the fit begins anyway
      starts.push_back(trials_.StartFrom(c.hypothesis, *base_.fitted, probe, e, excess));
    }
  }
  return starts;
}

double CandidateSearch::smallest_p() const { return smallest_p_; }

bool CandidateSearch::SomethingIsLeft() const {
  const Fitted& f = *base_.fitted;
  return smallest_p_ < LikelihoodRules{}.level ||
         f.cost > kModelLimited * kModelLimited * f.freedom;
}

double CandidateSearch::MostExplained() const {
  double best = 0;
  for (const CandidateResult& c : candidates) best = std::max(best, c.explained);
  return best;
}

double CandidateSearch::Promise() const {
  const double left = base_.fitted->cost - base_.fitted->freedom;
  return left > 0 ? MostExplained() / left : 0;
}

void CandidateSearch::Join(CandidateSearch other) {
  for (CandidateResult& c : other.candidates) {
    c.likelihood = Likelihood(c.fitted);  // in this round's unit of noise
    candidates.push_back(std::move(c));
  }
  for (CandidateResult& c : other.left_behind) left_behind.push_back(std::move(c));
  for (std::string& s : other.skipped) skipped.push_back(std::move(s));
  Rank();
}

void CandidateSearch::JoinUnlisted(CandidateSearch other) {
  for (CandidateResult& c : other.candidates) {
    c.listed = false;
    c.likelihood = Likelihood(c.fitted);
    candidates.push_back(std::move(c));
  }
}

// Twice the logarithm of what a fit gains over the base.
double CandidateSearch::Likelihood(const Fitted& fitted) const {
  return (base_.fitted->cost - fitted.cost) / inflation_;
}

void CandidateSearch::Dismiss() {
  std::vector<CandidateResult> kept;
  for (CandidateResult& c : candidates) {
    if (c.fits) {
      kept.push_back(std::move(c));
    } else if (!c.error.empty()) {
      skipped.push_back(c.hypothesis.Name() + ": " + c.error);
    } else {
      left_behind.push_back(std::move(c));
    }
  }
  candidates = std::move(kept);
  Rank();
}

void CandidateSearch::Rank() {
  smallest_p_ = 1;
  for (const auto* all : {&candidates, &left_behind}) {
    for (const CandidateResult& c : *all) smallest_p_ = std::min(smallest_p_, c.p);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.likelihood > b.likelihood; });
  TellApart();
}

// |v − P v|², v what the leading candidate's directions explain, P onto the other's directions.
void CandidateSearch::TellApart() {
  if (!noise_.known() || candidates.empty() || candidates.front().probes.empty()) return;
  const Remainder left = trials_.LeftBy(*base_.fitted);
  const Probe& lead = candidates.front().probes.front();
  const Problem::Vector v = lead.columns * ExplainedBy(lead, left.residual()).coefficients;
  for (CandidateResult& c : candidates) {
    if (c.probes.empty()) continue;
    const Problem::Matrix& B = c.probes.front().columns;
    c.apart = (v - B * B.completeOrthogonalDecomposition().solve(v)).squaredNorm() / inflation_;
  }
}

const CandidateResult* CandidateSearch::leading() const {
  return candidates.empty() || !candidates.front().fits ? nullptr : &candidates.front();
}

double CandidateSearch::BestLeaves() const {
  const Fitted& best = leading() ? leading()->fitted : *base_.fitted;
  return std::sqrt(best.cost / best.freedom);
}

LackOfFit CandidateSearch::LackOf(const CandidateResult& c) const {
  const Problem problem = c.ProblemOf(*trials_.experiment);
  return c.finer ? LackAt(AtQuarter(problem), c, *c.finer) : LackAt(problem, c, c.fitted);
}
LackOfFit CandidateSearch::LackAt(const Problem& problem, const CandidateResult& c,
                                  const Fitted& fitted) const {
  return trials_.LackIn(problem, c.hypothesis.Free(), fitted, sizes_, inflation_, options_.seed);
}
LackOfFit CandidateSearch::LackOfBase() const {
  return trials_.LackIn(base_problem_, base_.given, *base_.fitted, sizes_, inflation_,
                        options_.seed);
}

// What a coarse step adds hides what else is wrong. Where joints stick and slip it falls slowly,
// and a fit may end in another valley.
bool CandidateSearch::GoesWithTheStep(const CandidateResult& c) const {
  options_.Say("at a fine step " + c.hypothesis.Name());
  const Problem fine = AtQuarter(c.ProblemOf(*trials_.experiment));
  try {
    if (FallsTo(fine, c, c.finer ? *c.finer : trials_.GoOn(fine, c.fitted))) return true;
    Fitted anew = c.fitted;
    anew.fit.x = BestOf(fine, FromTheOutset(fine, c));
    return FallsTo(fine, c, trials_.GoOn(fine, anew));
  } catch (const Error&) {
    return true;  // it diverges there
  }
}

bool CandidateSearch::FallsTo(const Problem& fine, const CandidateResult& c,
                              const Fitted& finer) const {
  constexpr double kFalls = 0.75;  // to first order it falls to a sixteenth
  const auto excess = [](const Remainder& left) { return left.cost() - left.freedom(); };
  const double before = excess(trials_.LeftBy(c.fitted)), after = excess(trials_.LeftBy(finer));
  return after < kFalls * before || LackAt(fine, c, finer).smallest() >= LikelihoodRules{}.lack;
}

std::vector<LikelihoodRecord> CandidateSearch::Records() const {
  std::vector<LikelihoodRecord> records;
  for (const CandidateResult& c : candidates) {
    LikelihoodRecord record{c.hypothesis.Name(),
                            c.hypothesis.extra.size(),
                            c.likelihood,
                            {},
                            TakenOff(c.fitted) / inflation_,
                            c.listed};
    for (std::size_t a = 0; a < candidates.size(); ++a) {
      if (&candidates[a] != &c && Contains(trials_, c, candidates[a])) record.contains.push_back(a);
    }
    records.push_back(std::move(record));
  }
  return records;
}

}  // namespace continuum
