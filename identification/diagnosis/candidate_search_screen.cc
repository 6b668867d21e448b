#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "error.h"
#include "identification/diagnosis/candidate_search.h"
#include "identification/diagnosis/equation_error.h"
#include "identification/diagnosis/look_logs.h"
#include "identification/diagnosis/probing.h"
#include "identification/diagnosis/quantisation.h"
#include "identification/diagnosis/search_bytes.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/shared_loop.h"

// The screen of a search: what every candidate could explain, before any fit.
namespace continuum {
namespace {
constexpr int kDraws = 399;  // of rounding errors

// What the best of a candidate's probes explains.
double MostOf(const std::vector<Probe>& probes, const ProjectedResidual& residual) {
  double most = 0;
  for (const Probe& probe : probes)
    most = std::max(most, ExplainedBy(probe, residual.vector()).amount);
  return most;
}

std::vector<bool> LogWithMost(const Whitening& whitening,
                              const std::vector<Problem::Vector>& residuals,
                              const std::vector<bool>& use) {
  std::vector<bool> found;
  double most = -1;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    std::vector<bool> one(use.size(), false);
    one[l] = true;
    const double squares = whitening.Stack(residuals, one).squaredNorm();
    if (squares > most) most = squares, found = std::move(one);
  }
  return found;
}

// The directions of two candidates together.
Probe Beside(const Probe& a, const Probe& b) {
  Probe both{Problem::Matrix(a.columns.rows(), a.columns.cols() + b.columns.cols()), a.sign};
  both.columns << a.columns, b.columns;
  both.sign.insert(both.sign.end(), b.sign.begin(), b.sign.end());
  return both;
}

}  // namespace

// In coarse steps where the base can be simulated in them and the candidate as well.
std::vector<Probe> CandidateSearch::Probes(const CandidateResult& c,
                                           const ProjectedResidual& residual,
                                           const std::vector<std::size_t>& starts) const {
  Problem problem = ProblemOf(c, *fitter_.experiment);
  const auto probe = [&](const std::vector<Problem::Vector>& residuals) {
    return ProbesOf(c.hypothesis, problem, {base_.fitted->fit.x, residuals}, residual,
                    fitter_.whitening.active(), starts, criteria_);
  };
  if (c.hypothesis.OnlyMeasured()) {
    problem.Recall(base_problem_);
  } else if (const double own = problem.step(); StepAsBase(problem)) {
    try {
      return probe(coarse_->residuals);
    } catch (const Error&) {
      problem.StepBy(own);
    }
  }
  return probe(base_.fitted->residuals);
}

// The base in coarse steps, where it can be simulated in them.
void CandidateSearch::SimulateCoarsely() {
  Problem problem = base_problem_;
  if (auto residuals = StepCoarsely(problem, base_.fitted->fit.x, base_.fitted->residuals))
    coarse_ = {problem.step(), std::move(*residuals)};
}

void CandidateSearch::ProbeOne(CandidateResult& c, const ProjectedResidual& residual,
                               const std::vector<std::size_t>& starts) {
  try {
    const auto more = Probes(c, residual, starts);
    c.probes.insert(c.probes.end(), more.begin(), more.end());
    c.explained = std::max(c.explained, MostOf(more, residual));
  } catch (const Error& error) {
    if (c.probes.empty()) c.error = error.what();
  }
}

// What the sensors alone explain of the error itself costs no simulation. Where it cannot be said
// the other views are left.
void CandidateSearch::LookAtError(CandidateResult& c) const {
  if (!c.hypothesis.OnlyMeasured() || !c.error.empty()) return;
  Problem problem = ProblemOf(c, *fitter_.experiment);
  problem.Recall(base_problem_);
  try {
    const double share =
        PlainShare(c.hypothesis, problem, {base_.fitted->fit.x, base_.fitted->residuals},
                   TrainLogs(*fitter_.experiment));
    if (share >= criteria_.main_share) c.error_promise = share;
  } catch (const Error&) {
    return;
  }
}

