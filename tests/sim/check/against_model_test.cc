#include <algorithm>
#include <cmath>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

using namespace testing;  // the bench
using ::testing::HasSubstr;

// Two pendulums on their own servos; what the model simulates is taken for measured.
class CheckModel : public ::testing::Test {
 protected:
  void SetUp() override {
    system_.emplace(ModelSpec::Parse(R"(<mujoco><option timestep="0.002" integrator="implicitfast"/>
      <worldbody>
        <body><joint name="a" axis="0 1 0" damping="0.02"/><geom type="capsule" size=".01" fromto="0 0 0 0 0 -.2" mass=".3"/></body>
        <body pos="1 0 0"><joint name="b" axis="0 1 0" damping="0.05"/><geom type="capsule" size=".01" fromto="0 0 0 0 0 -.3" mass=".4"/></body>
      </worldbody>
      <actuator><position name="m1" joint="a" kp="1"/><position name="m2" joint="b" kp="3"/></actuator>
      <sensor><jointpos name="q1" joint="a"/><jointvel name="v1" joint="a"/><jointpos name="q2" joint="b"/></sensor>
    </mujoco>)"));
    RecordFrom({});
  }

  // What the model does, with noise, is what was measured.
  void RecordFrom(const Recipe& recipe) {
    experiment_ = With(Record(recipe));
    ModelAndData machine = system_->Build();
    log().measured = Simulate(machine, experiment_, log()).channel;
    std::mt19937 random(recipe.seed);
    std::normal_distribution<double> noise(0, 5e-4);
    for (auto& channel : log().measured) {
      for (double& value : channel) value += noise(random);
    }
  }
  Log& log() { return experiment_.logs[0]; }
  std::vector<Finding> Bad() const {
    return continuum::Bad(CheckAgainstModel(experiment_, *system_));
  }
  void ExpectOnly(const std::string& what, const std::string& channel) const {
    const auto bad = Bad();
    ASSERT_EQ(bad.size(), 1u) << Report(bad);
    EXPECT_EQ(bad[0].what, what) << Report(bad);
    EXPECT_EQ(bad[0].channel, channel) << Report(bad);
  }

  std::optional<ModelSpec> system_;
  Experiment experiment_;
};

TEST_F(CheckModel, ACleanLogGivesNoWarning) { EXPECT_TRUE(Bad().empty()) << Report(Bad()); }

TEST_F(CheckModel, TwentyRandomCleanLogsGiveNoWarning) {
  std::mt19937 random(13);
  for (unsigned trial = 0; trial < 20; ++trial) {
    Recipe recipe{RandomCommand(random), RandomCommand(random)};
    recipe.rows = 600;
    recipe.seed = trial;
    RecordFrom(recipe);
    EXPECT_TRUE(Bad().empty()) << "log " << trial << "\n" << Report(Bad());
  }
}

TEST_F(CheckModel, AModelWithWrongDampingAndMassIsNoDefectOfTheLog) {
  const Change changes[]{{"joint:a", "damping", 0.03}, {"joint:b", "damping", 0.03}};
  experiment_.logs[0].set.assign(std::begin(changes), std::end(changes));
  EXPECT_TRUE(Bad().empty()) << Report(Bad());
}

TEST_F(CheckModel, MillimetresForMetresAndDegreesForRadiansAreNamed) {
  for (double& q : Column(log(), "q2")) q *= 1000;
  ExpectOnly("unit_suspect", "q2");
  for (double& q : Column(log(), "q2")) q *= 1e-3 / kDegree;
  ExpectOnly("unit_suspect", "q2");
}

TEST_F(CheckModel, AWrongSignIsNamed) {
  for (double& q : Column(log(), "q2")) q = -q;
  // With one output per input, a wrong sign of either looks the same: both are told.
  const auto bad = Bad();
  EXPECT_NE(Find(bad, "sign_suspect", "q2"), nullptr) << Report(bad);
  EXPECT_EQ(Find(bad, "sign_suspect", "q1"), nullptr) << Report(bad);
}

TEST_F(CheckModel, SwappedColumnsAreNamed) {
  std::swap(Column(log(), "q1"), Column(log(), "q2"));
  const auto bad = Bad();
  const Finding* const f = Find(bad, "swapped", "q1");
  ASSERT_NE(f, nullptr) << Report(bad);
  EXPECT_THAT(f->text, HasSubstr("'q1' and 'q2' look swapped"));
}

TEST_F(CheckModel, SwappedInputsAreNamed) {
  std::swap(log().input[0], log().input[1]);
  EXPECT_NE(Find(Bad(), "swapped", "u1"), nullptr) << Report(Bad());
}

TEST_F(CheckModel, AnInputInAnotherUnitOrSignIsNamed) {
  const auto original = log().input[1];
  for (double& u : log().input[1]) u /= kDegree;
  EXPECT_NE(Find(Bad(), "unit_suspect", "u2"), nullptr) << Report(Bad());
  log().input[1] = original;
  for (double& u : log().input[1]) u = -u;
  EXPECT_NE(Find(Bad(), "sign_suspect", "u2"), nullptr) << Report(Bad());
}

TEST_F(CheckModel, AMistakeInAllInputsIsNamedOnce) {
  for (auto& input : log().input) {
    for (double& u : input) u *= 1e-3;
  }
  const auto bad = Bad();
  const Finding* const f = Find(bad, "unit_suspect");
  ASSERT_NE(f, nullptr) << Report(bad);
  EXPECT_THAT(f->text, HasSubstr("every input in rad is in thousands of its unit"));
}

TEST_F(CheckModel, AColumnOfSomethingElseIsUnlike) {
  Column(log(), "q2") = Column(log(), "v1");
  EXPECT_THAT(Find(Bad(), "unlike", "q2")->text, HasSubstr("does not follow the simulation"));
}

TEST_F(CheckModel, AnInputBeyondTheRangeOfItsActuatorIsNamed) {
  const Change range[]{{"actuator:m2", "ctrlrange[0]", -1.5}, {"actuator:m2", "ctrlrange[1]", 1}};
  system_.emplace(system_->With(range, {}));
  RecordFrom({});
  const auto bad = Bad();
  const Finding* const f = Find(bad, "out_of_range", "u2");
  ASSERT_NE(f, nullptr) << Report(bad);
  EXPECT_THAT(f->text, HasSubstr("actuator 'm2', -1.5 to 1 rad, in "));
}

TEST_F(CheckModel, AMistakeInAnInputThatMovesLateInALongLogIsNamed) {
  Recipe recipe;
  recipe.rows = 12000;
  recipe.u2 = [](double t) { return t < 9 ? 0 : 0.5 * std::sin(4 * (t - 9)); };
  RecordFrom(recipe);
  experiment_.start = Experiment::Start::kEquilibrium;
  for (double& u : log().input[1]) u = -u;
  EXPECT_NE(Find(Bad(), "sign_suspect", "u2"), nullptr) << Report(Bad());
}

TEST_F(CheckModel, AColumnShiftedByOneRowIsNamed) {
  auto& q = Column(log(), "q2");
  q.insert(q.begin(), q.front());
  q.pop_back();
  ExpectOnly("lag", "q2");
  EXPECT_THAT(Bad()[0].text, HasSubstr("late against the simulation by 10"));
}

TEST_F(CheckModel, AClockShiftOfAllOutputsIsNamed) {
  for (auto& q : log().measured) {
    q.insert(q.begin(), 4, q.front());
    q.resize(log().rows());
  }
  ExpectOnly("clock_shift", "");
}

TEST_F(CheckModel, AnOffsetAtRestIsNamed) {
  RecordFrom({Steps, [](double t) { return t < 5 ? 0.5 * Steps(t) : 0.1; }});
  for (double& q : Column(log(), "q1")) q += 0.1;
  ExpectOnly("offset_at_rest", "q1");
}

TEST_F(CheckModel, ASimulationThatDivergesIsTold) {
  log().set.push_back({"joint:a", "stiffness", -1e9});
  log().set.push_back({"joint:a", "damping", 0});
  EXPECT_NE(Find(Bad(), "diverged"), nullptr) << Report(Bad());
}

// Bounds that are meant otherwise, or that the model does not have.
TEST_F(CheckModel, AnglesInDegreesAndInertiasThatNoBodyHasAreNamed) {
  system_.emplace(ModelSpec::Parse(R"(<mujoco><option timestep="0.002" integrator="implicitfast"/>
      <worldbody><body name="a"><joint name="a" axis="0 1 0" damping=".02"/>
        <inertial pos="0 0 -.1" mass=".3" diaginertia="2e-3 3e-3 4e-3"/></body>
        <body pos="1 0 0"><joint name="b" axis="0 1 0" damping=".05"/><geom size=".1"/></body></worldbody>
      <actuator><position name="m1" joint="a" kp="1"/><position name="m2" joint="b" kp="3"/></actuator>
      <sensor><jointpos name="q1" joint="a"/><jointvel name="v1" joint="a"/><jointpos name="q2" joint="b"/></sensor>
    </mujoco>)"));
  const auto bounds = [&](const char* target, const char* attribute, double lower, double upper) {
    Parameter p;
    p.name = "p", p.target = target, p.attribute = attribute;
    p.lower = lower, p.upper = upper;
    experiment_.parameters = {p};
    return CheckAgainstModel(experiment_, *system_);
  };
  const auto degrees = bounds("joint:*", "springref", -90, 60);
  ASSERT_NE(Find(degrees, "unit_suspect"), nullptr) << Report(degrees);
  EXPECT_THAT(
      Find(degrees, "unit_suspect")->text,
      HasSubstr("-90 rad are -5157 degrees; are these degrees? -90 degrees are -1.571 rad"));
  EXPECT_EQ(Find(bounds("joint:a", "springref", -1.5, 1.5), "unit_suspect"), nullptr);
  EXPECT_EQ(Find(bounds("joint:a", "damping", 0, 90), "unit_suspect"), nullptr);

  const auto all = bounds("body:a", "inertia[2]", 2e-3, 6e-3);
  ASSERT_NE(Find(all, "inertia_limit"), nullptr) << Report(all);
  EXPECT_THAT(Find(all, "inertia_limit")->text, HasSubstr("between 0.001 and 0.005 kg*m^2"));
  EXPECT_EQ(Find(bounds("body:a", "inertia[2]", 2e-3, 4.9e-3), "inertia_limit"), nullptr);
}

// A joint's place is known up to where the body stands that it moves.
TEST_F(CheckModel, AParameterThatChangesNoOutputIsNamed) {
  system_.emplace(ModelSpec::Parse(R"(<mujoco><option timestep="0.002" integrator="implicitfast"/>
      <worldbody><body name="cart" pos="0.1 0 0"><joint name="a" type="slide" axis="1 0 0" damping="3"/>
        <geom size=".01" mass=".3"/></body>
        <body name="b" pos="0 1 0"><joint name="b" type="slide" axis="1 0 0" damping="3"/>
        <geom size=".01" mass=".4"/></body></worldbody>
      <actuator><position name="m1" joint="a" kp="20"/><position name="m2" joint="b" kp="20"/></actuator>
      <sensor><jointpos name="q1" joint="a"/><jointvel name="v1" joint="a"/><jointpos name="q2" joint="b"/></sensor>
    </mujoco>)"));
  for (std::size_t c = 0; c < experiment_.outputs.size(); ++c) {
    experiment_.outputs[c].unit = experiment_.channels[c].unit = c == 1 ? "m/s" : "m";
  }
  RecordFrom({});
  const auto parameter = [](const char* name, const char* target, const char* attribute) {
    Parameter p;
    p.name = name, p.target = target, p.attribute = attribute;
    p.initial = 0.1, p.upper = 1, p.has_initial = true;
    return p;
  };
  experiment_.parameters = {parameter("x", "body:cart", "pos[0]"),
                            parameter("b", "joint:a", "damping")};
  experiment_.parameters[1].upper = 10;
  const auto all = CheckAgainstModel(experiment_, *system_);
  const Finding* const found = Find(all, "no_effect");
  ASSERT_NE(found, nullptr) << Report(all);
  EXPECT_THAT(found->text, HasSubstr("parameter 'x' (body:cart pos[0]) changes no output"));
  EXPECT_THAT(found->text, HasSubstr("a slide joint of body 'cart' moves along it"));
  EXPECT_EQ(std::count_if(all.begin(), all.end(), [](auto& f) { return f.what == "no_effect"; }),
            1);
  experiment_.parameters[0].frozen = true;
  EXPECT_EQ(Find(CheckAgainstModel(experiment_, *system_), "no_effect"), nullptr);
}

}  // namespace
}  // namespace continuum
