#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/diagnosis/candidate_search.h"
#include "identification/diagnosis/family_starts.h"
#include "identification/diagnosis/search_bytes.h"
#include "identification/statistics/uncertainty.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/shared_loop.h"

// The fits of a search: who gets one, and which are worth their sensitivities.
namespace continuum {
namespace {

constexpr std::size_t kWave = 4;  // candidates that are fitted beside each other
constexpr double kBetter = 0.98;  // of the best cost so far

}  // namespace

double CandidateSearch::Threshold() const {
  return FitThreshold(MostExplained(), base_squares_, noise_.known(), criteria_);
}

bool CandidateSearch::ReachesNoise(const Fitted& fitted) const {
  return continuum::ReachesNoise(fitted.error.train, {noise_.rms, noise_.step}, criteria_);
}

// By first order, by the missing force, or by the error itself: dropped only when all say no.
bool CandidateSearch::IsWorthAFit(const CandidateResult& c, double needed) const {
  return c.explained >= needed ||
         (needed < kInfinity && (c.force_promise > 0 || c.error_promise > 0));
}

// Those behind it are less likely, and not fitted where they explain less than is needed.
void CandidateSearch::SayFit(const CandidateResult& c, double needed) const {
  const auto done = static_cast<std::size_t>(&c - candidates.data());
  const auto wanted = std::count_if(candidates.begin(), candidates.end(),
                                    [&](const auto& other) { return IsWorthAFit(other, needed); });
  options_.Say(DiagnosisStage::kFits, c.hypothesis.Name(), done, static_cast<std::size_t>(wanted));
}

// The most promising first, so that the others know what to reach; nobody where only noise is left.
void CandidateSearch::Fit(const CandidateSearch* beside, std::size_t limit) {
  const std::size_t different = Order();
  const bool signal = HasSignal(smallest_p_, base_.fitted->cost,
                                base_.fitted->sensitivities.value().freedom, criteria_);
  const CandidateResult* const known = beside ? beside->leading() : nullptr;
  Race race{!noise_.known() || signal ? Threshold() : kInfinity, limit};
  if (beside)
    race.needed = std::max(race.needed, UnlistedThreshold(beside->MostExplained(), criteria_));
  if (known) race.rival = race.best = known->fitted.fit.cost;
  race.reached = known && IsEnough(known->fitted);
  FitInOrder(0, different, race);
  OrderAlike(different);
  FitInOrder(different, candidates.size(), race);
  FinishAbandoned();
  CompleteCompetitive(known ? &known->fitted : nullptr);
  Dismiss();
}

// Those from one on to another.
void CandidateSearch::FitInOrder(std::size_t next, std::size_t end, Race& race) {
  std::size_t since_better = 0;
  while (race.limit > 0) {
    if (std::isfinite(fitter_.until) && GoOnInVain(since_better, criteria_)) {
      LeaveOthers(race.needed, next, end);
      break;
    }
    const auto wave = NextWave(race.needed, std::min(race.limit, kWave), next, end);
    if (wave.empty()) break;
    race.limit -= wave.size();
    SayFit(*wave.front(), race.needed);
    FitBeside(wave, race);
    FitPlainer();
    for (const CandidateResult* const c : wave)
      since_better = Count(*c, race) ? 0 : since_better + 1;
    const auto richer = RicherThanBest();
    FitBeside(richer, race);
    for (const CandidateResult* const c : richer)
      if (Count(*c, race)) since_better = 0;
  }
}

void CandidateSearch::FitBeside(const std::vector<CandidateResult*>& some, const Race& race) {
  const double alike =
      0.5 * (StepReduction(*base_.fitted) + criteria_.structure_least * base_.fitted->cost);
  const auto fit = [&](std::size_t, std::size_t i) {
    try {
      FitOne(*some[i], race.rival + alike, race.reached ? 1 : kStartsTried);
    } catch (const Error& error) {
      some[i]->error = error.what();
    }
  };
  ShareOut(some.size(), fit, [&](auto& a, std::size_t i) { FieldsOfFit(a, *some[i]); });
  StopIfRequested();
}

// Laws at its place that contain what it contains, where the best takes the main share and leaves
// more than noise: what is left is theirs before it is another cause's.
std::vector<CandidateResult*> CandidateSearch::RicherThanBest() {
  const CandidateResult* const best = Best();
  if (!best || fitter_.TimeIsOver() || !noise_.known() || ReachesNoise(best->fitted) ||
      !TakesMainShare(best->fitted))
    return {};
  std::vector<const CandidateResult*> plain{best};
  for (const CandidateResult& c : candidates)
    if (IsPlainerThan(c.hypothesis, best->hypothesis)) plain.push_back(&c);
  std::vector<CandidateResult*> richer;
  for (CandidateResult& c : candidates) {
    const bool contains = std::any_of(plain.begin(), plain.end(), [&](const CandidateResult* p) {
      return IsPlainerThan(p->hypothesis, c.hypothesis);
    });
    if (contains && !c.was_fitted && c.error.empty()) richer.push_back(&c);
  }
  return richer;
}

const CandidateResult* CandidateSearch::Best() const {
  const auto by_cost = [](const CandidateResult& a, const CandidateResult& b) {
    return b.was_fitted && (!a.was_fitted || b.fitted.fit.cost < a.fitted.fit.cost);
  };
  const auto best = std::max_element(candidates.begin(), candidates.end(), by_cost);
  return best == candidates.end() || !best->was_fitted ? nullptr : &*best;
}

// Whether a fit is better than those before it.
bool CandidateSearch::Count(const CandidateResult& c, Race& race) const {
  if (!c.was_fitted) return false;
  const bool better = c.fitted.fit.cost < kBetter * race.best;
  if (better) race.best = c.fitted.fit.cost;
  if (!noise_.known()) return better;
  race.rival = std::min(race.rival, c.fitted.fit.cost);
  if (!IsEnough(c.fitted)) return better;
  race.reached = true;
  race.needed = std::max(race.needed, FitThresholdAtNoise(MostExplained(), criteria_));
  return better;
}

// From the next one on.
void CandidateSearch::LeaveOthers(double needed, std::size_t next, std::size_t end) {
  for (; next < end; ++next)
    if (IsWorthAFit(candidates[next], needed))
      candidates[next].why_not = Dismissed::Why::kOthersInVain;
}

// Those that are fitted beside each other, from the next one on: as many whatever the machine, as
// what one reaches decides about those behind it. Those that promise far less than the first wait
// for what that reaches, and a richer law for the plain one of its family, to begin where that has
// ended.
std::vector<CandidateResult*> CandidateSearch::NextWave(double needed, std::size_t most,
                                                        std::size_t& next, std::size_t end) {
  constexpr double kAlike = 0.5;
  const double most_explained = MostExplained();
  std::vector<CandidateResult*> wave;
  for (; next < end && wave.size() < most; ++next) {
    CandidateResult& c = candidates[next];
    if (!c.error.empty() || !IsWorthAFit(c, needed)) continue;
    if (!wave.empty() && Promise(c, most_explained) < kAlike * Promise(*wave[0], most_explained))
      break;
    const bool waits = std::any_of(wave.begin(), wave.end(), [&](const CandidateResult* plain) {
      return IsPlainerThan(plain->hypothesis, c.hypothesis);
    });
    if (waits) break;
    if (fitter_.HasTimeFor("a fit of " + c.hypothesis.NameAtPlace(), left_out)) {
      wave.push_back(&c);
    } else {
      c.why_not = Dismissed::Why::kNoTimeForAFit;
    }
  }
  return wave;
}

// A law that leads is no better than a plain one that it contains and that the screen has missed,
// until that one was fitted as well: next to its end, whatever time is left.
void CandidateSearch::FitPlainer() {
  const CandidateResult* const lead = Best();
  if (!lead) return;
  for (CandidateResult& c : candidates) {
    if (c.was_fitted || !c.error.empty() || !IsPlainerThan(c.hypothesis, lead->hypothesis))
      continue;
    const auto start = StartFromRich(*lead, c.hypothesis);
    if (!start) continue;
    c.other_starts.push_back(*start);
    try {
      FitOne(c, kInfinity);
    } catch (const Error& error) {
      c.error = error.what();
    }
  }
}

bool CandidateSearch::TakesMainShare(const Fitted& fitted) const {
  const BaseSquares base = Base();
  return ShareOf({"", 0, Likelihood(fitted)}, base) >= criteria_.main_share;
}

bool CandidateSearch::IsEnough(const Fitted& fitted) const {
  return ReachesNoise(fitted) || TakesMainShare(fitted);
}

// Where no fit comes near the noise and what the time step adds, those that were given up as too
// far behind go on to their end, the likeliest first: what a fit gains early says little where a
// swing is out of phase with the measured one. Until one of this search comes near.
void CandidateSearch::FinishAbandoned() {
  if (!noise_.known()) return;
  for (const CandidateResult& c : candidates) {
    if (c.was_fitted && IsEnough(c.fitted)) return;
  }
  std::size_t tried = 0;
  for (CandidateResult& c : candidates) {
    if (!WorthFinishing(tried, c.explained, MostExplained(), criteria_) || fitter_.TimeIsOver())
      return;
    if (!c.was_fitted || c.fitted.fit.converged) continue;
    options_.Say(DiagnosisStage::kFits, "to the end, " + c.hypothesis.Name());
    ++tried;
    try {
      FitOne(c, kInfinity);
      if (ReachesNoise(c.fitted)) return;
    } catch (const Error&) {
      continue;  // the fit that was given up stands
    }
  }
}

// Those that fit best, and those that explain most of the missing force: a fit that ended out of
// step says nothing.
std::vector<CandidateResult*> CandidateSearch::MostPromising() {
  const auto most = static_cast<std::size_t>(criteria_.fresh_starts);
  std::vector<CandidateResult*> all, best;
  for (CandidateResult& c : candidates) {
    if (c.was_fitted && c.listed) all.push_back(&c);
  }
  const auto add = [&](const auto& before) {
    std::stable_sort(all.begin(), all.end(), before);
    for (std::size_t i = 0; i < std::min(all.size(), most); ++i) {
      if (std::find(best.begin(), best.end(), all[i]) == best.end()) best.push_back(all[i]);
    }
  };
  add([](const auto* a, const auto* b) { return a->fitted.fit.cost < b->fitted.fit.cost; });
  std::erase_if(all, [](const auto* c) { return !(c->force_promise > 0); });
  add([](const auto* a, const auto* b) { return a->force_promise > b->force_promise; });
  return best;
}

bool CandidateSearch::HasLostFits() const {
  const CandidateResult* const best = leading();
  return best && std::any_of(candidates.begin(), candidates.end(), [&](const CandidateResult& c) {
           if (!c.was_fitted || !c.listed || !(c.force_promise > 0)) return false;
           const double cost = c.fitted.fit.cost;
           return cost > base_.fitted->fit.cost ||
                  (c.force_promise > best->force_promise &&
                   cost > HopelessCost(best->fitted.fit.cost, criteria_));
         });
}

// Where joints stick and slip a fit from what the base has become ends in a neighbouring local
// minimum.
bool CandidateSearch::RefitFromExperimentStart() {
  bool better = false;
  for (CandidateResult* const c : MostPromising()) {
    if (fitter_.TimeIsOver()) break;
    options_.Say(DiagnosisStage::kFits, "anew, " + c->hypothesis.Name());
    better = RefitFromStart(*c) || better;
  }
  if (!better) return false;
  CompleteCompetitive(nullptr);
  Dismiss();
  return true;
}

// By what the time step leaves open: a fit that imitates it has less to spare than the others.
// Nothing where the step of zero fits worse.
double CandidateSearch::StepReduction(const Fitted& f) {
  return std::max(0.0, 2 * f.fit.cost - f.cost);
}

// Sensitivities are expensive: only those get theirs that may come near the best with them. What
// the time step leaves open takes about as much off everybody's cost. known: the best fit of
// another search, or null.
void CandidateSearch::CompleteCompetitive(const Fitted* known) {
  std::vector<CandidateResult*> order;
  for (CandidateResult& c : candidates) {
    if (c.was_fitted) order.push_back(&c);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->fitted.cost < b->fitted.cost; });
  double best = known ? known->cost : kInfinity, step_reduction = StepReduction(*base_.fitted);
  if (known) step_reduction = std::max(step_reduction, StepReduction(*known));
  for (CandidateResult* const c : order) {
    if (noise_.known() && !c->fitted.complete() &&
        WorthCompleting(c->fitted.cost, best, step_reduction, criteria_)) {
      if (!CompleteOne(*c, best)) continue;
      best = std::min(best, c->fitted.cost);
      step_reduction = std::max(step_reduction, StepReduction(c->fitted));
    }
    c->likelihood = Likelihood(c->fitted);
  }
}

// Whether it can be judged.
bool CandidateSearch::CompleteOne(CandidateResult& c, double best) const {
  options_.Say(DiagnosisStage::kFits, "sensitivities of " + c.hypothesis.Name());
  const Problem problem = ProblemOf(c, *fitter_.experiment);
  fitter_.Complete(problem, c.fitted);
  Problem::Vector x = c.fitted.fit.x;
  if (RaiseDelays(c, problem.step(), x)) RefitAtQuarterStep(c);
  c.error = c.at_quarter_step ? FlawOf(AtQuarter(problem), *c.at_quarter_step)
                              : FlawOf(problem, c.fitted);
  if (!c.error.empty() && !c.at_quarter_step) Mend(problem, c);
  c.was_fitted = c.error.empty();
  if (!c.was_fitted) return false;
  const double behind = c.fitted.cost - best, promise = base_.fitted->cost - best;
  const bool close = behind < std::min(StepReduction(c.fitted), promise);
  if (close && !c.at_quarter_step && !fitter_.TimeIsOver()) RefitAtQuarterStep(c);
  return true;
}

}  // namespace continuum
