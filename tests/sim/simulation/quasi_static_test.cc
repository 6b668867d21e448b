#include "sim/simulation/quasi_static.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "support/long_test.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;
using Values = std::vector<double>;

class QuasiStatic : public ::testing::Test {
 protected:
  struct Trial {
    Experiment experiment;
    ModelAndData machine;
    const Log& log() const { return experiment.logs[0]; }
  };

  // Inputs [m or N] one a row, period s apart; every joint's position is an output.
  Trial Read(const std::string& model, const Values& u, const std::vector<std::string>& joints,
             double period = 1, const std::string& start = "rest") const {
    scratch_.Write("m.xml",
                   "<mujoco><option timestep=\"0.001\" integrator=\"implicitfast\" "
                   "gravity=\"0 0 0\"/>" +
                       model + "</mujoco>");
    std::string log = "time,u", outputs;
    for (const auto& joint : joints) {
      log += "," + joint;
      outputs += fmt::format("{}{{column: {}, unit: m, sensor: {}}}", outputs.empty() ? "" : ", ",
                             joint, joint);
    }
    for (std::size_t k = 0; k < u.size(); ++k) {
      log += fmt::format("\n{},{}", static_cast<double>(k) * period, u[k]);
      for (std::size_t j = 0; j < joints.size(); ++j) log += ",0";
    }
    scratch_.Write("log.csv", log + "\n");
    Trial trial;
    trial.experiment = Experiment::Read(scratch_.Write(
        "e.yaml", "format: 1\nmodel: m.xml\nstart: " + start +
                      "\nquasi_static: true\ninputs: [{column: u, actuator: a}]\noutputs: [" +
                      outputs + "]\nlogs: [{file: log.csv}]\n"));
    trial.machine = ModelSpec::Load(trial.experiment.model).Build();
    return trial;
  }
  static Trace Run(Trial& trial, const QuasiStaticOptions& pace = {}) {
    return SimulateAtRest(trial.machine, trial.experiment, trial.log(), {}, {}, pace);
  }

  static std::string Coulomb(const std::string& name, const std::string& joint, double level) {
    return fmt::format(
        "<instance name=\"{}\"><config key=\"joint\" value=\"{}\"/><config key=\"tau_c\" "
        "value=\"{}\"/></instance>",
        name, joint, level);
  }
  // A mass on a servo of 100 N/m, with dry friction of 3 N; almost undamped, 1.6 Hz.
  static std::string Play() {
    return "<extension><plugin plugin=\"continuum.coulomb\">" + Coulomb("f", "x", 3) +
           R"(</plugin></extension>
           <worldbody><body><joint name="x" type="slide" axis="1 0 0"/><geom size=".1" mass="1"/></body></worldbody>
           <actuator><position name="a" joint="x" kp="100"/></actuator>
           <sensor><jointpos name="x" joint="x"/></sensor>)";
  }
  // A second mass behind a spring of 50 N/m, both rub.
  static std::string Chain() {
    return "<extension><plugin plugin=\"continuum.coulomb\">" + Coulomb("f1", "x", 1) +
           Coulomb("f2", "y", 0.7) + R"(</plugin></extension>
           <worldbody>
             <body><joint name="x" type="slide" axis="1 0 0"/><geom size=".1" mass="1"/></body>
             <body pos="1 0 0"><joint name="y" type="slide" axis="1 0 0"/><geom size=".1" mass=".3"/></body>
           </worldbody>
           <tendon><fixed name="spring" stiffness="50"><joint joint="x" coef="-1"/><joint joint="y" coef="1"/></fixed></tendon>
           <actuator><position name="a" joint="x" kp="100"/></actuator>
           <sensor><jointpos name="x" joint="x"/><jointpos name="y" joint="y"/></sensor>)";
  }
  // Links of a milligram one on the other, each on a spring of 3 N/m with 3 N s/m and dry friction.
  static std::string LightLinks(int count) {
    std::string rubs, bodies, ends;
    for (int i = 0; i < count; ++i) {
      rubs += Coulomb(fmt::format("f{}", i), fmt::format("x{}", i), 0.1);
      bodies += fmt::format(
          "<body pos=\"0 0 .05\"><joint name=\"x{}\" type=\"slide\" axis=\"1 0 0\" "
          "stiffness=\"3\" damping=\"3\"/><inertial pos=\"0 0 0\" mass=\"1e-6\" "
          "diaginertia=\"1e-6 1e-6 1e-6\"/>",
          i);
      ends += "</body>";
    }
    return "<extension><plugin plugin=\"continuum.coulomb\">" + rubs +
           "</plugin></extension><worldbody>" + bodies + ends +
           R"(</worldbody>
           <actuator><position name="a" joint="x0" kp="10"/></actuator>
           <sensor><jointpos name="x0" joint="x0"/></sensor>)";
  }

  testing::Scratch scratch_;
};

