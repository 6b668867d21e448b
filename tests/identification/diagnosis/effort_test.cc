#include "identification/diagnosis/effort.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/numerics/parallel.h"

namespace continuum {
namespace {

constexpr DiagnosisStage kStages[] = {
    DiagnosisStage::kNullFit,     DiagnosisStage::kScreen,
    DiagnosisStage::kFits,        DiagnosisStage::kOtherCandidates,
    DiagnosisStage::kSecondCause, DiagnosisStage::kJudgement,
    DiagnosisStage::kGain};

TEST(TimeBudget, StagesEndOneAfterTheOther) {
  TimeBudget time(Effort::kQuick, 1);
  const double begin = ProcessorSeconds();
  double before = begin;
  for (const DiagnosisStage stage : kStages) {
    const double end = time.Begin(stage);
    EXPECT_GT(end, before);
    EXPECT_EQ(time.Begin(stage), end);  // it goes on
    before = end;
  }
  EXPECT_NEAR(before - begin, 14, 0.1);
}

// The first stage should be over after 2.8 of 14 s, and begins at 3 s: it has a fifth of the rest.
TEST(TimeBudget, WhoeverIsLateSharesWhatIsLeft) {
  TimeBudget time(Effort::kQuick, 1);
  const double begin = ProcessorSeconds();
  double sum = 0;
  while (ProcessorSeconds() < begin + 3) sum += std::sqrt(sum + 1);
  EXPECT_GT(sum, 0);
  EXPECT_NEAR(time.Begin(DiagnosisStage::kNullFit) - begin, 3 + 0.2 * 11, 0.1);
  EXPECT_NEAR(time.BeginPart(DiagnosisStage::kNullFit, 0.1) - begin, 3 + 0.1 * 14, 0.1);
}

TEST(TimeBudget, ThoroughHasNoEnd) {
  TimeBudget time(Effort::kThorough, 1);
  for (const DiagnosisStage stage : kStages) EXPECT_TRUE(std::isinf(time.Begin(stage)));
}

}  // namespace
}  // namespace continuum