// Those with few sizes and shapes first, so that as many as can be have been looked at when the
// time is over.
std::vector<CandidateResult*> CandidateSearch::CheapestFirst() {
  std::vector<CandidateResult*> order;
  for (CandidateResult& c : candidates) order.push_back(&c);
  const auto looks = [](const CandidateResult* c) {
    return c->hypothesis.starts.size() * c->hypothesis.Amplitudes().size();
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](const auto* a, const auto* b) { return looks(a) < looks(b); });
  return order;
}

// Those that only the sensors show at once, as nothing is simulated for them; the others by what
// they explain of the missing force.
std::vector<CandidateResult*> CandidateSearch::InOrderOfForce() {
  std::vector<CandidateResult*> order = CheapestFirst();
  const auto promise = [](const CandidateResult* c) {
    return c->hypothesis.OnlyMeasured() ? kInfinity : c->force_promise;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](const auto* a, const auto* b) { return promise(a) > promise(b); });
  return order;
}

// What a candidate in its first shape explains of a residual; infinite where that cannot be said.
double CandidateSearch::LookAt(const CandidateResult& c, const ProjectedResidual& residual) const {
  if (fitter_.TimeIsOver() || StopRequested()) return kInfinity;
  try {
    return MostOf(Probes(c, residual, c.hypothesis.StartsOfShape(true)), residual);
  } catch (const Error&) {
    return kInfinity;
  }
}

// Those that nobody asked for and that explain little of the log where most is left do not outdo
// what was asked for, unless the missing force promises it.
void CandidateSearch::KeepThoseThatMayOutdo(const CandidateResult& best) {
  const std::vector<bool> train = TrainLogs(*fitter_.experiment);
  if (std::count(train.begin(), train.end(), true) < 2) return;
  const ProjectedResidual residual = fitter_.ProjectedResidualOf(
      *base_.fitted, LogWithMost(fitter_.whitening, base_.fitted->residuals, train));
  const double needed = FitThresholdAtNoise(LookAt(best, residual), criteria_);
  if (!std::isfinite(needed)) return;
  options_.Say(DiagnosisStage::kScreen, "one log");
  std::vector<std::uint8_t> hopeless(candidates.size(), 0);
  const auto look = [&](std::size_t, std::size_t i) {
    const CandidateResult& c = candidates[i];
    if (!c.hypothesis.OnlyMeasured() && !(c.force_promise > 0))
      hopeless[i] = LookAt(c, residual) < needed;
  };
  ShareOut(candidates.size(), look, [&](auto& a, std::size_t i) { a(hopeless[i]); });
  std::size_t i = 0;
  std::erase_if(candidates, [&](const CandidateResult&) { return hopeless[i++] != 0; });
}

void CandidateSearch::DropHopeless(const std::set<std::string>& names) {
  std::erase_if(candidates, [&](const CandidateResult& c) {
    return !(c.force_promise > 0) && names.contains(c.hypothesis.NameAtPlace());
  });
}

// Every candidate in its first shape and in that which the missing force wants; in all its shapes
// where it is not hopeless in those, or where there is no missing force to see.
void CandidateSearch::ProbeAll(const ProjectedResidual& residual, bool sees_forces) {
  std::mutex mutex;
  std::size_t done = 0;
  const auto say = [&](CandidateResult& c, const char* look) {
    const std::lock_guard lock(mutex);
    const std::size_t all = candidates.size();
    options_.Say(DiagnosisStage::kScreen, c.hypothesis.Name(), std::min(done++, all), all);
    return fitter_.HasTimeFor(look + c.hypothesis.NameAtPlace(), left_out);
  };
  const std::vector<CandidateResult*> order = InOrderOfForce();
  const auto probes = [&](auto& archive, std::size_t i) { FieldsOfProbes(archive, *order[i]); };
  const auto first_shape = [&](std::size_t, std::size_t i) {
    CandidateResult& c = *order[i];
    if (!say(c, "a look at ")) return;
    auto starts = c.hypothesis.StartsOfShape(true);
    if (c.force_start > 0) starts.push_back(c.force_start);
    ProbeOne(c, residual, starts);
    LookAtError(c);
  };
  ShareOut(order.size(), first_shape, probes);
  const double least = sees_forces ? criteria_.fit_share * MostExplained() : 0;
  const auto other_shapes = [&](std::size_t, std::size_t i) {
    CandidateResult& c = *order[i];
    auto others = c.hypothesis.StartsOfShape(false);
    std::erase(others, c.force_start);
    if (c.explained < least || c.probes.empty() || others.empty()) return;
    if (say(c, "other shapes of ")) ProbeOne(c, residual, others);
  };
  ShareOut(order.size(), other_shapes, probes);
}

