#include "identification/diagnosis/confirmation.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "identification/diagnosis/verdict.h"

namespace continuum {
namespace {

// As the error of a log is mostly its own offset or drift; by more than chance, what a parameter
// gains from noise.
bool RaisesValidateSquares(const CandidateFitter& fitter, const Diagnosis& d) {
  auto validate = TrainLogs(*fitter.experiment);
  validate.flip();
  const auto squares = [&](const Fitted& f) {
    return fitter.whitening.Stack(f.residuals, validate).squaredNorm();
  };
  return squares(d.chosen()->fitted) > squares(d.before) + d.criteria.parameter_cost;
}

void TakeNameBack(Diagnosis& d, const std::string& why) {
  const std::string name = d.chosen()->hypothesis.NameAtPlace();
  d.verdict.kind = Verdict::Kind::kUnexplained;
  d.verdict.leading = d.verdict.named.front();
  d.verdict.named.clear(), d.verdict.siblings.clear();
  d.partner.reset();
  d.verdict.reason = fmt::format("the best candidate, {}, {}", name, why);
}

}  // namespace

void ConfirmOnFolds(const CandidateFitter& fitter, Diagnosis& d) {
  if (!d.chosen()) return;
  if (d.verdict.complete) {
    if (!RaisesValidateSquares(fitter, d)) return;
    const std::string name = d.chosen()->hypothesis.NameAtPlace();
    d.verdict = Verdict::Adequate(
        fmt::format("{} does a little better on its own logs and worse on those left out", name));
    d.partner.reset();
    return;
  }
  if (d.chosen()->record.after.empty()) return;
  const double floor = d.noise.floor();
  const double possible = std::max(0.0, 1 - floor / d.before.error.train);
  const bool held_out = HoldsOnValidateLogs(d.before.error.validate,
                                            d.chosen()->fitted.error.validate, floor, d.criteria);
  if (held_out && HoldsOnFolds(d.chosen()->record, possible, d.criteria)) return;
  TakeNameBack(d, "does not lower the error of logs left out as it does that of its own");
}

void ConfirmOnValidateLogs(Diagnosis& d) {
  if (d.chosen() && d.before.error.validate > 0 && d.after().validate > d.before.error.validate)
    TakeNameBack(d, "raises the error of the logs that are kept for validation");
}

}  // namespace continuum
