#include "identification/diagnosis/fold_comparison.h"

#include <gtest/gtest.h>

#include "support/bare_diagnosis.h"

namespace continuum {
namespace {

class Scatter : public testing::BareDiagnosis {
 protected:
  Diagnosis With(TwoErrors error, const std::string& source) {
    Diagnosis d = Bare();
    d.noise.rms = 1e-3, d.noise.source = source;
    d.before.error = error;
    return d;
  }
};

TEST_F(Scatter, IsExceededByTheLargerOfTheErrors) {
  EXPECT_DOUBLE_EQ(OverScatter(With({2e-3, 0}, "differences")), 2);
  EXPECT_DOUBLE_EQ(OverScatter(With({2e-3, 3e-2}, "differences")), 30);
}

TEST_F(Scatter, SaysNothingWhereNoiseIsKnownBetter) {
  EXPECT_EQ(OverScatter(With({2e-3, 3e-2}, "replicates")), 0);
}

}  // namespace
}  // namespace continuum
