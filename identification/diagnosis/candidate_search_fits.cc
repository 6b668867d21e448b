#include <algorithm>
#include <cmath>

#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/candidates/search_range.h"
#include "identification/diagnosis/candidate_search.h"
#include "identification/statistics/uncertainty.h"

// The fits of a round: who gets one, from where, and how far.
namespace continuum {
namespace {
constexpr double kRival = 0.3;       // of what the best of a list explains: may yet outdo it
constexpr double kWorthAFit = 0.04;  // of the squares, where 0.19 of them would make a name
constexpr double kOutdoes = 0.1;     // of the best: hardly what comes near the noise besides
}  // namespace

// Where little is to be explained first order is right to a few units, else wrong about sizes by
// factors but not by orders of magnitude.
double CandidateSearch::HowMuchIsNeeded() const {
  if (!noise_.known()) return kWorthAFit * left_;
  const double best = MostExplained();
  return std::max(std::min(best - 15, 45.0), 0.02 * best);
}

// Whether a fit leaves hardly more than the noise and what the time step adds.
bool CandidateSearch::NearTheNoise(const Fitted& fitted) const {
  constexpr double kNoise = 1.1, kStep = 1.25;  // of their errors: more is plainly another cause
  return fitted.error.train < std::hypot(kNoise * noise_.rms, kStep * noise_.step);
}

// The likeliest first, so that the others know what to reach; nobody where only noise is left.
void CandidateSearch::Fit(const CandidateSearch* beside) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.explained > b.explained; });
  double needed = !noise_.known() || SomethingIsLeft() ? HowMuchIsNeeded() : kInfinity;
  const CandidateResult* const known = beside ? beside->leading() : nullptr;
  if (beside) needed = std::max(needed, kRival * beside->MostExplained());
  double rival = known ? known->fitted.fit.cost : kInfinity;
  for (CandidateResult& c : candidates) {
    if (!c.error.empty() || c.explained < needed) continue;
    options_.Say("fit " + c.hypothesis.Name());
    try {
      FitOne(c, rival + 0.5 * TakenOff(*base_.fitted));
      if (!noise_.known()) continue;
      rival = std::min(rival, c.fitted.fit.cost);
      if (NearTheNoise(c.fitted)) needed = std::max(needed, kOutdoes * MostExplained());
    } catch (const Error& error) {
      c.error = error.what();
    }
  }
  SecondChances();
  CompleteTheBest(known ? known->fitted.cost : kInfinity);
  Dismiss();
}

// Where no fit comes near the noise and what the time step adds, those that were given up as too
// far behind go on to their end, the likeliest first: what a fit gains early says little where a
// swing is out of phase with the measured one. Until one of this round comes near.
void CandidateSearch::SecondChances() {
  constexpr std::size_t kMost = 6;
  if (!noise_.known()) return;
  for (const CandidateResult& c : candidates) {
    if (c.fits && NearTheNoise(c.fitted)) return;
  }
  std::size_t tried = 0;
  for (CandidateResult& c : candidates) {
    if (tried == kMost || c.explained < kOutdoes * MostExplained()) return;
    if (!c.fits || c.fitted.fit.converged) continue;
    options_.Say("fit to the end " + c.hypothesis.Name());
    ++tried;
    try {
      FitOne(c, kInfinity);
      if (NearTheNoise(c.fitted)) return;
    } catch (const Error&) {
      continue;  // the fit that was given up stands
    }
  }
}

// Where joints stick and slip a fit from what the base has become ends in a neighbouring valley.
bool CandidateSearch::StartAnew() {
  constexpr std::size_t kMost = 4;
  std::vector<CandidateResult*> best;
  for (CandidateResult& c : candidates) {
    if (c.fits && c.listed) best.push_back(&c);
  }
  std::stable_sort(best.begin(), best.end(), [](const auto* a, const auto* b) {
    return a->fitted.fit.cost < b->fitted.fit.cost;
  });
  best.resize(std::min(best.size(), kMost));
  bool better = false;
  for (CandidateResult* const c : best) {
    options_.Say("fit anew " + c->hypothesis.Name());
    better = FitAnew(*c) || better;
  }
  if (!better) return false;
  CompleteTheBest(kInfinity);
  Dismiss();
  return true;
}

