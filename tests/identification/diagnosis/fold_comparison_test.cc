#include "identification/diagnosis/fold_comparison.h"

#include <gtest/gtest.h>

#include "support/pendulum.h"

namespace continuum {
namespace {

class Scatter : public testing::Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    AddLog("t0", "trial: t0, use: train", {0, 0}, {0, 0});
    experiment_ = ReadExperiment("");
  }
  Diagnosis With(TwoErrors error, const std::string& source) {
    Diagnosis d(experiment_, ModelSpec::Load(Write("model.xml", testing::Pendulum().Xml())));
    d.noise.rms = 1e-3, d.noise.source = source;
    d.before.error = error;
    return d;
  }

 private:
  Experiment experiment_;
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
