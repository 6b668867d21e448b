// Robots with cable friction that touch something: they come to rest, and stay.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "support/engine.h"

namespace continuum {
namespace {

constexpr double kAcross[] = {0.032, 0, -0.032, 0};  ///< x of the cables [m]

// An arm of links that bend about x and y, with four cables around.
struct Arm {
  int links = 5;
  double mass = 0.2226;      ///< of a link [kg]
  std::string contact = "";  ///< attributes of all geoms
  std::string world = "";    ///< what it touches
  std::string option = "";   ///< attributes of the option
  double step = 2e-3, mu = 0.15;

  std::string Mjcf() const;
};

std::string Arm::Mjcf() const {
  const double inertia = 79398e-9 * mass / 0.2226;
  std::string bodies, paths[4], close, sites;
  for (int c = 0; c < 4; ++c) {
    const double x = kAcross[c], y = kAcross[(c + 3) % 4];
    sites += fmt::format(
        R"(<site name="c{0}_l" pos="{1} {2} -.03"/><site name="c{0}_b" pos="{1} {2} 0"/>)", c, x,
        y);
    paths[c] = fmt::format(R"(<site site="c{0}_l"/><site site="c{0}_b"/>)", c);
  }
  for (int i = 0; i < links; ++i) {
    bodies += fmt::format(
        R"(<body pos="0 0 {}"><inertial pos="0 0 .026" mass="{}" diaginertia="{} {} {}"/>
      <joint axis="1 0 0" stiffness="1.2379" damping=".0314" range="-37 37" solreflimit=".004 1"/>
      <joint axis="0 1 0" stiffness="1.2379" damping=".0314" range="-37 37" solreflimit=".004 1"/>
      <geom type="cylinder" size=".04" fromto="0 0 .0135 0 0 .0385" mass="0" contype="1" conaffinity="2"/>)",
        i == 0 ? 0.0135 : 0.052, mass, inertia, inertia, inertia);
    for (int c = 0; c < 4; ++c) {
      const double x = kAcross[c], y = kAcross[(c + 3) % 4];
      bodies += fmt::format(
          R"(<site name="c{0}_{1}a" pos="{2} {3} .0135"/><site name="c{0}_{1}b" pos="{2} {3} .0385"/>)",
          c, i, x, y);
      paths[c] += fmt::format(R"(<site site="c{0}_{1}a"/><site site="c{0}_{1}b"/>)", c, i);
    }
    close += "</body>";
  }
  std::string tendons, motors;
  for (int c = 0; c < 4; ++c) {
    tendons += fmt::format(R"(<spatial name="c{}">{}</spatial>)", c, paths[c]);
    motors += fmt::format(R"(<motor tendon="c{}" gear="-1"/>)", c);
  }
  return fmt::format(R"(<mujoco><option timestep="{}" integrator="implicitfast" {}/>
    <extension><plugin plugin="continuum.capstan"><instance name="i"><config key="tendon" value="c*"/>
      <config key="mu" value="{}"/></instance></plugin></extension>
    <default><geom contype="2" conaffinity="1" {}/></default>
    <worldbody>{}<body quat="0 1 0 0">{}{}{}</body></worldbody>
    <tendon>{}</tendon><actuator>{}</actuator></mujoco>)",
                     step, option, mu, contact, world, sites, bodies, close, tendons, motors);
}

constexpr const char* kWall = R"(<geom type="plane" size="1 1 .1" pos=".07 0 0" zaxis="-1 0 0"/>)";

class ContactRest : public testing::Engine {
 protected:
  struct Motion {
    double moved = 0, speed = 0;  ///< largest [rad], [rad/s]
    int contacts = 0;             ///< fewest
  };
  // The first cable is pulled within a second to a tension [N]; what moves from `from` on.
  static Motion Pull(const testing::Owned<mjModel>& m, double tension, double from, double until) {
    const auto d = Data(m);
    std::vector<double> held;
    Motion motion{0, 0, 1000};
    while (d->time < until) {
      d->ctrl[0] = tension * std::min(1.0, d->time);
      mj_step(m.get(), d.get());
      if (d->time < from) continue;
      if (held.empty()) held.assign(d->qpos, d->qpos + m->nq);
      for (int i = 0; i < m->nq; ++i)
        motion.moved = std::max(motion.moved, std::abs(d->qpos[i] - held[i]));
      for (int i = 0; i < m->nv; ++i) motion.speed = std::max(motion.speed, std::abs(d->qvel[i]));
      motion.contacts = std::min(motion.contacts, d->ncon);
    }
    return motion;
  }
};

TEST_F(ContactRest, AnArmStaysAtAWallWithoutFriction) {
  for (const std::string contact : {"friction=\"0\"", "friction=\"0\" condim=\"1\""}) {
    for (const double step : {2e-3, 5e-4}) {
      for (const double mass : {5e-3, 0.2226}) {
        const Motion motion =
            Pull(Model(Arm{.mass = mass, .contact = contact, .world = kWall, .step = step}.Mjcf()),
                 26, 3, 6);
        EXPECT_GT(motion.contacts, 0) << contact << " " << step << " " << mass;
        EXPECT_LT(motion.moved, 3e-7) << contact << " " << step << " " << mass;
      }
    }
  }
}

