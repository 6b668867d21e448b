#include "identification/problem/parameter_units.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace continuum {
namespace {

constexpr char kModel[] = R"(<mujoco>
  <extension>
    <plugin plugin="continuum.dahl"><instance name="grease">
      <config key="joint" value="turn"/></instance></plugin>
    <plugin plugin="continuum.coulomb"><instance name="rail">
      <config key="joint" value="slide*"/></instance></plugin>
    <plugin plugin="continuum.capstan"><instance name="cable">
      <config key="tendon" value="cable"/></instance></plugin>
  </extension>
  <worldbody>
    <site name="a"/><site name="corner" pos="0 1 0"/>
    <body><joint name="turn"/><joint name="slide1" type="slide"/><joint name="slide2" type="slide"/>
      <geom size="0.1"/><site name="b" pos="0 0 1"/></body>
  </worldbody>
  <tendon><spatial name="cable"><site site="a"/><site site="corner"/><site site="b"/></spatial>
  </tendon>
  <actuator><general name="lagged" joint="turn" dyntype="filterexact" dynprm="0.1"/>
    <motor name="straight" joint="turn"/></actuator>
</mujoco>)";

struct Case {
  const char *target, *attribute, *unit;
};

TEST(Unit, OfAParameterFollowsItsEffectAndWhetherItsPlacesTurnOrSlide) {
  const ModelSpec system = ModelSpec::Parse(kModel);
  for (const Case& c : {Case{"joint:turn", "damping", "N*m*s/rad"},
                        Case{"joint:slide1", "damping", "N*s/m"},
                        Case{"tendon:cable", "damping", "N*s/m"},
                        Case{"joint:turn", "stiffness", "N*m/rad"},
                        Case{"joint:slide?", "stiffness[0]", "N/m"},
                        Case{"joint:slide1", "armature", "kg"},
                        Case{"joint:turn", "armature", "kg*m^2"},
                        Case{"joint:slide1", "frictionloss", "N"},
                        Case{"joint:slide1", "ref", "m"},
                        Case{"joint:*", "damping", "1"},
                        Case{"joint:turn slide1", "pos[2]", "m"},
                        Case{"joint:turn", "effect:viscous.b", "N*m*s/rad"},
                        Case{"joint:slide1 slide2", "effect:viscous", "N*s/m"},
                        Case{"joint:slide1", "effect:stiffness.k", "N/m"},
                        Case{"actuator:motor", "effect:pt1.T", "s"},
                        Case{"actuator:lag*", "dynprm[0]", "s"},
                        Case{"actuator:*", "dynprm[0]", "1"},
                        Case{"world:*", "effect:gravity_tilt.roll", "rad"},
                        Case{"body:*", "effect:external_force.fy", "N"},
                        Case{"plugin:grease", "sigma", "N*m/rad"},
                        Case{"plugin:rail", "tau_c", "N"},
                        Case{"plugin:cable", "mu1", "1/rad"},
                        Case{"body:*", "mass", "kg"},
                        Case{"option", "gravity[2]", "m/s^2"}}) {
    Parameter p;
    p.target = c.target, p.attribute = c.attribute;
    EXPECT_EQ(UnitOf(system, p), c.unit) << c.target << " " << c.attribute;
    p.operation = Change::Operation::kScale;
    EXPECT_EQ(UnitOf(system, p), "1");
  }
}

}  // namespace
}  // namespace continuum
