#include "identification/diagnosis/effort.h"

#include <cmath>
#include <limits>
#include <string>

#include "error.h"

namespace continuum {
namespace {

// Less than what is promised (10 s, 60 s): reports and the last fit of a stage come on top.
double SecondsOf(Effort effort) {
  switch (effort) {
    case Effort::kQuick:
      return 8;
    case Effort::kNormal:
      return 50;
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
      return 0.55;
    case DiagnosisStage::kOtherCandidates:
      return 0.65;
    case DiagnosisStage::kSecondCause:
      return 0.85;
    case DiagnosisStage::kJudgement:
      return 0.95;
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

TimeBudget::TimeBudget(Effort effort) : begin_(Clock::now()), seconds_(SecondsOf(effort)) {}

TimeBudget::Clock::time_point TimeBudget::EndOf(DiagnosisStage stage) const {
  if (std::isinf(seconds_)) return Clock::time_point::max();
  const std::chrono::duration<double> after(ShareAtEndOf(stage) * seconds_);
  return begin_ + std::chrono::duration_cast<Clock::duration>(after);
}

double TimeBudget::seconds() const {
  return std::chrono::duration<double>(Clock::now() - begin_).count();
}

}  // namespace continuum
