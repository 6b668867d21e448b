#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "error.h"
#include "identification/diagnosis/candidate_search.h"
#include "identification/diagnosis/search_rules.h"
#include "identification/statistics/uncertainty.h"

// What the time step does to the fits of a search.
namespace continuum {

// What a coarse step adds hides what else is wrong. Where joints stick and slip it falls slowly,
// and a fit may end in another local minimum. Where it is of first order in the step it is taken
// off already, and nothing more falls.
bool CandidateSearch::FallsWithStep(CandidateResult& c) const {
  if (!c.falls_with_step) c.falls_with_step = IsRough(c.fitted) && FitsBetterAtFineStep(c);
  return *c.falls_with_step;
}

bool CandidateSearch::IsRough(const Fitted& fitted) const {
  return continuum::IsRough(fitter_.ProjectedResidualOf(fitted).roughness(), criteria_);
}

bool CandidateSearch::FitsBetterAtFineStep(CandidateResult& c) const {
  options_.Say(DiagnosisStage::kFits, "at a fine step, " + c.hypothesis.Name());
  const Problem fine = AtQuarter(ProblemOf(c, *fitter_.experiment));
  // By the directions that are known, then by those at the fine step: they take a far finer one.
  const auto falls = [&](Fitted finer) {
    if (FallsTo(c, finer)) return true;
    fitter_.Complete(fine, finer);
    return FallsTo(c, finer) || !LackAt(fine, c, finer).significant(criteria_);
  };
  try {
    Fitted known = c.at_quarter_step ? *c.at_quarter_step : fitter_.Continue(fine, c.fitted);
    c.at_quarter_x = known.fit.x;
    if (falls(std::move(known))) return true;
    if (fitter_.TimeIsOver()) return false;
    Fitted anew = c.fitted;
    anew.fit.x = BestOf(fine, ExperimentStarts(fine, c)).x;
    return falls(fitter_.Continue(fine, anew));
  } catch (const Error&) {
    return true;  // it diverges there
  }
}

bool CandidateSearch::FallsTo(const CandidateResult& c, const Fitted& finer) const {
  const auto excess = [&](const Fitted& f) {
    const ProjectedResidual residual = fitter_.ProjectedResidualOf(f);
    return residual.cost() - residual.freedom();
  };
  return continuum::FallsWithStep(excess(c.fitted), excess(finer), criteria_);
}

// To the engine a delay shorter than a step is a whole one: a fit cannot find out which.
bool CandidateSearch::RaiseDelays(const CandidateResult& c, double step, Problem::Vector& x) {
  bool raised = false;
  for (std::size_t i = 0; i < c.hypothesis.extra.size(); ++i) {
    const Parameter& p = c.hypothesis.extra[i];
    double& value = x[c.first_extra() + static_cast<Eigen::Index>(i)];
    if (p.name != "delay" || !p.target.starts_with("actuator:") || value >= step) continue;
    value = step, raised = true;
  }
  return raised;
}

// Where the time-discretisation error is not of first order a finer step may fit better. The values
// remain those of the coarse one.
void CandidateSearch::RefitAtQuarterStep(CandidateResult& c) const {
  const Problem problem = ProblemOf(c, *fitter_.experiment);
  Fitted from = c.fitted;
  const bool raised = RaiseDelays(c, problem.step(), from.fit.x);
  if (!raised && !IsRough(c.fitted)) return;
  try {
    const Problem fine = AtQuarter(problem);
    Fitted finer = fitter_.Continue(fine, from);
    c.at_quarter_x = finer.fit.x;
    fitter_.Complete(fine, finer);
    if (!(finer.cost < c.fitted.cost)) return;
    c.fitted.cost = finer.cost;
    c.at_quarter_step = std::move(finer);
  } catch (const Error&) {
    return;  // it diverges there
  }
}

// A fit that is mostly what the time step makes ended in a wrong place, or its swing is one that
// parts with the step.
void CandidateSearch::Mend(const Problem& problem, CandidateResult& c) const {
  if (RefitFromStart(c)) {
    fitter_.Complete(problem, c.fitted);
    c.error = FlawOf(problem, c.fitted);
  }
  if (!c.error.empty() && IsSoundAtQuarterStep(problem, c)) c.error.clear();
}

// Where a swing nearly comes to rest upside down its two sides part with the step: a fit at a
// quarter of it says as much, if that one is sound.
bool CandidateSearch::IsSoundAtQuarterStep(const Problem& problem, CandidateResult& c) const {
  try {
    const Problem fine = AtQuarter(problem);
    Fitted finer = fitter_.Continue(fine, c.fitted);
    fitter_.Complete(fine, finer);
    if (!FlawOf(fine, finer).empty()) return false;
    c.at_quarter_x = finer.fit.x;
    c.fitted.cost = finer.cost;
    c.at_quarter_step = std::move(finer);
    return true;
  } catch (const Error&) {
    return false;  // it diverges there
  }
}

// Why nothing can be said of a complete fit; empty when it can be judged. What the time step leaves
// open is free to vary: a fit that is mostly that explains anything.
std::string CandidateSearch::FlawOf(const Problem& problem, const Fitted& fitted) const {
  if (!std::isfinite(fitted.cost)) return "the simulation diverges next to its fit";
  const double removed = WithoutPart(base_.fitted->error.train, fitted.error.train);
  const bool resolved =
      IsResolved(fitter_.StepError(problem, fitted), fitter_.StepError(problem, *base_.fitted),
                 removed, noise_.rms, criteria_);
  return resolved ? "" : "the time step adds more to its fit than it removes";
}

}  // namespace continuum