// What the experiment begins with, and all or part of what the candidate's fit has found.
std::vector<Problem::Vector> CandidateSearch::FromTheOutset(const Problem& problem,
                                                            const CandidateResult& c) {
  const Hypothesis& h = c.hypothesis;
  const auto own = static_cast<Eigen::Index>(h.extra.size());
  std::vector<Problem::Vector> starts;
  for (const double share : {1.0, 0.75, 0.5}) {
    Problem::Vector x = problem.Start();
    x.tail(own) = c.fitted.fit.x.tail(own);
    for (const std::size_t a : h.Amplitudes()) {
      double& value = x[c.own() + static_cast<Eigen::Index>(a)];
      value = h.AtShare(a, value, share);
    }
    starts.push_back(problem.Clamp(x));
  }
  return starts;
}

bool CandidateSearch::FitAnew(CandidateResult& c) const {
  constexpr double kGain = 0.5;  // of half the whitened squares
  const Problem problem = c.ProblemOf(*trials_.experiment);
  try {
    const Problem::Vector start = BestOf(problem, FromTheOutset(problem, c));
    Fitted fitted = trials_.Fit(problem, start, c.fitted.fit.cost);
    if (!(fitted.fit.cost < c.fitted.fit.cost - kGain)) return false;
    c.fitted = std::move(fitted);
    c.finer.reset();
    return true;
  } catch (const Error&) {
    return false;  // the fit that is there stands
  }
}

// From the start that is best after a few iterations, of the screen or of the hypothesis.
void CandidateSearch::FitOne(CandidateResult& c, double rival) const {
  const Problem problem = c.ProblemOf(*trials_.experiment);
  std::vector<Problem::Vector> starts = c.rivals;
  if (c.start.size() > 0) starts.insert(starts.begin(), c.start);
  const bool crooked = !noise_.known() && c.hypothesis.extra.size() > 1;  // first order may mislead
  if (crooked || starts.empty()) {
    for (const auto& own : c.hypothesis.starts) starts.push_back(Append(base_.fitted->fit.x, own));
  }
  c.fitted = trials_.Fit(problem, BestOf(problem, starts), rival);
  c.fits = true;
  GoOn(problem, c, rival);
  FitBeyond(c, rival);
}

// In what size an effect is looked for is a guess: a fit that ends there goes on beyond.
void CandidateSearch::FitBeyond(CandidateResult& c, double rival) const {
  constexpr int kTimes = 3;
  Hypothesis& h = c.hypothesis;
  const std::vector<Param>& law = EffectNamed(h.Card()).params;
  for (int i = 0; i < kTimes; ++i) {
    if (!Widen(h.extra, h.null, law, {c.fitted.fit.x.data() + c.own(), h.extra.size()})) return;
    const Problem problem = c.ProblemOf(*trials_.experiment);
    c.fitted = trials_.Fit(problem, c.fitted.fit.x, rival);
    GoOn(problem, c, rival);
  }
}

// A fit that is out of iterations while every one of them still gains goes on, as along a valley
// in which a stiffness of the model makes room for one of the candidate.
void CandidateSearch::GoOn(const Problem& problem, CandidateResult& c, double rival) const {
  constexpr int kTimes = 3;
  // By the last step: of half the whitened squares, or of any in parts of them.
  constexpr double kGain = 0.5, kShare = 1e-3;
  for (int i = 0; i < kTimes; ++i) {
    const continuum::Fit& f = c.fitted.fit;
    const double least = noise_.known() ? kGain : kShare * f.cost;
    if (f.iterations < trials_.iterations || !(f.LastGain() > least)) return;
    Fitted next = trials_.Fit(problem, f.x, rival);
    if (!(next.fit.cost < f.cost)) return;
    c.fitted = std::move(next);
  }
}

CandidateResult CandidateSearch::FitAlone(CandidateResult c) const {
  FitOne(c, kInfinity);
  const Problem problem = c.ProblemOf(*trials_.experiment);
  trials_.Complete(problem, c.fitted);
  if (const std::string flaw = FlawOf(problem, c.fitted); !flaw.empty()) throw Error::Job(flaw);
  c.likelihood = Likelihood(c.fitted);
  return c;
}

