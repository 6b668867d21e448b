#pragma once

#include <chrono>
#include <string_view>

#include "identification/diagnosis/result.h"

namespace continuum {

/// "quick", "normal" or "thorough"; throws Error for another name.
Effort EffortNamed(std::string_view name);

/// The processor time that a diagnosis may take, and until when each of its stages may go on: what
/// begins later than that is left out, so that a verdict stands when the time is over. A stage that
/// needs less leaves more to those behind it; where one takes longer, as a single simulation may,
/// those behind it share what is left. A busy machine takes longer for the same answer.
class TimeBudget {
 public:
  /// Begins now; share: of the time of this effort.
  TimeBudget(Effort effort, double share);

  /// ProcessorSeconds until which a stage may go on that begins now, or does so once more; infinite
  /// for an effort without limit.
  double Begin(DiagnosisStage stage);
  /// The same of a part that takes at most this share of the whole.
  double BeginPart(DiagnosisStage stage, double share);
  double seconds() const;  ///< by the clock on the wall, since it began

 private:
  std::chrono::steady_clock::time_point begin_;
  double begin_processor_;  // ProcessorSeconds
  Effort effort_;
  double seconds_;    // all that there is
  double share_ = 0;  // of the time, over when the last stage that has begun is
  double end_ = 0;    // of that stage
};

}  // namespace continuum