// Where the forces of contacts are those of the last step, it goes on at 5 rad/s.
TEST_F(ContactRest, LightLinksDoNotChatterAtARoughWall) {
  for (const double step : {2e-3, 1e-3}) {
    for (const double mass : {5e-3, 1e-2, 2e-2}) {
      const Motion motion = Pull(
          Model(
              Arm{.mass = mass, .contact = "friction=\".3\"", .world = kWall, .step = step}.Mjcf()),
          26, 2, 3);
      EXPECT_GT(motion.contacts, 0) << step << " " << mass;
      EXPECT_LT(motion.speed, 0.4) << step << " " << mass;
    }
  }
}

TEST_F(ContactRest, AnArmStaysAtAWallWithEverySolver) {
  for (const std::string option : {"", "cone=\"elliptic\"", "solver=\"CG\"", "jacobian=\"sparse\"",
                                   "solver=\"PGS\" iterations=\"100\"", "integrator=\"Euler\""}) {
    Arm arm{.contact = "friction=\"0\"", .world = kWall, .option = option};
    std::string xml = arm.Mjcf();
    if (option.starts_with("integrator"))
      xml.replace(xml.find("integrator=\"implicitfast\""), 25, "");
    const Motion motion = Pull(Model(xml), 26, 3, 5);
    EXPECT_GT(motion.contacts, 0) << option;
    EXPECT_LT(motion.moved, 1e-5) << option;  // CG is the least exact
  }
}

// Two fingers of two links and a free box on the ground: contacts link all three.
std::string Hand() {
  std::string fingers, tendons, motors;
  for (const int side : {0, 1}) {
    fingers += fmt::format(R"(<body pos="{1} 0 0" euler="0 0 {2}"><joint axis="0 1 0"/>
      <geom type="capsule" size=".008" fromto="0 0 0 0 0 -.04" mass="1e-3"/>
      <site name="a{0}" pos="-.01 0 -.005"/><site name="b{0}" pos="-.01 0 -.035"/>
      <body pos="0 0 -.04"><joint axis="0 1 0"/>
        <geom type="capsule" size=".008" fromto="0 0 0 0 0 -.03" mass="1e-3"/>
        <site name="c{0}" pos="-.01 0 -.005"/><site name="d{0}" pos="-.01 0 -.025"/></body></body>
      <site name="e{0}" pos="{3} 0 .01"/>)",
                           side, side ? .04 : -.04, side ? 0 : 180, side ? .03 : -.03);
    tendons += fmt::format(R"(<spatial name="t{0}"><site site="e{0}"/><site site="a{0}"/>
      <site site="b{0}"/><site site="c{0}"/><site site="d{0}"/></spatial>)",
                           side);
    motors += fmt::format(R"(<motor tendon="t{}" gear="-1"/>)", side);
  }
  return fmt::format(R"(<mujoco><option timestep=".002" integrator="implicitfast"/>
    <extension><plugin plugin="continuum.capstan"><instance name="i"><config key="tendon"
      value="t*"/><config key="mu" value=".15"/></instance></plugin></extension>
    <default><joint stiffness=".05" damping="1e-3"/><geom contype="1" conaffinity="2"/></default>
    <worldbody><geom type="plane" size="1 1 .1" pos="0 0 -.075" conaffinity="3"/>{}
      <body pos="0 0 -.055"><freejoint/><geom type="box" size=".02 .02 .02" mass=".05" contype="2"
        conaffinity="3"/></body></worldbody>
    <tendon>{}</tendon><actuator>{}</actuator></mujoco>)",
                     fingers, tendons, motors);
}

TEST_F(ContactRest, AHandOfLightLinksHoldsAFreeBox) {
  const auto m = Model(Hand());
  const auto d = Data(m);
  std::vector<double> held;
  while (d->time < 4) {
    d->ctrl[0] = d->ctrl[1] = 6 * std::min(1.0, d->time);
    mj_step(m.get(), d.get());
    if (d->time < 3) continue;
    if (held.empty()) held.assign(d->qpos, d->qpos + m->nq);
    ASSERT_GE(d->ncon, 6);
    for (int i = 0; i < m->nq; ++i) ASSERT_NEAR(d->qpos[i], held[i], 3e-7) << i << " " << d->time;
  }
}

// A box that touches nothing that has a cable is no part of what is solved.
TEST_F(ContactRest, WhatTouchesNoCableChangesNoBit) {
  const std::string alone = Arm{.world = ""}.Mjcf();
  std::string beside = alone;
  const std::string end = "</worldbody>";
  beside.insert(beside.find(end), R"(<geom type="plane" size="9 9 .1" pos="0 0 -5"/>
    <body pos="3 0 -4.9"><freejoint/><geom type="box" size=".1 .1 .1" conaffinity="2"/></body>)");
  const auto bend = [](const std::string& xml) {
    const auto m = Model(xml);
    const auto d = Data(m);
    for (int k = 0; k < 500; ++k) {
      d->ctrl[0] = 26 * std::min(1.0, 4 * d->time);
      mj_step(m.get(), d.get());
    }
    return std::vector<double>(d->qpos, d->qpos + 5);
  };
  EXPECT_EQ(bend(beside), bend(alone));
}

}  // namespace
}  // namespace continuum
