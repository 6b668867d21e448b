#include "identification/diagnosis/effort.h"

#include <cmath>
#include <limits>
#include <string>

#include "error.h"
#include "sim/numerics/parallel.h"

namespace continuum {
namespace {

// [s] of processors. Two of them, which share the work by three quarters, take less than 10 s and
// 60 s, with reports and the last fit of a stage on top.
double SecondsOf(Effort effort) {
  switch (effort) {
    case Effort::kQuick:
      return 12;
    case Effort::kNormal:
      return 75;
    case Effort::kThorough:
      break;
  }
  return std::numeric_limits<double>::infinity();
}

// Of the whole time, from the beginning.
double ShareAtEndOf(DiagnosisStage stage) {
  switch (stage) {
    case DiagnosisStage::kNullFit:
      return 0.2;
    case DiagnosisStage::kScreen:
      return 0.4;
    case DiagnosisStage::kFits:
      return 0.58;
    case DiagnosisStage::kOtherCandidates:
      return 0.65;
    case DiagnosisStage::kSecondCause:
      return 0.85;
    case DiagnosisStage::kJudgement:
      return 0.97;
    default:
      return 1;
  }
}

}  // namespace

Effort EffortNamed(std::string_view name) {
  if (name == "quick") return Effort::kQuick;
  if (name == "normal") return Effort::kNormal;
  if (name == "thorough") return Effort::kThorough;
  throw Error::Input("effort", "quick, normal or thorough", "'" + std::string(name) + "'");
}

TimeBudget::TimeBudget(Effort effort)
    : begin_(std::chrono::steady_clock::now()),
      begin_processor_(ProcessorSeconds()),
      limit_(SecondsOf(effort)) {}

double TimeBudget::EndOf(DiagnosisStage stage) const {
  return begin_processor_ + ShareAtEndOf(stage) * limit_;
}

double TimeBudget::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

}  // namespace continuum
