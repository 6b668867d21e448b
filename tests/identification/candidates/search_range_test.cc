#include "identification/candidates/search_range.h"

#include <cmath>

#include <gtest/gtest.h>

#include "binding/effect_catalog.h"
#include "identification/candidates/candidate_generator.h"

namespace continuum {
namespace {

TEST(SearchRange, ALoadMayBeFiveTimesTheWholeRobotHoweverLightItsLinks) {
  Sizes sizes;
  sizes.mass = 0.008, sizes.robot = 0.08, sizes.torque = 0.01;
  const Param& mass = EffectNamed("payload").params.front();
  const Parameter p =
      CandidateParameter(mass, Place::kBody, sizes, "body:tip", "mass", Change::Operation::kSet);
  EXPECT_DOUBLE_EQ(p.upper, 0.4);
  EXPECT_DOUBLE_EQ(p.initial, 0.05 * sizes.mass);
}

// A model that declares no mass says nothing of what its machine carries; its motor does.
TEST(SearchRange, ALoadMayBeFiveTimesWhatTheForcesLift) {
  Sizes sizes;
  sizes.mass = sizes.robot = 1e-3, sizes.torque = 0.5, sizes.lever = 0.1;
  const Param& mass = EffectNamed("payload").params.front();
  const Parameter p =
      CandidateParameter(mass, Place::kBody, sizes, "body:tip", "mass", Change::Operation::kSet);
  EXPECT_DOUBLE_EQ(p.upper, 5 * 0.5 / (9.81 * 0.1));
}

TEST(SearchRange, WidensWhatAFitHasReachedAsFarAsTheLawAllows) {
  const std::vector<Param> law{{"k", "N*m/rad", 0, kInfinity, 0, 0}, {"share", "1", 0, 1, 0, 0}};
  std::vector<Parameter> extra(2);
  extra[0].name = "k", extra[0].upper = 2;
  extra[1].name = "share", extra[1].upper = 0.5;
  const std::vector<double> null{0, 0};
  EXPECT_FALSE(Widen(extra, null, law, std::vector<double>{1.9, 0.4}));
  EXPECT_TRUE(Widen(extra, null, law, std::vector<double>{2, 0.5}));
  EXPECT_EQ(extra[0].upper, 20);
  EXPECT_EQ(extra[1].upper, 1);  // all of it
  EXPECT_FALSE(Widen(extra, null, law, std::vector<double>{2, 1}));
}

TEST(SearchRange, AFactorStaysWithinTen) {
  const std::vector<Param> law{{"scale", "1", 0, kInfinity, 1, 1}};
  std::vector<Parameter> extra(1);
  extra[0].name = "scale", extra[0].lower = 0.1, extra[0].upper = 10;
  EXPECT_FALSE(Widen(extra, {1}, law, std::vector<double>{10}));
}

TEST(SearchRange, ALawWithAShapeOfItsOwnStaysWithinItsRange) {
  const std::vector<Param> law{{"f", "N*m", 0, kInfinity, 0, 0},
                               {"width", "rad", 0, kInfinity, 0.1, std::nan("")}};
  std::vector<Parameter> extra(2);
  extra[0].name = "f", extra[0].upper = 2;
  extra[1].name = "width", extra[1].upper = 3;
  EXPECT_FALSE(Widen(extra, {0, std::nan("")}, law, std::vector<double>{2, 3}));
  EXPECT_EQ(extra[0].upper, 2);
}

// The starts of an effect on a joint and a servo, as values of its parameters.
std::vector<std::vector<double>> StartsOf(const std::string& effect, const Sizes& sizes,
                                          bool per_condition = false) {
  const ModelSpec model = ModelSpec::Parse(R"(<mujoco><option integrator="implicitfast"/><worldbody>
    <body><joint name="q" axis="0 1 0"/><geom size=".1"/></body></worldbody>
    <actuator><position name="a" joint="q" kp="1"/></actuator></mujoco>)");
  Experiment e;
  e.all_candidates = false;
  e.candidates = {{effect, "", per_condition}};
  e.inputs = {{"u", "rad", "a", "", false, ""}};
  e.logs.resize(2);
  for (std::size_t l = 0; l < 2; ++l) {
    e.logs[l].input = {{0, 1}};
    e.logs[l].condition = l ? "warm" : "cold";
  }
  std::vector<std::string> skipped;
  const auto all = MakeCandidates(e, {&model}, sizes, skipped);
  EXPECT_FALSE(all.empty()) << effect;
  return all.front().starts;
}

// The ratio by which a value is off from the nearest one of a parameter in some starts.
double Off(const std::vector<std::vector<double>>& starts, std::size_t parameter, double value) {
  double least = kInfinity;
  for (const auto& start : starts)
    least = std::min(least, std::abs(std::log(start[parameter] / value)));
  return std::exp(least);
}

// Half of a third of a decade; half of a sixth of two and a half.
constexpr double kNear = 1.48, kNearOfSeven = 1.62;

TEST(SearchRange, ATimeOfCreepIsTriedFromAFewSamplesToTheLengthOfALog) {
  Sizes sizes;
  sizes.period = 0.01, sizes.duration = 4;
  const auto starts = StartsOf("maxwell", sizes);
  EXPECT_LE(starts.size(), 7u);
  for (const double tau : {0.03, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 4.0})
    EXPECT_LT(Off(starts, 1, tau), kNear) << tau;
  for (const auto& start : starts) EXPECT_EQ(start[0], starts.front()[0]);
}

TEST(SearchRange, OfALongLogSevenTimesAreTriedEvenly) {
  Sizes sizes;
  sizes.period = 0.001, sizes.duration = 300;
  const auto starts = StartsOf("maxwell", sizes);
  EXPECT_EQ(starts.size(), 7u);
  EXPECT_LT(Off(starts, 1, 0.003), 1.01);
  EXPECT_LT(Off(starts, 1, 300), 1.01);
}

TEST(SearchRange, ASpeedAWidthAndAFrequencyAreTriedOverTwoDecades) {
  Sizes sizes;
  sizes.velocity = 2, sizes.angle = 1, sizes.torque = 1;
  sizes.period = 0.01, sizes.duration = 2, sizes.step = 0.001;
  for (const double v : {0.02, 0.1, 0.5, 2.0})
    EXPECT_LT(Off(StartsOf("stribeck", sizes), 2, v), kNear) << v;
  for (const double width : {0.003, 0.01, 0.1, 0.5})  // rad
    EXPECT_LT(Off(StartsOf("bouc_wen", sizes), 1, 1 / width), kNearOfSeven) << width;
  for (const double w : {0.8, 5.0, 20.0, 80.0})
    EXPECT_LT(Off(StartsOf("pt2", sizes), 0, w), kNearOfSeven) << w;
}

// A limit far below the largest force makes another machine, one above it does nothing.
TEST(SearchRange, ALimitIsTriedFromAThirdOfTheLargestForceOn) {
  Sizes sizes;
  sizes.outputs = {10};
  const auto starts = StartsOf("torque_limit", sizes);
  for (const double limit : {4.0, 5.0, 7.0, 9.4}) EXPECT_LT(Off(starts, 0, limit), 1.1) << limit;
}

TEST(SearchRange, ShapesUnderSeveralConditionsAreTriedTogether) {
  Sizes sizes;
  sizes.period = 0.01, sizes.duration = 4;
  const auto starts = StartsOf("maxwell", sizes, true);
  EXPECT_EQ(starts.size(), StartsOf("maxwell", sizes).size());
  for (const auto& start : starts) {
    ASSERT_EQ(start.size(), 4u);
    EXPECT_EQ(start[2], start[3]);
  }
}

TEST(TypicalSizes, ALeverIsTheLongestFromAJointToThePart) {
  const ModelSpec model = ModelSpec::Parse(R"(<mujoco><worldbody>
    <body name="near"><joint axis="0 1 0"/><geom size=".01" pos=".1 0 0"/>
      <body name="far" pos=".4 0 0"><joint axis="0 0 1"/><geom size=".01" pos=".3 0 0"/>
        <site name="tip" pos="0 0 .3"/></body></body>
    <body name="fixed" pos="9 0 0"/></worldbody></mujoco>)");
  EXPECT_NEAR(LeverOf(model.model(), Place::kBody, {"far"}), 0.4, 1e-12);
  EXPECT_NEAR(LeverOf(model.model(), Place::kSite, {"tip"}), 0.5, 1e-12);
  EXPECT_EQ(LeverOf(model.model(), Place::kBody, {"near"}), 1);  // its origin is in the axis
  EXPECT_EQ(LeverOf(model.model(), Place::kBody, {"fixed"}), 1);
}

// A rotor that spins and a table on a spring have nothing in common but their model.
TEST(TypicalSizes, AreThoseOfTheJointsInQuestionWhereTheyMove) {
  const ModelSpec model = ModelSpec::Parse(R"(<mujoco><worldbody>
    <body name="table"><joint name="x" type="slide" axis="1 0 0"/><geom size=".1"/>
      <body name="rotor"><joint name="q" axis="0 0 1"/><geom size=".1"/></body></body>
    <body name="still"><joint name="r" axis="0 0 1"/><geom size=".1"/></body>
    </worldbody></mujoco>)");
  Sizes all;
  all.joints = {{36, 0.08, 2, -0.01, 0.02}, {2e-4, 200, 2, 0, 90}, {0, 0, 2, 0, 0}};
  const Sizes table = all.OfJoints(model.model(), {"x"});
  EXPECT_NEAR(table.torque, std::sqrt(18), 1e-12);
  EXPECT_NEAR(table.velocity, 0.2, 1e-12);
  EXPECT_NEAR(table.angle, 0.03, 1e-12);
  EXPECT_NEAR(all.OfJoints(model.model(), {"q"}).angle, 90, 1e-12);
  EXPECT_EQ(all.OfJoints(model.model(), {"r"}).angle, all.angle);
  EXPECT_NEAR(all.OfJoints(model.model(), {"x", "q"}).velocity, std::sqrt(200.08 / 4), 1e-12);
}

TEST(TypicalSizes, AnInertiaIsThatOfWhatTheJointsInQuestionMove) {
  const ModelSpec model = ModelSpec::Parse(R"(<mujoco><worldbody>
    <body name="cart"><joint name="x" type="slide" axis="1 0 0"/>
      <inertial pos="0 0 0" mass="2" diaginertia=".1 .1 .1"/>
      <body name="rod"><joint name="q" axis="0 1 0" armature="0.01"/>
        <inertial pos="0 0 .5" mass="1" diaginertia=".02 .02 .02"/></body></body>
    </worldbody></mujoco>)");
  EXPECT_NEAR(InertiaOf(model.model(), {"x"}), 3, 1e-12);
  EXPECT_NEAR(InertiaOf(model.model(), {"q"}), 0.02 + 0.25 + 0.01, 1e-12);
  EXPECT_EQ(InertiaOf(model.model(), {}), 1);
}

}  // namespace
}  // namespace continuum
