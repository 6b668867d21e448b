#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/candidates/search_range.h"
#include "identification/diagnosis/candidate_search.h"
#include "identification/diagnosis/family_starts.h"
#include "identification/diagnosis/look_logs.h"
#include "identification/diagnosis/probing.h"
#include "identification/statistics/uncertainty.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/parallel.h"

// The fits of a search: who gets one, from where, and how far.
namespace continuum {
namespace {
constexpr std::size_t kWave = 4;  // candidates that are fitted beside each other
constexpr double kBetter = 0.98;  // of the best cost so far

// Without those that are next to one before them: two views of the missing force often say the
// same.
std::vector<Problem::Vector> WithoutRepeats(const Problem& problem,
                                            const std::vector<Problem::Vector>& starts) {
  constexpr double kSame = 0.01;
  std::vector<Problem::Vector> kept;
  for (const Problem::Vector& start : starts) {
    const Problem::Vector x = problem.Clamp(start);
    const bool repeats = std::any_of(kept.begin(), kept.end(), [&](const Problem::Vector& other) {
      const auto size = x.cwiseAbs().cwiseMax(other.cwiseAbs());
      return ((x - other).cwiseAbs().array() <= kSame * size.array()).all();
    });
    if (!repeats) kept.push_back(x);
  }
  return kept;
}

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

// By whichever view promises more, as a share of what the best one promises there.
double CandidateSearch::Promise(const CandidateResult& c, double most) {
  return std::max({most > 0 ? c.explained / most : 0, c.force_promise, c.error_promise});
}

// The plainest law of a family goes first at a place, as if it promised what the best of them does:
// what it leaves decides whether a richer one is needed.
void CandidateSearch::Order() {
  constexpr double kRicher = 0.8;
  const double most = MostExplained();
  const auto group = [](const CandidateResult& c) {
    return std::pair(KinOf(c.hypothesis.Card()).family, c.hypothesis.where);
  };
  std::map<std::pair<std::string, std::string>, double> best;
  for (const CandidateResult& c : candidates) {
    double& promise = best[group(c)];
    promise = std::max(promise, Promise(c, most));
  }
  const auto key = [&](const CandidateResult& c) {
    const Kin kin = KinOf(c.hypothesis.Card());
    if (kin.family.empty()) return Promise(c, most);
    return kin.depth == 0 ? best.at(group(c)) : kRicher * Promise(c, most);
  };
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](const auto& a, const auto& b) { return key(a) > key(b); });
}

// The most promising first, so that the others know what to reach; nobody where only noise is left.
void CandidateSearch::Fit(const CandidateSearch* beside, std::size_t limit) {
  Order();
  const bool signal = HasSignal(smallest_p_, base_.fitted->cost,
                                base_.fitted->sensitivities.value().freedom, criteria_);
  double needed = !noise_.known() || signal ? Threshold() : kInfinity;
  const CandidateResult* const known = beside ? beside->leading() : nullptr;
  if (beside) needed = std::max(needed, UnlistedThreshold(beside->MostExplained(), criteria_));
  double rival = known ? known->fitted.fit.cost : kInfinity;
  double best = rival;
  bool reached = known && IsEnough(known->fitted);
  const double alike =
      0.5 * (StepReduction(*base_.fitted) + criteria_.structure_least * base_.fitted->cost);
  std::size_t next = 0, since_better = 0;
  while (limit > 0) {
    if (std::isfinite(fitter_.until) && GoOnInVain(since_better, criteria_)) {
      LeaveOthers(needed, next);
      break;
    }
    const auto wave = NextWave(needed, std::min(limit, kWave), next);
    if (wave.empty()) break;
    limit -= wave.size();
    SayFit(*wave.front(), needed);
    ParallelFor(wave.size(), [&](std::size_t, std::size_t i) {
      try {
        FitOne(*wave[i], rival + alike, reached ? 1 : kStartsTried);
      } catch (const Error& error) {
        wave[i]->error = error.what();
      }
    });
    StopIfRequested();
    FitPlainer();
    for (const CandidateResult* const c : wave) {
      ++since_better;
      if (!c->was_fitted) continue;
      if (c->fitted.fit.cost < kBetter * best) best = c->fitted.fit.cost, since_better = 0;
      if (!noise_.known()) continue;
      rival = std::min(rival, c->fitted.fit.cost);
      if (!IsEnough(c->fitted)) continue;
      reached = true;
      needed = std::max(needed, FitThresholdAtNoise(MostExplained(), criteria_));
    }
  }
  FinishAbandoned();
  CompleteCompetitive(known ? known->fitted.cost : kInfinity);
  Dismiss();
}