Problem::Vector CandidateSearch::BestOf(const Problem& problem,
                                        const std::vector<Problem::Vector>& starts) const {
  if (starts.size() == 1) return starts.front();
  FitOptions options{4, 1e-3};
  options.idle = true;
  if (trials_.whitening.active()) options.whitening = &trials_.whitening;
  double best_cost = kInfinity;
  Problem::Vector best;
  for (const auto& start : starts) {
    try {
      const continuum::Fit fit = FitParameters(problem, start, problem.TrainLogs(), options);
      if (fit.cost < best_cost) best_cost = fit.cost, best = fit.x;
    } catch (const Error&) {
      continue;  // this start diverges; another may not
    }
  }
  if (best.size() == 0) throw Error::Job("the simulation diverges from every start");
  return best;
}

// By what the time step leaves open: a fit that imitates it has less to spare than the others.
// Nothing where the step of zero fits worse.
double CandidateSearch::TakenOff(const Fitted& f) { return std::max(0.0, 2 * f.fit.cost - f.cost); }

// Sensitivities are dear: only those get theirs that may come near the best with them. What the
// time step leaves open takes about as much off everybody's cost. best: the least cost that is
// known already.
void CandidateSearch::CompleteTheBest(double best) {
  std::vector<CandidateResult*> order;
  for (CandidateResult& c : candidates) {
    if (c.fits) order.push_back(&c);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->fitted.cost < b->fitted.cost; });
  constexpr double kNear = 50;
  double taken_off = TakenOff(*base_.fitted);
  for (CandidateResult* const c : order) {
    const double plain = c->fitted.cost;
    if (noise_.known() && !c->fitted.complete && plain - best < kNear + 2 * taken_off) {
      options_.Say("sensitivities of " + c->hypothesis.Name());
      const Problem problem = c->ProblemOf(*trials_.experiment);
      trials_.Complete(problem, c->fitted);
      Problem::Vector x = c->fitted.fit.x;
      if (RaiseDelays(*c, problem.step(), x)) AtAFineStep(*c);
      c->error = c->finer ? FlawOf(AtQuarter(problem), *c->finer) : FlawOf(problem, c->fitted);
      c->fits = c->error.empty();
      if (!c->fits) continue;
      const double behind = c->fitted.cost - best, promise = base_.fitted->cost - best;
      if (!c->finer && behind < std::min(TakenOff(c->fitted), promise)) AtAFineStep(*c);
      best = std::min(best, c->fitted.cost);
      taken_off = std::max(taken_off, TakenOff(c->fitted));
    }
    c->likelihood = Likelihood(c->fitted);
  }
}

// To the engine a delay shorter than a step is a whole one: a fit cannot tell which.
bool CandidateSearch::RaiseDelays(const CandidateResult& c, double step, Problem::Vector& x) {
  bool raised = false;
  for (std::size_t i = 0; i < c.hypothesis.extra.size(); ++i) {
    const Parameter& p = c.hypothesis.extra[i];
    double& value = x[c.own() + static_cast<Eigen::Index>(i)];
    if (p.name != "delay" || !p.target.starts_with("actuator:") || value >= step) continue;
    value = step, raised = true;
  }
  return raised;
}

// Where the step's effect is not of first order a finer step may leave less. The values remain
// those of the coarse one.
void CandidateSearch::AtAFineStep(CandidateResult& c) const {
  constexpr double kRough = 0.15;
  const Problem problem = c.ProblemOf(*trials_.experiment);
  Fitted from = c.fitted;
  const bool raised = RaiseDelays(c, problem.step(), from.fit.x);
  if (!raised && trials_.LeftBy(c.fitted).roughness() < kRough) return;
  try {
    Fitted finer = trials_.GoOn(AtQuarter(problem), from);
    if (!(finer.cost < c.fitted.cost)) return;
    c.fitted.cost = finer.cost;
    c.finer = std::move(finer);
  } catch (const Error&) {
    return;  // it diverges there
  }
}

// Why nothing can be said of a complete fit; empty when it can be judged. What the time step leaves
// open is free to vary: a fit that is mostly that explains anything.
std::string CandidateSearch::FlawOf(const Problem& problem, const Fitted& fitted) const {
  if (!std::isfinite(fitted.cost)) return "the simulation diverges next to its fit";
  const double removed = Beyond(base_.fitted->error.train, fitted.error.train);
  const bool resolved = trials_.StepEffect(problem, fitted) <
                        trials_.StepEffect(problem, *base_.fitted) + removed + 0.1 * noise_.rms;
  return resolved ? "" : "the time step adds more to its fit than it removes";
}

}  // namespace continuum