// What probes are to explain. Where nothing is significant anyway, as the noise is not known, in
// the logs for a look.
ProjectedResidual CandidateSearch::ScreenedResidual() const {
  const Experiment& e = *fitter_.experiment;
  return fitter_.ProjectedResidualOf(
      *base_.fitted, noise_.known() ? TrainLogs(e) : LogsForALook(e, base_problem_.step()));
}

void CandidateSearch::Screen(const std::vector<EquationErrors>& views, const CandidateResult* rival,
                             const std::set<std::string>& hopeless) {
  const ProjectedResidual residual = ScreenedResidual();
  base_squares_ = residual.cost();
  base_problem_.Residuals(base_.fitted->fit.x, TrainLogs(*fitter_.experiment));
  SimulateCoarsely();
  for (const EquationErrors& view : views) LookAtForces(view, rival);
  if (rival) KeepThoseThatMayOutdo(*rival);
  DropHopeless(hopeless);
  ProbeAll(residual, !views.empty() && views.front().any());
  std::vector<std::vector<Probe>> probes;
  for (CandidateResult& c : candidates) probes.push_back(std::move(c.probes));
  options_.Say(DiagnosisStage::kScreen, "significance", candidates.size(), candidates.size());
  const Significance found =
      noise_.known() ? Significant(residual, probes) : BestOfProbes(probes, residual.vector());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    CandidateResult& c = candidates[i];
    c.explained = found.explained[i];
    c.p = found.p[i];
    c.probes = std::move(probes[i]);
    smallest_p_ = std::min(smallest_p_, c.p);
    if (c.probes.empty()) continue;
    const std::size_t best = found.best[i];
    const Probe& probe = c.probes[best];
    c.start = StartFrom(c.hypothesis, *base_.fitted, probe,
                        PlainlyExplainedBy(probe, residual.vector()), 1, criteria_);
    const auto others = OtherStarts(c, best, residual);
    c.other_starts.insert(c.other_starts.begin(), others.begin(), others.end());
    std::swap(c.probes[0], c.probes[best]);
  }
}

// In the shape that another view has found, else in the first one. Nothing where no machine has
// such parameters, or it diverges: the other views are left.
std::optional<EquationStart> CandidateSearch::LookAtForce(const EquationErrors& view,
                                                          const CandidateResult& c) const {
  if (StopRequested() || fitter_.TimeIsOver()) return {};
  try {
    return view.From(c.hypothesis, ProblemOf(c, *fitter_.experiment), c.force_start);
  } catch (const Error&) {
    return {};
  }
}

void CandidateSearch::LookAtOtherShapes(const EquationErrors& view, const CandidateResult& c,
                                        std::optional<EquationStart>& found) const {
  if (!found || c.force_promise > 0 || StopRequested() || fitter_.TimeIsOver()) return;
  if (c.hypothesis.StartsOfShape(false).empty()) return;
  try {
    found = view.BestShape(c.hypothesis, ProblemOf(c, *fitter_.experiment), *found);
  } catch (const Error&) {
    return;  // one of them diverges
  }
}

