#include "identification/round.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Dense>

#include "error.h"
#include "identification/rounding.h"
#include "identification/uncertainty.h"

namespace continuum {
namespace {
constexpr int kDraws = 399;          // of rounding errors
constexpr double kRival = 0.3;       // of what the best of a list explains: may yet outdo it
constexpr double kWorthAFit = 0.04;  // of the squares, where 0.19 of them would make a name

// Nested fits are as far apart as the larger one gains; others that gain as much are farther. Where
// the noise is not known: they are as near as nothing to what either changes.
bool SaysTheSame(const Trials& trials, const CandidateResult& b, const CandidateResult& a) {
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

bool Contains(const Trials& trials, const CandidateResult& b, const CandidateResult& a) {
  if (b.hypothesis.extra.size() > a.hypothesis.extra.size() && SaysTheSame(trials, b, a))
    return true;
  if (a.probes.empty() || b.probes.empty()) return false;
  const Problem::Matrix &A = a.probes.front().AtStart(), &B = b.probes.front().AtStart();
  if (A.cols() >= B.cols()) return false;
  const Problem::Matrix rest = A - B * B.completeOrthogonalDecomposition().solve(A);
  return rest.squaredNorm() < 0.01 * A.squaredNorm();
}

Round::Round(const Trials& trials, const Base& base, const Noise& noise, const Sizes& sizes,
             const DiagnosisOptions& options)
    : trials_(trials), base_(base), noise_(noise), sizes_(sizes), options_(options) {
  Experiment wanted = *trials.experiment;
  if (!options.candidates.empty()) {
    wanted.all_candidates = false;
    wanted.candidates.clear();
    for (const auto& name : options.candidates) {
      const Candidate* const written = trials.experiment->Written(name);
      wanted.candidates.push_back(written ? *written : Candidate{name, "", false});
    }
  }
  for (Hypothesis& h : MakeCandidates(wanted, *base.system, sizes, skipped, base.given)) {
    candidates.push_back({std::move(h)});
    candidates.back().record.name = candidates.back().hypothesis.Name();
  }
}

void Round::Screen() {
  const Remainder left = trials_.LeftBy(*base_.fitted);
  left_ = left.cost();
  std::vector<std::vector<Probe>> probes;
  for (CandidateResult& c : candidates) {
    options_.Say("screen " + c.hypothesis.Name());
    probes.emplace_back();
    try {
      probes.back() =
          trials_.Probes(c.hypothesis, c.ProblemOf(*trials_.experiment), *base_.fitted, left);
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

Significance Round::Significant(const Remainder& left,
                                const std::vector<std::vector<Probe>>& probes) {
  const Problem base(*trials_.experiment, *base_.system, base_.given);
  const Rounding rounding(base, noise_, base_.fitted->fit.x);
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
std::vector<Problem::Vector> Round::StartsAsGood(const CandidateResult& c, std::size_t best,
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

double Round::smallest_p() const { return smallest_p_; }

bool Round::SomethingIsLeft() const {
  const Fitted& f = *base_.fitted;
  return smallest_p_ < LikelihoodRules{}.level ||
         f.cost > kModelLimited * kModelLimited * f.freedom;
}

double Round::MostExplained() const {
  double best = 0;
  for (const CandidateResult& c : candidates) best = std::max(best, c.explained);
  return best;
}

double Round::Promise() const {
  const double left = base_.fitted->cost - base_.fitted->freedom;
  return left > 0 ? MostExplained() / left : 0;
}

// Where little is to be explained first order is right to a few units, else wrong about sizes by
// factors but not by orders of magnitude.
double Round::HowMuchIsNeeded() const {
  if (!noise_.known()) return kWorthAFit * left_;
  const double best = MostExplained();
  return std::max(std::min(best - 15, 45.0), 0.02 * best);
}

// The likeliest first, so that the others know what to reach; nobody where only noise is left.
void Round::Fit(const Round* beside) {
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
      if (noise_.known()) rival = std::min(rival, c.fitted.fit.cost);
    } catch (const Error& error) {
      c.error = error.what();
    }
  }
  SecondChances();
  CompleteTheBest(known ? known->fitted.cost : kInfinity);
  Dismiss();
  TellApart();
}

void Round::JoinUnlisted(Round other) {
  for (CandidateResult& c : other.candidates) {
    c.listed = false;
    c.likelihood = Likelihood(c.fitted);  // in this round's unit of noise
    candidates.push_back(std::move(c));
  }
}

// Where no fit comes near the noise and what the time step adds, those that were given up as too
// far behind go on to their end, the likeliest first: what a fit gains early says little where a
// swing is out of phase with the measured one. Until one of this round comes near.
void Round::SecondChances() {
  constexpr std::size_t kMost = 6;
  constexpr double kWorth = 0.1;                // of what the best explains to first order
  constexpr double kNoise = 1.1, kStep = 1.25;  // of their errors: more is plainly another cause
  if (!noise_.known()) return;
  double best = kInfinity;
  for (const CandidateResult& c : candidates) {
    if (c.fits) best = std::min(best, c.fitted.error.train);
  }
  const double near = std::hypot(kNoise * noise_.rms, kStep * noise_.step);
  std::size_t tried = 0;
  for (CandidateResult& c : candidates) {
    if (best < near || tried == kMost || c.explained < kWorth * MostExplained()) return;
    if (!c.fits || c.fitted.fit.converged) continue;
    options_.Say("fit to the end " + c.hypothesis.Name());
    ++tried;
    try {
      FitOne(c, kInfinity);
      best = std::min(best, c.fitted.error.train);
    } catch (const Error&) {
      continue;  // the fit that was given up stands
    }
  }
}

// From the start that is best after a few iterations, of the screen or of the hypothesis.
void Round::FitOne(CandidateResult& c, double rival) const {
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
}

// A fit that is out of iterations while every one of them still gains goes on, as along a valley
// in which a stiffness of the model makes room for one of the candidate.
void Round::GoOn(const Problem& problem, CandidateResult& c, double rival) const {
  constexpr int kTimes = 3;
  // By the last iteration: of half the whitened squares, or of any in parts of them.
  constexpr double kGain = 0.5, kShare = 1e-3;
  for (int i = 0; i < kTimes; ++i) {
    const continuum::Fit& f = c.fitted.fit;
    const std::size_t n = f.trace.size();
    const double least = noise_.known() ? kGain : kShare * f.cost;
    const bool gains = n > 1 && f.trace[n - 2] - f.trace[n - 1] > least;
    if (f.iterations < trials_.iterations || !gains) return;
    Fitted next = trials_.Fit(problem, f.x, rival);
    if (!(next.fit.cost < f.cost)) return;
    c.fitted = std::move(next);
  }
}

CandidateResult Round::FitAlone(CandidateResult c) const {
  FitOne(c, kInfinity);
  const Problem problem = c.ProblemOf(*trials_.experiment);
  trials_.Complete(problem, c.fitted);
  if (const std::string flaw = FlawOf(problem, c.fitted); !flaw.empty()) throw Error::Job(flaw);
  c.likelihood = Likelihood(c.fitted);
  return c;
}

Problem::Vector Round::BestOf(const Problem& problem,
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
double Round::TakenOff(const Fitted& f) { return std::max(0.0, 2 * f.fit.cost - f.cost); }

// Sensitivities are dear: only those get theirs that may come near the best with them. What the
// time step leaves open takes about as much off everybody's cost. best: the least cost that is
// known already.
void Round::CompleteTheBest(double best) {
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
    if (noise_.known() && plain - best < kNear + 2 * taken_off) {
      options_.Say("sensitivities of " + c->hypothesis.Name());
      const Problem problem = c->ProblemOf(*trials_.experiment);
      trials_.Complete(problem, c->fitted);
      c->error = FlawOf(problem, c->fitted);
      c->fits = c->error.empty();
      if (!c->fits) continue;
      const double behind = c->fitted.cost - best, promise = base_.fitted->cost - best;
      if (behind < std::min(TakenOff(c->fitted), promise)) AtAFineStep(*c);
      best = std::min(best, c->fitted.cost);
      taken_off = std::max(taken_off, TakenOff(c->fitted));
    }
    c->likelihood = Likelihood(c->fitted);
  }
}

// To the engine a delay shorter than a step is a whole one: a fit cannot tell which.
bool Round::RaiseDelays(const CandidateResult& c, double step, Problem::Vector& x) {
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
void Round::AtAFineStep(CandidateResult& c) const {
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

// Twice the logarithm of what a fit gains over the base.
double Round::Likelihood(const Fitted& fitted) const {
  return (base_.fitted->cost - fitted.cost) / inflation_;
}

// Why nothing can be said of a complete fit; empty when it can be judged. What the time step leaves
// open is free to vary: a fit that is mostly that explains anything.
std::string Round::FlawOf(const Problem& problem, const Fitted& fitted) const {
  if (!std::isfinite(fitted.cost)) return "the simulation diverges next to its fit";
  const double removed = Beyond(base_.fitted->error.train, fitted.error.train);
  const bool resolved = trials_.StepEffect(problem, fitted) <
                        trials_.StepEffect(problem, *base_.fitted) + removed + 0.1 * noise_.rms;
  return resolved ? "" : "the time step adds more to its fit than it removes";
}

void Round::Dismiss() {
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
  smallest_p_ = 1;
  for (const auto* all : {&candidates, &left_behind}) {
    for (const CandidateResult& c : *all) smallest_p_ = std::min(smallest_p_, c.p);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.likelihood > b.likelihood; });
}

// |v − P v|², v what the leading candidate's directions explain, P onto the other's directions.
void Round::TellApart() {
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

const CandidateResult* Round::leading() const {
  return candidates.empty() || !candidates.front().fits ? nullptr : &candidates.front();
}

double Round::BestLeaves() const {
  const Fitted& best = leading() ? leading()->fitted : *base_.fitted;
  return std::sqrt(best.cost / best.freedom);
}

LackOfFit Round::LackOf(const CandidateResult& c) const {
  const Problem problem = c.ProblemOf(*trials_.experiment);
  return c.finer ? LackAt(AtQuarter(problem), c, *c.finer) : LackAt(problem, c, c.fitted);
}
LackOfFit Round::LackAt(const Problem& problem, const CandidateResult& c,
                        const Fitted& fitted) const {
  return trials_.LackIn(problem, c.hypothesis.Free(), fitted, sizes_, inflation_, options_.seed);
}
LackOfFit Round::LackOfBase() const {
  const Problem problem(*trials_.experiment, *base_.system, base_.given);
  return trials_.LackIn(problem, base_.given, *base_.fitted, sizes_, inflation_, options_.seed);
}

// What a coarse step adds hides what else is wrong. Where joints stick and slip it falls slowly.
bool Round::GoesWithTheStep(const CandidateResult& c) const {
  constexpr double kFalls = 0.75;  // to first order it falls to a sixteenth
  options_.Say("at a fine step " + c.hypothesis.Name());
  const Problem problem = c.ProblemOf(*trials_.experiment), fine = AtQuarter(problem);
  try {
    const Fitted finer = c.finer ? *c.finer : trials_.GoOn(fine, c.fitted);
    const auto excess = [](const Remainder& left) { return left.cost() - left.freedom(); };
    const double before = excess(trials_.LeftBy(c.fitted)), after = excess(trials_.LeftBy(finer));
    return after < kFalls * before || LackAt(fine, c, finer).smallest() >= LikelihoodRules{}.lack;
  } catch (const Error&) {
    return true;  // it diverges there
  }
}

std::vector<LikelihoodRecord> Round::Records() const {
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
