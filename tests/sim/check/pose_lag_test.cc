#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

using namespace testing;  // the bench
using ::testing::HasSubstr;

// An arm of two links that measures both angles and its tip. The model that is checked has three
// times the mass and a tenth of the damping: its motion is another one, its kinematics are right.
class CheckPoseTest : public ::testing::Test {
 protected:
  static ModelSpec Arm(double mass, double damping, double reach = 0.2) {
    const auto text = [](double x) { return std::to_string(x); };
    const std::string joint = R"(" axis="0 1 0" damping=")" + text(damping) + "\"/>";
    const std::string link =
        R"(<geom type="capsule" size=".01" fromto="0 0 0 0 0 -.2" mass=")" + text(mass) + "\"/>";
    return ModelSpec::Parse(
        R"(<mujoco><option timestep="0.002" integrator="implicitfast"/><worldbody><body>
      <joint name="a)" +
        joint + link + R"(<body pos="0 0 -.2"><joint name="b)" + joint + link +
        R"(<site name="tip" pos="0 0 -)" + text(reach) + R"("/></body></body></worldbody>
      <actuator><position name="m1" joint="a" kp="2"/><position name="m2" joint="b" kp="2"/></actuator>
      <sensor><jointpos name="qa" joint="a"/><jointpos name="qb" joint="b"/>
        <framepos name="tip" objtype="site" objname="tip"/></sensor></mujoco>)");
  }
  CheckPoseTest() {
    experiment_.inputs = {{"u1", "rad", "m1", "", false, ""}, {"u2", "rad", "m2", "", false, ""}};
    for (const auto& [column, unit, source, factor] :
         {std::tuple{"qa", "rad", "qa", 1.0}, std::tuple{"qb", "rad", "qb", 1.0},
          std::tuple{"x", "mm", "tip[0]", 1e-3}, std::tuple{"z", "mm", "tip[2]", 1e-3}}) {
      Output out;
      out.columns = {column};
      out.unit = unit;
      out.source = source;
      experiment_.channels.push_back({column, unit, experiment_.outputs.size(), 0, factor});
      experiment_.outputs.push_back(out);
    }
    Log log = Record({Sines, [](double t) { return Sines(1.3 * t + 1); }});
    log.measured.clear();
    experiment_.logs.push_back(log);
    ModelAndData real = Arm(0.2, 0.1).Build();
    log_().measured = Simulate(real, experiment_, log_()).channel;
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 5e-4);
    for (auto& channel : log_().measured) {
      for (double& value : channel) value += noise(random);
    }
  }
  Log& log_() { return experiment_.logs[0]; }
  void Delay(std::size_t channel, int rows) {
    auto& x = log_().measured[channel];
    const std::vector<double> old = x;
    for (int k = 0; k < static_cast<int>(x.size()); ++k)
      x[k] = old[std::clamp(k - rows, 0, static_cast<int>(x.size()) - 1)];
  }
  std::vector<Finding> Lags(const ModelSpec& model) const {
    std::vector<Finding> lags;
    for (const Finding& f : CheckAgainstModel(experiment_, model)) {
      if (f.what == "lag" && f.text.find("kinematics") != f.text.npos) lags.push_back(f);
    }
    return lags;
  }

  Experiment experiment_;
  const ModelSpec wrong_ = Arm(0.6, 0.01);
};

TEST_F(CheckPoseTest, AColumnShiftedByOneRowIsNamedThoughTheModelMovesOtherwise) {
  for (const std::size_t channel : {0, 1, 2, 3}) {
    for (const int rows : {1, -1, 3}) {
      const auto original = log_().measured;
      Delay(channel, rows);
      const auto lags = Lags(wrong_);
      const std::string& column = experiment_.channels[channel].name;
      ASSERT_EQ(lags.size(), 1u) << column << " by " << rows << "\n"
                                 << Report(CheckAgainstModel(experiment_, wrong_));
      EXPECT_EQ(lags[0].channel, column);
      EXPECT_THAT(lags[0].text, HasSubstr(rows > 0 ? "late against" : "ahead of"));
      EXPECT_THAT(lags[0].text, HasSubstr(rows == 3 ? "(3.0 rows)" : "(1.0 rows)"));
      log_().measured = original;
    }
  }
}

TEST_F(CheckPoseTest, ASensorThatIsLateInAllItsDirectionsIsNamedInEach) {
  Delay(2, 1), Delay(3, 1);
  const auto lags = Lags(wrong_);
  ASSERT_EQ(lags.size(), 2u) << Report(lags);
  EXPECT_EQ(lags[0].channel, "x");
  EXPECT_EQ(lags[1].channel, "z");
}

TEST_F(CheckPoseTest, NothingIsSaidOfALogWithoutShiftsOrWithAWrongLength) {
  EXPECT_TRUE(Lags(wrong_).empty()) << Report(Lags(wrong_));
  const auto lags = Lags(Arm(0.6, 0.01, 0.25));
  EXPECT_TRUE(lags.empty()) << Report(lags);
}

// Five of its ten joints are measured, the others rest; cables and friction of the model are wrong.
TEST(SnakeArm, AColumnShiftedByOneRowIsNamedInItsLogs) {
  Experiment e = Experiment::Read(CONTINUUM_SOURCE "/models/annelida/demo/annelida.yaml");
  e.logs.resize(1);
  const ModelSpec system = ModelSpec::Load(e.model);
  const auto lags = [&] {
    std::vector<Finding> lags;
    for (const Finding& f : CheckAgainstModel(e, system)) {
      if (f.what == "lag" && f.severity == Finding::Severity::kWarning) lags.push_back(f);
    }
    return lags;
  };
  EXPECT_TRUE(lags().empty()) << Report(lags());
  const auto original = e.logs[0].measured;
  for (const std::size_t channel : {0, 2, 5, 6}) {
    auto& x = e.logs[0].measured[channel];
    x.insert(x.begin(), x.front());
    x.pop_back();
    const auto found = lags();
    ASSERT_EQ(found.size(), 1u) << e.channels[channel].name << "\n" << Report(found);
    EXPECT_EQ(found[0].channel, e.channels[channel].name);
    EXPECT_THAT(found[0].text, HasSubstr("late against"));
    e.logs[0].measured = original;
  }
}

}  // namespace
}  // namespace continuum
