#include "identification/diagnosis/confirmation.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "identification/diagnosis/screening.h"
#include "identification/diagnosis/search_rules.h"
#include "identification/diagnosis/verdict.h"

namespace continuum {
namespace {

// Squares of the validate logs in units of the noise, without what the time step and the
// parameters of the experiment, which are free there as well, make of them. What is added keeps
// what the train logs give it at a time step of zero.
double HeldOutSquares(const CandidateFitter& fitter, const Problem& problem, Fitted fitted,
                      Eigen::Index first_added) {
  auto validate = problem.TrainLogs();
  validate.flip();
  fitter.CompleteOnValidate(problem, fitted);
  const Problem::Vector& x = fitted.fit.x;
  const auto& J = fitted.sensitivities->jacobian;
  const auto step = problem.StepEffects(x, fitted.residuals, validate);
  const Eigen::Index added = x.size() - first_added;
  const Problem::Vector shift = fitter.ProjectedResidualOf(fitted).shift().tail(added);
  std::vector<Problem::Vector> r = fitted.residuals;
  for (std::size_t l = 0; l < r.size(); ++l)
    if (validate[l]) r[l] += J[l].rightCols(added) * shift;
  std::vector<bool> fixed = fitted.sensitivities->uncertainty.at_bound;
  std::fill(fixed.begin() + first_added, fixed.end(), true);
  return ProjectedResidual(fitter.whitening, validate, r, J, fixed, step, fitter.criteria).cost();
}

// By more than chance, what a parameter gains from noise. As the error of a log is mostly its own
// offset or drift, in units of the noise.
bool RaisesValidateSquares(const CandidateFitter& fitter, const Diagnosis& d) {
  const Experiment& e = *fitter.experiment;
  if (!d.chosen()->fitted.complete()) return false;
  const Eigen::Index added = d.before.fit.x.size();
  const double before = HeldOutSquares(fitter, Problem(e, d.system), d.before, added);
  const double after = HeldOutSquares(fitter, ProblemOf(*d.chosen(), e), d.chosen()->fitted, added);
  return after > before + d.criteria.parameter_cost;
}

// why: with {} for the name.
void NameNothing(Diagnosis& d, const char* why) {
  d.verdict =
      Verdict::Adequate(fmt::format(fmt::runtime(why), d.chosen()->hypothesis.NameAtPlace()));
  d.partner.reset();
}

void TakeNameBack(Diagnosis& d, const std::string& why) {
  const std::string name = d.chosen()->hypothesis.NameAtPlace();
  d.verdict.kind = Verdict::Kind::kUnexplained, d.verdict.taken_back = true;
  d.verdict.leading = d.verdict.named.front();
  d.verdict.named.clear(), d.verdict.siblings.clear(), d.verdict.far_off.clear();
  d.partner.reset();
  d.verdict.reason = fmt::format("the best candidate, {}, {}", name, why);
}

// Where repeated trials tell the noise, and the validate logs show plainly more: a name that takes
// too little of it is not what is mainly wrong. Half a period late looks like a flipped sign on the
// logs that it was fitted to.
void TakeBackWhatDoesLittle(Diagnosis& d) {
  const double floor = d.noise.floor(), before = d.before.error.validate;
  if (!d.chosen() || !d.noise.known() || !(before > 0)) return;
  if (before < d.criteria.model_limited * floor) return;
  const double left = SquaresWithoutPart(d.after().validate, floor);
  const double share = std::max(0.0, 1 - left / SquaresWithoutPart(before, floor));
  if (share >= d.criteria.fold_share) return;
  TakeNameBack(d, fmt::format("takes only {:.0f} % of the squares above the noise on the logs that "
                              "are kept for validation",
                              100 * share));
}

}  // namespace

bool IsSmallerThanNoise(const Diagnosis& d, double best) {
  return best < d.criteria.near_noise &&
         IsWithinNoise(d.before.error.train, {d.noise.rms, d.noise.step});
}

void ConfirmOnFolds(const CandidateFitter& fitter, Diagnosis& d) {
  if (!d.chosen()) return;
  if (d.verdict.complete) {
    if (RaisesValidateSquares(fitter, d))
      NameNothing(d, "{} does a little better on its own logs and worse on those left out");
    return;
  }
  if (d.chosen()->record.after.empty()) return;
  const double floor = d.noise.floor();
  const double possible = std::max(0.0, 1 - floor / d.before.error.train);
  const bool held_out = HoldsOnValidateLogs(d.before.error.validate,
                                            d.chosen()->fitted.error.validate, floor, d.criteria);
  if (held_out && HoldsOnFolds(d.chosen()->record, possible, d.criteria))
    return TakeBackWhatDoesLittle(d);
  if (IsSmallerThanNoise(d, d.chosen()->fitted.over_noise())) {
    NameNothing(d,
                "what shows is smaller than noise and time step, and {} takes it off its own "
                "logs alone");
    return;
  }
  TakeNameBack(d, "does not lower the error of logs left out as it does that of its own");
}

void ConfirmOnValidateLogs(Diagnosis& d) {
  if (d.chosen() && d.before.error.validate > 0 && d.after().validate > d.before.error.validate)
    TakeNameBack(d, "raises the error of the logs that are kept for validation");
  TakeBackWhatDoesLittle(d);
}

}  // namespace continuum