// First order is blind where an effect is large or the base far off; the missing force is not. It
// decides who comes first, by what the best explains, the rival among them. All candidates in one
// shape, then in their others those of which no view has said yet which one it wants, and that are
// not far behind the rival. Where a rival that leaves but noise in simulation explains nothing
// here, the missing force is noise.
void CandidateSearch::LookAtForces(const EquationErrors& view, const CandidateResult* rival) {
  options_.Say(DiagnosisStage::kScreen, "missing force");
  if (!view.any()) return;
  auto best = rival ? LookAtForce(view, *rival) : std::nullopt;
  if (rival) LookAtOtherShapes(view, *rival, best);
  const bool sees_rival = best && best->share >= criteria_.force_least;
  if (rival && !sees_rival && rival->fitted.over_noise() < criteria_.near_noise) return;
  const std::vector<CandidateResult*> order = CheapestFirst();
  std::vector<std::optional<EquationStart>> found(order.size());
  const auto start = [&](auto& archive, std::size_t i) { archive(found[i]); };
  const auto look = [&](std::size_t, std::size_t i) { found[i] = LookAtForce(view, *order[i]); };
  ShareOut(order.size(), look, start);
  const double least = best ? criteria_.rival_share * best->share : 0;
  const auto look_on = [&](std::size_t, std::size_t i) {
    if (found[i] && found[i]->share >= least) LookAtOtherShapes(view, *order[i], found[i]);
  };
  ShareOut(order.size(), look_on, start);
  double most = best ? best->share : 0;
  for (const auto& one : found) most = std::max(most, one ? one->share : 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (!found[i]) continue;
    CandidateResult& c = *order[i];
    c.other_starts.push_back(found[i]->x);
    c.other_starts.push_back(found[i]->together);
    const double promise = found[i]->share / most;
    if (!ExplainsForce(found[i]->share, most, criteria_) || promise <= c.force_promise) continue;
    c.force_promise = promise, c.force_start = found[i]->start;
  }
}

Significance CandidateSearch::Significant(const ProjectedResidual& residual,
                                          const std::vector<std::vector<Probe>>& probes) {
  const Quantisation quantisation(base_problem_, noise_, base_.fitted->fit.x);
  Problem::Matrix draws;
  if (quantisation.any()) {
    inflation_ = quantisation.Inflation(residual, probes, options_.seed);
    draws = quantisation.Draws(residual, kDraws, options_.seed);
  }
  return SignificanceOf(probes, residual.vector(), options_.seed, draws);
}

// First order says little of what acts on top of another amplitude, as a Stribeck excess, nor of
// what belongs to it, as its speed: starts that explain as much as the best, with little and much
// of it.
std::vector<Problem::Vector> CandidateSearch::OtherStarts(const CandidateResult& c,
                                                          std::size_t best,
                                                          const ProjectedResidual& residual) const {
  std::set<std::size_t> seen;
  std::vector<Problem::Vector> starts;
  for (const Probe& probe : c.probes) {
    const auto& on_top = probe.on_top;
    if (std::find(on_top.begin(), on_top.end(), true) == on_top.end()) continue;
    const Explained e = ExplainedBy(probe, residual.vector());
    if (!IsAsGood(e.amount, c.explained, criteria_) || !seen.insert(probe.start).second) continue;
    for (const double excess : {1.0, 10.0}) {
      if (&probe == &c.probes[best] && excess == 1) continue;  // where the fit begins anyway
      starts.push_back(StartFrom(c.hypothesis, *base_.fitted, probe, e, excess, criteria_));
    }
  }
  return starts;
}

std::set<std::string> CandidateSearch::HopelessBeside(const CandidateResult& first) const {
  constexpr double kShare = 0.2, kFar = 2;  // first order is wrong by factors
  if (first.probes.empty()) return {};
  const Probe& own = first.probes.front();
  const Problem::Vector z = ScreenedResidual().vector();
  const double alone = ExplainedBy(own, z).amount;
  const double taken = base_.fitted->cost - first.fitted.cost;
  if (taken > kFar * alone || alone > kFar * taken) return {};  // no more is said of the others
  std::map<std::string, double> added;
  double most = 0;
  for (const auto* all : {&candidates, &dismissed}) {
    for (const CandidateResult& c : *all) {
      if (c.probes.empty()) continue;
      double& more = added[c.hypothesis.NameAtPlace()];
      more = ExplainedBy(Beside(own, c.probes.front()), z).amount - alone;
      most = std::max(most, more);
    }
  }
  std::set<std::string> names;
  for (const auto& [name, more] : added)
    if (more < kShare * most) names.insert(name);
  return names;
}

}  // namespace continuum
