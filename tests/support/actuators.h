#pragma once

#include <array>
#include <string>
#include <string_view>

namespace continuum::testing {

/// Actuators of every kind that MuJoCo has, by name, each called "a".
struct ActuatorKind {
  std::string_view kind, xml;
};
inline constexpr std::array kActuatorKinds{
    ActuatorKind{"motor", R"(<motor name="a" joint="h"/>)"},
    ActuatorKind{"motor of a ball", R"(<motor name="a" joint="b" gear="0 1 0"/>)"},
    ActuatorKind{"motor of a free joint", R"(<motor name="a" joint="f" gear="0 0 1"/>)"},
    ActuatorKind{"position", R"(<position name="a" joint="h" kp="5" kv=".1"/>)"},
    ActuatorKind{"position with lag", R"(<position name="a" joint="h" kp="5" timeconst=".05"/>)"},
    ActuatorKind{"position of a cable", R"(<position name="a" tendon="ts" kp="100"/>)"},
    ActuatorKind{"velocity", R"(<velocity name="a" joint="h" kv=".5"/>)"},
    ActuatorKind{"intvelocity", R"(<intvelocity name="a" joint="h" kp="5" actrange="-1 1"/>)"},
    ActuatorKind{"damper", R"(<damper name="a" joint="h" kv="1" ctrlrange="0 1"/>)"},
    ActuatorKind{"cylinder", R"(<cylinder name="a" joint="s" timeconst=".1" area=".01"/>)"},
    ActuatorKind{"muscle", R"(<muscle name="a" tendon="ts" lengthrange=".1 .4"/>)"},
    ActuatorKind{"adhesion", R"(<adhesion name="a" body="two" ctrlrange="0 1" gain="5"/>)"},
    ActuatorKind{"two controls", R"(<pid name="a" joint="h" kp="5" kv=".3"/>)"},
    ActuatorKind{"dcmotor", R"(<dcmotor name="a" joint="h" motorconst=".1" resistance="2"/>)"},
    ActuatorKind{"no control",
                 R"(<dcmotor name="a" joint="h" motorconst=".1" resistance="2" input="none"/>)"},
    ActuatorKind{"integrator", R"(<general name="a" joint="h" dyntype="integrator" gainprm="2"/>)"},
    ActuatorKind{"filter",
                 R"(<general name="a" joint="h" dyntype="filter" dynprm=".05" gainprm="1"/>)"},
    ActuatorKind{"actearly", R"(<general name="a" joint="h" dyntype="filterexact" dynprm=".05"
                                 gainprm="1" actearly="true"/>)"},
    ActuatorKind{"affine gain", R"(<general name="a" joint="h" gaintype="affine" gainprm="1 .1 0"
                                    biastype="affine" biasprm="0 -1 -.1"/>)"},
    ActuatorKind{"user", R"(<general name="a" joint="h" dyntype="user" actdim="1" gaintype="user"
                             biastype="user"/>)"},
    ActuatorKind{"site", R"(<motor name="a" site="s3" gear="1 0 0 0 0 0"/>)"},
    ActuatorKind{"site in another's frame",
                 R"(<general name="a" site="s3" refsite="s0" gear="1 0 0 0 0 0" gainprm="1"/>)"},
    ActuatorKind{"parent's frame", R"(<motor name="a" jointinparent="b" gear="1 0 0"/>)"},
    ActuatorKind{"crank", R"(<motor name="a" cranksite="s1" slidersite="s3" cranklength=".3"/>)"},
    ActuatorKind{"delay", R"(<general name="a" joint="h" gainprm="1" delay=".01" nsample="20"/>)"}};

/// A model with joints, tendons, bodies and sites of every kind for these: hinge h, slide s, ball b
/// and free joint f, tendons tf (fixed) and ts (through sites), bodies one to three and loose.
inline std::string ModelOf(std::string_view actuators, std::string_view extension = "") {
  return "<mujoco>" + std::string(extension) +
         R"(<option timestep="0.002" integrator="implicitfast"/>
  <worldbody>
    <site name="s0" pos="0 .02 .1"/>
    <body name="one">
      <joint name="h" axis="0 1 0" range="-80 80" damping=".05"/>
      <geom type="capsule" size=".02" fromto="0 0 0 .2 0 0" mass=".2"/>
      <site name="s1" pos=".05 .02 0"/><site name="s2" pos=".15 .02 0"/>
      <body name="two" pos=".2 0 0">
        <joint name="s" type="slide" axis="1 0 0" stiffness="40" damping="2"/>
        <geom type="capsule" size=".02" fromto="0 0 0 .1 0 0" mass=".1"/>
        <site name="s3" pos=".05 .02 0"/>
        <body name="three" pos=".1 0 0">
          <joint name="b" type="ball" damping=".05"/>
          <geom type="capsule" size=".02" fromto="0 0 0 .1 0 0" mass=".1"/>
          <site name="s4" pos=".05 .02 0"/>
        </body>
      </body>
    </body>
    <body name="loose" pos="0 1 0"><freejoint name="f"/><geom size=".05"/></body>
  </worldbody>
  <tendon>
    <fixed name="tf"><joint joint="h" coef="1"/><joint joint="s" coef="2"/></fixed>
    <spatial name="ts"><site site="s0"/><site site="s1"/><site site="s2"/><site site="s3"/>
    </spatial>
  </tendon>
  <actuator>)" +
         std::string(actuators) +
         R"(</actuator>
  <sensor>
    <jointpos name="q" joint="h"/><framepos name="p" objtype="site" objname="s3"/>
  </sensor>
</mujoco>)";
}

}  // namespace continuum::testing