const Values kWay{0.02, 0.1, 0.08, 0.05, 0.2, 0.19, 0.15, 0.1, 0.16, -0.1, -0.1, 0, 0.04, 0.01};

TEST_F(QuasiStatic, AMassWithFrictionFollowsThePlayOperator) {
  auto trial = Read(Play(), kWay, {"x"});
  QuasiStaticOptions by_motion;
  by_motion.search = false;
  const Trace trace = Run(trial, by_motion);
  ASSERT_FALSE(trace.diverged) << trace.why;
  double x = 0;
  for (std::size_t k = 0; k < kWay.size(); ++k) {
    x = std::clamp(x, kWay[k] - 0.03, kWay[k] + 0.03);  // 3 N / 100 N/m
    // At rest |2 τ v| + |τ² a| leave 3e-6 m at most; the friction row itself gives way by 2e-6 m.
    EXPECT_NEAR(trace.channel[0][k], x, 5e-6) << "row " << k;
  }
}

// Rate-independent by construction: the inputs move in 20000 small steps, in each of which the
// masses slide one after the other until both are within their friction.
std::pair<Values, Values> ChainByIncrements(const Values& way) {
  double u = 0, x = 0, y = 0;
  Values xs, ys;
  for (const double target : way) {
    constexpr int kIncrements = 20000;
    const double from = u;
    for (int i = 1; i <= kIncrements; ++i) {
      u = from + (target - from) * i / kIncrements;
      for (int sweep = 0; sweep < 50; ++sweep) {
        // (100 + 50) x balances 100 u + 50 y within 1 N; 50 y balances 50 x within 0.7 N.
        const double centre = (100 * u + 50 * y) / 150;
        x = std::clamp(x, centre - 1.0 / 150, centre + 1.0 / 150);
        y = std::clamp(y, x - 0.7 / 50, x + 0.7 / 50);
      }
    }
    xs.push_back(x), ys.push_back(y);
  }
  return {xs, ys};
}

TEST_F(QuasiStatic, TwoMassesKeepTheFrictionOfTheWayTheyCame) {
  auto trial = Read(Chain(), kWay, {"x", "y"});
  const Trace trace = Run(trial);
  ASSERT_FALSE(trace.diverged) << trace.why;
  const auto [x, y] = ChainByIncrements(kWay);
  for (std::size_t k = 0; k < kWay.size(); ++k) {
    EXPECT_NEAR(trace.channel[0][k], x[k], 1e-5) << "row " << k;
    EXPECT_NEAR(trace.channel[1][k], y[k], 1e-5) << "row " << k;
  }
}

TEST_F(QuasiStatic, HalvingTheSpeedDoesNotMoveTheAnswer) {
  auto trial = Read(Chain(), kWay, {"x", "y"});
  QuasiStaticOptions slow;
  slow.search = false;
  const Trace usual = Run(trial, slow);
  slow.crossing_time *= 2;
  const Trace half = Run(trial, slow);
  for (std::size_t k = 0; k < kWay.size(); ++k) {
    for (std::size_t c = 0; c < 2; ++c)
      EXPECT_NEAR(usual.channel[c][k], half.channel[c][k], 1e-5) << "row " << k;
  }
}

TEST_F(QuasiStatic, RestIsFoundWhereMotionLeads) {
  auto trial = Read(Chain(), kWay, {"x", "y"});
  QuasiStaticOptions by_motion;
  by_motion.search = false;
  const Trace found = Run(trial), moved = Run(trial, by_motion);
  ASSERT_FALSE(found.diverged || moved.diverged);
  for (std::size_t k = 0; k < kWay.size(); ++k) {
    for (std::size_t c = 0; c < 2; ++c)
      EXPECT_NEAR(found.channel[c][k], moved.channel[c][k], 1e-5) << "row " << k;
  }
}

// Also where the servo pulls by what friction just holds (row 2), and motion creeps.
TEST_F(QuasiStatic, RestOfLightLinksIsFoundExactly) {
  auto trial = Read(LightLinks(24), kWay, {"x0"});
  const Trace trace = Run(trial);
  ASSERT_FALSE(trace.diverged) << trace.why;
  double x = 0;
  for (std::size_t k = 0; k < kWay.size(); ++k) {
    x = std::clamp(x, (10 * kWay[k] - 0.1) / 13, (10 * kWay[k] + 0.1) / 13);
    EXPECT_NEAR(trace.channel[0][k], x, 1e-9) << "row " << k;
  }
}

TEST_F(QuasiStatic, TheTimesOfTheRowsAreOfNoAccount) {
  auto trial = Read(Chain(), kWay, {"x", "y"});
  const Trace slow = Run(trial);
  auto quick = Read(Chain(), kWay, {"x", "y"}, 1e-3);
  EXPECT_EQ(Run(quick).channel, slow.channel);
}

