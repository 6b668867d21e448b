#include "sim/simulation/rest_search.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/model/model_spec.h"
#include "support/scratch.h"

namespace continuum {
namespace {

class RestSearches : public ::testing::Test {
 protected:
  void Load(const std::string& model) {
    machine_ = ModelSpec::Load(scratch_.Write("m.xml", "<mujoco><option gravity=\"0 0 0\"/>" +
                                                           model + "</mujoco>"))
                   .Build();
  }
  // Two masses behind a servo of 100 N/m, joined by a spring of 50 N/m; they rub by 1 and 0.7 N.
  static std::string Pair() {
    return R"(
      <worldbody>
        <body><joint name="x" type="slide" axis="1 0 0" frictionloss="1"/><geom size=".1" mass="1"/></body>
        <body pos="1 0 0"><joint name="y" type="slide" axis="1 0 0" frictionloss="0.7"/><geom size=".1" mass=".3"/></body>
      </worldbody>
      <tendon><fixed name="spring" stiffness="50"><joint joint="x" coef="-1"/><joint joint="y" coef="1"/></fixed></tendon>
      <actuator><position name="a" joint="x" kp="100"/></actuator>)";
  }
  // A slider on a spring of 10 N/m that a cable of 1000 N/m pulls and cannot push.
  static std::string Cable(const std::string& joint) {
    return R"(
      <worldbody><body><joint name="x" type="slide" axis="1 0 0" stiffness="10" )" +
           joint + R"(/><geom size=".1" mass="1"/></body></worldbody>
      <tendon><fixed name="cable"><joint joint="x" coef="1"/></fixed></tendon>
      <actuator><general name="a" tendon="cable" gainprm="1000" biastype="affine" biasprm="0 -1000 0" forcerange="0 1e9" forcelimited="true"/></actuator>)";
  }
  mjModel& m() { return *machine_.model; }
  mjData& d() { return *machine_.data; }

  testing::Scratch scratch_;
  ModelAndData machine_;
  const Hooks none_{};
};

// |force| within the level where a mass stood still, the level itself where it slid.
TEST_F(RestSearches, FrictionHoldsOrOpposesWhatMoved) {
  Load(Pair());
  RestSearch search(m(), d(), none_);
  ASSERT_EQ(search.Obstacle(), "");
  EXPECT_TRUE(search.Rubs());
  double x = 0, y = 0;
  for (const double u : {0.005, 0.012, 0.05, 0.048, 0.03, -0.02, 0.0}) {
    d().ctrl[0] = u;
    ASSERT_TRUE(search.Advance()) << u;
    const double on_x = 100 * (u - d().qpos[0]) + 50 * (d().qpos[1] - d().qpos[0]),
                 on_y = 50 * (d().qpos[0] - d().qpos[1]);
    const auto agrees = [](double force, double moved, double level) {
      return moved == 0 ? std::abs(force) <= level + 1e-9
                        : std::abs(force - std::copysign(level, moved)) < 1e-7;
    };
    EXPECT_TRUE(agrees(on_x, d().qpos[0] - x, 1)) << "x at " << u;
    EXPECT_TRUE(agrees(on_y, d().qpos[1] - y, 0.7)) << "y at " << u;
    x = d().qpos[0], y = d().qpos[1];
  }
}

TEST_F(RestSearches, ACableBecomesTautAndSlackWithinOneStep) {
  Load(Cable(""));
  RestSearch search(m(), d(), none_);
  EXPECT_FALSE(search.Rubs());
  for (const double u : {0.1, -0.2, 0.3, 0.0}) {
    d().ctrl[0] = u;
    ASSERT_TRUE(search.Advance()) << u;
    EXPECT_NEAR(d().qpos[0], std::max(u, 0.0) * 1000 / 1010, 1e-9) << u;
  }
}

TEST_F(RestSearches, ALimitThatActsEndsTheSearchWhereItBegan) {
  Load(Cable("limited=\"true\" range=\"-1 0.05\""));
  RestSearch search(m(), d(), none_);
  d().ctrl[0] = 0.02;
  ASSERT_TRUE(search.Advance());
  const double before = d().qpos[0];
  d().ctrl[0] = 0.2;
  EXPECT_FALSE(search.Advance());
  EXPECT_EQ(d().qpos[0], before);
}

TEST_F(RestSearches, WhatNothingHoldsHasNoRest) {
  Load(
      R"(<worldbody><body><joint name="x" type="slide" axis="1 0 0"/><geom size=".1" mass="1"/></body></worldbody>
          <actuator><motor name="a" joint="x"/></actuator>)");
  RestSearch search(m(), d(), none_);
  d().ctrl[0] = 1;
  EXPECT_FALSE(search.Advance());
}

TEST_F(RestSearches, ALawThatRemembersIsAnObstacle) {
  Load(
      R"(<extension><plugin plugin="continuum.dahl"><instance name="f"><config key="joint" value="x"/>
            <config key="f" value="1"/><config key="sigma" value="100"/></instance></plugin></extension>
          <worldbody><body><joint name="x" type="slide" axis="1 0 0" stiffness="1"/><geom size=".1" mass="1"/></body></worldbody>)");
  EXPECT_THAT(RestSearch(m(), d(), none_).Obstacle(), ::testing::HasSubstr("dahl"));
}

}  // namespace
}  // namespace continuum
