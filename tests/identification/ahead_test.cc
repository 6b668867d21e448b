#include "identification/ahead.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using testing::Pendulum;

class AheadTest : public Bench {
 protected:
  static constexpr std::size_t kRows = 200;

  // One log of a pendulum with this payload, which its model does not have.
  std::optional<Ahead> After(double payload, std::size_t rows) {
    Pendulum truth;
    truth.payload = payload;
    logs_.clear();
    const auto u = Command(1, kRows);
    AddLog("a", "use: train", u, truth.Run(u, testing::kPeriod));
    const Experiment e = ReadExperiment("");
    const Problem problem(e, System::Load(Write("model.xml", Pendulum().Xml())));
    return PredictAhead(problem, problem.Start(), rows);
  }
};

TEST_F(AheadTest, ARightModelGoesOnWithTheMotion) {
  const auto ahead = After(0, 10);
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->seconds, 10 * testing::kPeriod, 1e-9);
  EXPECT_LT(ahead->train[0], 3e-3);  // the slope through five rows is not the speed
  EXPECT_TRUE(std::isnan(ahead->validate[0]));
}

TEST_F(AheadTest, AWrongOnePartsFromItTheMoreTheLater) {
  const auto soon = After(0.1, 5), late = After(0.1, 40);
  ASSERT_TRUE(soon && late);
  EXPECT_LT(1.5 * soon->train[0], late->train[0]);
}

TEST_F(AheadTest, ALogThatIsTooShortHasNone) { EXPECT_FALSE(After(0, kRows)); }

}  // namespace
}  // namespace continuum