// A cable over a fixed corner of 90 degrees pulls a slider on a spring of 200 N/m.
TEST_F(QuasiStatic, ACableHoldsWhatItsCornerHolds) {
  constexpr double kMu = 0.3;
  const std::string model =
      "<extension><plugin plugin=\"continuum.capstan\"><instance name=\"c\"><config key=\"tendon\" "
      "value=\"cable\"/><config key=\"mu\" value=\"0.3\"/></instance></plugin></extension>" +
      std::string(R"(<worldbody>
        <site name="s0" pos="0 0 -1"/><site name="s1" pos="0 0 0"/>
        <body pos="1 0 0"><joint name="x" type="slide" axis="1 0 0" stiffness="200"/>
          <geom size=".05" mass=".5"/><site name="s2"/></body></worldbody>
      <tendon><spatial name="cable"><site site="s0"/><site site="s1"/><site site="s2"/></spatial></tendon>
      <actuator><motor name="a" tendon="cable" gear="-1"/></actuator>
      <sensor><jointpos name="x" joint="x"/></sensor>)");
  const Values pull{5, 10, 20, 18, 12, 8, 5, 5.5, 8, 15, 30, 3};
  auto trial = Read(model, pull, {"x"});
  const Trace trace = Run(trial);
  ASSERT_FALSE(trace.diverged) << trace.why;
  const double ratio = std::exp(kMu * M_PI / 2);
  double tension = 0;
  for (std::size_t k = 0; k < pull.size(); ++k) {
    tension = std::clamp(tension, pull[k] / ratio, pull[k] * ratio);
    // A corner at rest gives way by 0.1 mm before it slides (its contact is a stiff spring).
    EXPECT_NEAR(trace.channel[0][k], -tension / 200, 2e-4) << "row " << k;
  }
}

TEST_F(QuasiStatic, FrictionOfLinksThatWeighNothingLetsThemRest) {
  CONTINUUM_LONG_IF_SANITIZED("many states at rest");
  auto trial = Read(LightLinks(24), {0.5, 0.1}, {"x0"});
  QuasiStaticOptions by_motion;
  by_motion.search = false;
  const Trace trace = Run(trial, by_motion);
  ASSERT_FALSE(trace.diverged) << trace.why;
  EXPECT_NEAR(trace.channel[0][0], (10 * 0.5 - 0.1) / 13, 1e-4);  // kp u − τ_c over all stiffness
  EXPECT_NEAR(trace.channel[0][1], (10 * 0.1 + 0.1) / 13, 1e-4);
}

TEST_F(QuasiStatic, ARowWithoutRestIsNamed) {
  const std::string model = "<extension><plugin plugin=\"continuum.coulomb\">" +
                            Coulomb("f", "x", 3) +
                            R"(</plugin></extension>
      <worldbody><body><joint name="x" type="slide" axis="1 0 0"/><geom size=".1" mass="1"/></body></worldbody>
      <actuator><motor name="a" joint="x"/></actuator><sensor><jointpos name="x" joint="x"/></sensor>)";
  auto trial = Read(model, {1, 2, 4, 2}, {"x"});
  QuasiStaticOptions pace;
  pace.crossing_time = pace.longest_wait =
      1;  // nothing holds the mass: its slowest mode is the longest that counts, 5 s
  const Trace trace = Run(trial, pace);
  EXPECT_TRUE(trace.diverged);
  EXPECT_EQ(trace.diverged_at, 2);
  EXPECT_THAT(trace.why, HasSubstr("no rest at row 3 of 4 (2 s): joint 'x' still moves at"));
  EXPECT_NEAR(trace.channel[0][1], 0, 1e-5);
  EXPECT_TRUE(std::isnan(trace.channel[0][2]));
}

TEST_F(QuasiStatic, AnEffectThatCreepsIsRefused) {
  const std::string model =
      "<extension><plugin plugin=\"continuum.maxwell\"><instance name=\"creep\"><config "
      "key=\"joint\" value=\"x\"/><config key=\"k_m\" value=\"5\"/></instance></plugin></extension>"
      R"(<worldbody><body><joint name="x" type="slide" axis="1 0 0"/><geom size=".1" mass="1"/></body></worldbody>
      <actuator><position name="a" joint="x" kp="100"/></actuator><sensor><jointpos name="x" joint="x"/></sensor>)";
  auto trial = Read(model, {1, 2}, {"x"});
  try {
    Run(trial);
    FAIL() << "nothing was said";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("continuum.maxwell 'creep'"));
    EXPECT_THAT(error.what(), HasSubstr("quasi_static"));
  }
}

}  // namespace
}  // namespace continuum
