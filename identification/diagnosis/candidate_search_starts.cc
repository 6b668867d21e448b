#include <algorithm>
#include <utility>

#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/candidates/search_range.h"
#include "identification/diagnosis/candidate_search.h"
#include "identification/diagnosis/family_starts.h"
#include "identification/diagnosis/look_logs.h"
#include "identification/diagnosis/probing.h"
#include "sim/io/interrupt.h"

// One fit of a search: where it begins, and how far it goes.
namespace continuum {
namespace {

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
  Problem problem = ProblemOf(c, *fitter_.experiment);
  if (c.hypothesis.OnlyMeasured()) problem.Recall(base_problem_);
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
  GoOnWidely(problem, c, rival);
  if (IsLost(c)) RefitFrom(problem, c, StartsWithoutBase(problem, c));
  if (IsLost(c)) RefitFrom(problem, c, StartsNextToBase(c.hypothesis));
  WidenRanges(c, rival);
}

// A candidate contains the model without it: one that ends worse has lost its way from there.
bool CandidateSearch::IsLost(const CandidateResult& c) const {
  return c.fitted.fit.cost > base_.fitted->fit.cost;
}

// The candidate as it may begin, beside what the experiment begins with: what the base has made of
// that may be far from any fit with the candidate.
std::vector<Problem::Vector> CandidateSearch::StartsWithoutBase(const Problem& problem,
                                                                const CandidateResult& c) {
  const Problem::Vector given = problem.Start().head(c.first_extra());
  std::vector<Problem::Vector> starts;
  for (const auto& own : c.hypothesis.starts) starts.push_back(Append(given, own));
  if (c.start.size() == problem.Start().size()) {
    starts.push_back(c.start);
    starts.back().head(given.size()) = given;
  }
  return starts;
}

// A little of the candidate beside the base.
std::vector<Problem::Vector> CandidateSearch::StartsNextToBase(const Hypothesis& h) const {
  constexpr double kLittle = 0.05;
  std::vector<Problem::Vector> starts;
  for (std::vector<double> own : h.starts) {
    for (const std::size_t a : h.Amplitudes()) own[a] = h.AtShare(a, own[a], kLittle);
    starts.push_back(Append(base_.fitted->fit.x, own));
  }
  return starts;
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

// As `identify` does: where joints stick and slip the cost of a law of many numbers has ripples,
// and slopes at a point lead only into the nearest one. From where the fit has ended, then from
// what the experiment begins with.
void CandidateSearch::GoOnWidely(const Problem& problem, CandidateResult& c, double rival) const {
  constexpr std::size_t kMany = 3;
  if (noise_.known() || c.hypothesis.extra.size() < kMany) return;
  const auto logs = LogsForALook(*fitter_.experiment, base_problem_.step());
  if (!IsFarOverNoise(problem, c.fitted.fit.x, logs)) return;
  const auto go_on = [&](const Problem::Vector& x) {
    if (fitter_.TimeIsOver()) return;
    const continuum::Fit wide = fitter_.FitWidely(problem, x);
    if (wide.cost < c.fitted.fit.cost) c.fitted = fitter_.Fit(problem, {wide.x}, rival);
  };
  go_on(c.fitted.fit.x);
  go_on(BestOf(problem, StartsWithoutBase(problem, c)).x);
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
  if (starts.size() == 1) return {starts.front()};
  Problem problem = whole;
  const bool coarse = StepAsBase(problem);
  const auto logs = LogsForALook(*fitter_.experiment, base_problem_.step());
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
      Problem::Matrix slopes;
      options.slopes = &slopes;
      continuum::Fit fit = FitParameters(problem, *start, logs, options);
      if (fit.cost < best_cost) best_cost = fit.cost, best = {std::move(fit.x), std::move(slopes)};
    } catch (const Error&) {
      continue;
    }
  }
  if (best.x.size() == 0) StopIfRequested();
  if (best.x.size() == 0 && !coarse) throw Error::Job("the simulation diverges from every start");
  if (best.x.size() == 0) return {starts.front()};
  if (logs != TrainLogs(*fitter_.experiment)) best.slopes.resize(0, 0);
  return best;
}

}  // namespace continuum
