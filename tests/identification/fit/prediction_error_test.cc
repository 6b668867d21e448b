#include "identification/fit/prediction_error.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using testing::Pendulum;

class AheadTest : public Bench {
 protected:
  static constexpr std::size_t kRows = 200;

  // One log of a pendulum with this payload, which its model does not have.
  std::optional<PredictionError> After(double payload, std::size_t rows) {
    Pendulum truth;
    truth.payload = payload;
    logs_.clear();
    const auto u = Command(1, kRows);
    AddLog("a", "use: train", u, truth.Run(u, testing::kPeriod));
    const Experiment e = ReadExperiment("");
    const Problem problem(e, ModelSpec::Load(Write("model.xml", Pendulum().Xml())));
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

// Of a model with this actuator and extension, on a log that it has made itself.
class AheadOfItself : public AheadTest {
 protected:
  std::optional<PredictionError> After(const std::string& actuator, const std::string& extension) {
    std::string xml = Pendulum().Xml(extension);
    const std::string servo = "<position name=\"servo\" joint=\"hinge\" kp=\"5\"/>";
    xml.replace(xml.find(servo), servo.size(), actuator.empty() ? servo : actuator);
    const ModelSpec system = ModelSpec::Load(Write("model.xml", xml));
    const auto u = Command(1, kRows);
    logs_.clear();
    AddLog("made", "use: train", u, std::vector<double>(kRows, 0));
    Experiment e = ReadExperiment("");
    e.logs[0].measured = Problem(e, system).Predict({}, 0).channel;
    const Problem problem(e, system);
    return PredictAhead(problem, problem.Start(), 10);
  }
};

TEST_F(AheadOfItself, ActuatorsGoOnFromTheActivationTheyHave) {
  const auto lagged =
      After("<position name=\"servo\" joint=\"hinge\" kp=\"5\" timeconst=\"0.3\"/>", "");
  ASSERT_TRUE(lagged);
  EXPECT_LT(lagged->train[0], 3e-3);  // as above
  const auto sums =
      After("<intvelocity name=\"servo\" joint=\"hinge\" kp=\"5\" actrange=\"-3 3\"/>", "");
  ASSERT_TRUE(sums);
  EXPECT_LT(sums->train[0], 3e-3);
}

TEST_F(AheadOfItself, DelaysAndEffectsGoOnFromWhatTheyRemember) {
  const auto late = After(
      "<position name=\"servo\" joint=\"hinge\" kp=\"5\" delay=\"0.1\" nsample=\"200\"/>", "");
  ASSERT_TRUE(late);
  EXPECT_LT(late->train[0], 3e-3);
  const auto creeps = After("",
                            "<plugin plugin=\"continuum.maxwell\"><instance name=\"creep\"><config "
                            "key=\"joint\" value=\"hinge\"/><config key=\"k_m\" value=\"8\"/>"
                            "<config key=\"tau_m\" value=\"1\"/></instance></plugin>");
  ASSERT_TRUE(creeps);
  EXPECT_LT(creeps->train[0], 3e-3);
}

TEST_F(AheadTest, ALogThatIsTooShortHasNone) { EXPECT_FALSE(After(0, kRows)); }

}  // namespace
}  // namespace continuum