// From the next one on.
void CandidateSearch::LeaveOthers(double needed, std::size_t next) {
  for (; next < candidates.size(); ++next)
    if (IsWorthAFit(candidates[next], needed))
      candidates[next].why_not = Dismissed::Why::kOthersInVain;
}

// Those that are fitted beside each other, from the next one on: as many whatever the machine, as
// what one reaches decides about those behind it. Those that promise far less than the first wait
// for what that reaches, and a richer law for the plain one of its family, to begin where that has
// ended.
std::vector<CandidateResult*> CandidateSearch::NextWave(double needed, std::size_t most,
                                                        std::size_t& next) {
  constexpr double kAlike = 0.5;
  const double most_explained = MostExplained();
  std::vector<CandidateResult*> wave;
  for (; next < candidates.size() && wave.size() < most; ++next) {
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
  const auto by_cost = [](const CandidateResult& a, const CandidateResult& b) {
    return b.was_fitted && (!a.was_fitted || b.fitted.fit.cost < a.fitted.fit.cost);
  };
  const auto lead = std::max_element(candidates.begin(), candidates.end(), by_cost);
  if (lead == candidates.end() || !lead->was_fitted) return;
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
  CompleteCompetitive(kInfinity);
  Dismiss();
  return true;
}

// What the experiment begins with, and all or part of what the candidate's fit has found.
std::vector<Problem::Vector> CandidateSearch::ExperimentStarts(const Problem& problem,
                                                               const CandidateResult& c) {
  const Hypothesis& h = c.hypothesis;
  const auto own = static_cast<Eigen::Index>(h.extra.size());
  std::vector<Problem::Vector> starts;
  for (const double share : {1.0, 0.75, 0.5}) {
    Problem::Vector x = problem.Start();
    x.tail(own) = c.fitted.fit.x.tail(own);
    for (const std::size_t a : h.Amplitudes()) {
      double& value = x[c.first_extra() + static_cast<Eigen::Index>(a)];
      value = h.AtShare(a, value, share);
    }
    starts.push_back(problem.Clamp(x));
  }
  return starts;
}

// From what the experiment begins with, then from where short horizons lead: what is nearest at
// first may end farther off.
bool CandidateSearch::RefitFromStart(CandidateResult& c) const {
  const Problem problem = ProblemOf(c, *fitter_.experiment);
  const bool better = RefitFrom(problem, c, ExperimentStarts(problem, c));
  return RefitFrom(problem, c, fitter_.OverShortHorizons(problem, c.fitted.fit.x)) || better;
}

bool CandidateSearch::RefitFrom(const Problem& problem, CandidateResult& c,
                                const std::vector<Problem::Vector>& starts) const {
  if (starts.empty()) return false;
  try {
    Fitted fitted = fitter_.Fit(problem, BestOf(problem, starts), c.fitted.fit.cost);
    if (!(fitted.fit.cost < c.fitted.fit.cost - criteria_.still_gains)) return false;
    c.fitted = std::move(fitted);
    c.at_quarter_step.reset(), c.at_quarter_x.reset(), c.falls_with_step.reset();
    return true;
  } catch (const Error&) {
    return false;  // the fit that is there stands
  }
}

// From the start that is best after a few iterations, of the screen or of the hypothesis. tried: so
// many of them; what is hardly a rival any more needs no second one.
void CandidateSearch::FitOne(CandidateResult& c, double rival, std::size_t tried) const {
  const Problem problem = ProblemOf(c, *fitter_.experiment);
  std::vector<Problem::Vector> starts = c.other_starts;
  if (c.start.size() > 0) starts.insert(starts.begin(), c.start);
  const bool crooked = !noise_.known() && c.hypothesis.extra.size() > 1;  // first order may mislead
  if (crooked || starts.empty()) {
    for (const auto& own : c.hypothesis.starts) starts.push_back(Append(base_.fitted->fit.x, own));
  }
  for (const CandidateResult& plain : candidates) {
    if (!plain.was_fitted || !IsPlainerThan(plain.hypothesis, c.hypothesis)) continue;
    const auto more = StartsFromPlain(plain, c.hypothesis);
    starts.insert(starts.end(), more.begin(), more.end());
  }
  if (c.start.size() > 0) {
    if (const auto room = MakeRoom(problem, c.start)) starts.push_back(*room);
  }
  c.fitted = fitter_.Fit(problem, BestOf(problem, starts, tried), rival);
  c.was_fitted = true;
  Continue(problem, c, rival);
  WidenRanges(c, rival);
}

// The parameters of the base make room for the candidate at x, by a step along their slopes at its
// fit: what the screen promises, it promises with that. Nothing where that cannot be simulated.
std::optional<Problem::Vector> CandidateSearch::MakeRoom(const Problem& whole,
                                                         const Problem::Vector& x) const {
  const Eigen::Index given = base_.fitted->fit.x.size();
  if (given == 0) return {};
  Problem problem = whole;
  const auto& before = StepAsBase(problem) ? coarse_->residuals : base_.fitted->residuals;
  const auto train = TrainLogs(*fitter_.experiment);
  std::vector<Problem::Vector> r = problem.Residuals(x, train);
  for (std::size_t l = 0; l < r.size(); ++l) {
    if (train[l]) r[l] += base_.fitted->residuals[l] - before[l];
  }
  const Problem::Vector wanted = fitter_.whitening.Stack(r, train);
  if (!wanted.allFinite()) return {};
  const Sensitivities& s = base_.fitted->sensitivities.value();
  Problem::Matrix J = fitter_.whitening.Stack(s.jacobian, train);
  Problem::Vector size = J.colwise().norm();
  for (Eigen::Index i = 0; i < given; ++i) {
    const bool moves = size[i] > 0 && !s.uncertainty.at_bound[static_cast<std::size_t>(i)];
    if (!moves) J.col(i).setZero(), size[i] = 1;
    J.col(i) /= size[i];
  }
  const Problem::Vector step = J.completeOrthogonalDecomposition().solve(wanted);
  Problem::Vector next = x;
  next.head(given) -= step.cwiseQuotient(size);
  return problem.Clamp(next);
}

// In coarse steps where the base is simulated in them as well. Whether it is.
bool CandidateSearch::StepAsBase(Problem& problem) const {
  const bool coarse = coarse_ && problem.step() == base_problem_.step() && !NeedsOwnStep(problem);
  if (coarse) problem.StepBy(coarse_->step);
  return coarse;
}

// In what size an effect is looked for is a guess: a fit that ends there goes on beyond.
void CandidateSearch::WidenRanges(CandidateResult& c, double rival) const {
  constexpr int kTimes = 3;
  Hypothesis& h = c.hypothesis;
  const std::vector<Param>& law = EffectNamed(h.Card()).params;
  for (int i = 0; i < kTimes; ++i) {
    if (!Widen(h.extra, h.null, law, {c.fitted.fit.x.data() + c.first_extra(), h.extra.size()}))
      return;
    const Problem problem = ProblemOf(c, *fitter_.experiment);
    c.fitted = fitter_.Fit(problem, {c.fitted.fit.x}, rival);
    Continue(problem, c, rival);
  }
}

// A fit that is out of iterations while every one of them still gains goes on, as along a valley of
// the cost in which a stiffness of the model makes room for one of the candidate.
void CandidateSearch::Continue(const Problem& problem, CandidateResult& c, double rival) const {
  constexpr int kTimes = 3;
  for (int i = 0; i < kTimes; ++i) {
    const continuum::Fit& f = c.fitted.fit;
    if (f.iterations < fitter_.iterations ||
        !StillGains(f.LastGain(), f.cost, noise_.known(), criteria_))
      return;
    Fitted next = fitter_.Fit(problem, {f.x}, rival);
    if (!(next.fit.cost < f.cost)) return;
    c.fitted = std::move(next);
  }
}

CandidateResult CandidateSearch::FitAlone(CandidateResult c) const {
  FitOne(c, kInfinity);
  const Problem problem = ProblemOf(c, *fitter_.experiment);
  fitter_.Complete(problem, c.fitted);
  if (const std::string flaw = FlawOf(problem, c.fitted); !flaw.empty()) throw Error::Job(flaw);
  c.likelihood = Likelihood(c.fitted);
  return c;
}

// The start that is best after a few iterations, of those that are best as they are, in the logs
// for a look and in coarse steps.
FitStart CandidateSearch::BestOf(const Problem& whole, const std::vector<Problem::Vector>& all,
                                 std::size_t tried) const {
  constexpr double kNear = 2;  // times the best cost
  const std::vector<Problem::Vector> starts = WithoutRepeats(whole, all);
  const auto logs = LogsForALook(*fitter_.experiment, base_problem_.step());
  const auto train = TrainLogs(*fitter_.experiment);
  if (starts.size() == 1) return {starts.front(), SlopesNear(whole, starts.front(), train)};
  Problem problem = whole;
  const bool coarse = StepAsBase(problem);
  FitOptions options{4, 1e-3};
  options.idle = true, options.rough = true, options.until = fitter_.until;
  if (fitter_.whitening.active()) options.whitening = &fitter_.whitening;
  std::vector<std::pair<double, const Problem::Vector*>> order;
  for (const auto& start : starts)
    order.emplace_back(CostAt(problem, start, logs, options), &start);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (order.size() > tried) order.resize(tried);
  double best_cost = kInfinity;
  FitStart best;
  for (const auto& [cost, start] : order) {
    if (!(cost < kInfinity) || cost > kNear * order.front().first) continue;
    try {
      Problem::Matrix slopes = SlopesNear(problem, *start, logs);
      options.slopes = &slopes;
      continuum::Fit fit = FitParameters(problem, *start, logs, options);
      if (fit.cost < best_cost) best_cost = fit.cost, best = {std::move(fit.x), std::move(slopes)};
    } catch (const Error&) {
      continue;
    }
  }
  if (best.x.size() == 0 && !coarse) throw Error::Job("the simulation diverges from every start");
  if (best.x.size() == 0) return {starts.front()};
  if (logs != train) best.slopes.resize(0, 0);
  return best;
}

// As FitOptions::slopes has them: of the base at its own fit, which the search mends on its way,
// and of the candidate at x. Nothing where these cannot be simulated.
Problem::Matrix CandidateSearch::SlopesNear(const Problem& problem, const Problem::Vector& x,
                                            const std::vector<bool>& logs) const {
  const auto& base = base_.fitted->sensitivities.value().jacobian;
  const Problem::Vector at = problem.Clamp(x);
  const auto J = problem.Jacobian(at, problem.Residuals(at, logs), logs, base, true);
  Problem::Matrix slopes = fitter_.whitening.Stack(J, logs);
  for (Eigen::Index i = 0; i < slopes.cols(); ++i) slopes.col(i) *= problem.parameters()[i].scale;
  if (!slopes.allFinite()) slopes.resize(0, 0);
  return slopes;
}

// By what the time step leaves open: a fit that imitates it has less to spare than the others.
// Nothing where the step of zero fits worse.
double CandidateSearch::StepReduction(const Fitted& f) {
  return std::max(0.0, 2 * f.fit.cost - f.cost);
}

// Sensitivities are expensive: only those get theirs that may come near the best with them. What
// the time step leaves open takes about as much off everybody's cost. best: the least cost that is
// known already.
void CandidateSearch::CompleteCompetitive(double best) {
  std::vector<CandidateResult*> order;
  for (CandidateResult& c : candidates) {
    if (c.was_fitted) order.push_back(&c);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->fitted.cost < b->fitted.cost; });
  double step_reduction = StepReduction(*base_.fitted);
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
