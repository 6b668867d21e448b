#pragma once

#include <chrono>
#include <string_view>

#include "identification/diagnosis/result.h"

namespace continuum {

/// "quick", "normal" or "thorough"; throws Error for another name.
Effort EffortNamed(std::string_view name);

/// The time that a diagnosis may take, and until when each of its stages may go on: what begins
/// later than that is left out, so that a verdict stands when the time is over. A stage that needs
/// less leaves more to those behind it.
class TimeBudget {
 public:
  using Clock = std::chrono::steady_clock;

  /// Begins now.
  explicit TimeBudget(Effort effort);

  /// Until when a stage may go on; the largest time there is for an effort without limit.
  Clock::time_point EndOf(DiagnosisStage stage) const;
  double seconds() const;  ///< since it began

 private:
  Clock::time_point begin_;
  double seconds_;  // in all; infinite: no limit
};

}  // namespace continuum
