#pragma once

#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "effects/all.h"

namespace continuum::testing {

/// A two-link arm with a servo, a cable through sites with a motor, and a wire with a servo; a link
/// with three chambers.
inline std::string Arm(const std::string& plugin, const std::string& config,
                       const std::string& option) {
  return "<mujoco><option timestep=\"2e-3\" " + option + "/>" +
         "<extension><plugin plugin=\"continuum." + plugin + "\"><instance name=\"i\">" + config +
         "</instance></plugin></extension>" + R"(
    <worldbody><site name="a" pos=".03 0 0.1"/>
      <body><joint name="q1" axis="0 1 0" damping=".01"/><geom type="capsule" size=".02" fromto="0 0 0 0 0 -.2" mass=".3"/>
        <site name="b" pos=".03 0 -.05"/><site name="c" pos=".03 0 -.15"/>
        <body pos="0 0 -.2"><joint name="q2" axis="0 1 0" damping=".005" stiffness=".1"/>
          <geom type="capsule" size=".02" fromto="0 0 0 0 0 -.2" mass=".2"/>
          <site name="e" pos=".03 0 -.05"/><site name="f" pos=".03 0 -.15"/></body></body>
      <body name="base" pos="1 0 0"><body name="tip" pos="0 0 .1">
        <inertial pos="0 0 0" mass=".2" diaginertia="1e-4 1e-4 1e-4"/>
        <joint name="stretch" type="slide" axis="0 0 1" stiffness="200" damping="2"/>
        <joint name="bend" axis="0 1 0" stiffness=".5" damping=".01"/></body></body>
    </worldbody>
    <tendon><spatial name="cable"><site site="a"/><site site="b"/><site site="c"/><site site="e"/><site site="f"/></spatial>
      <spatial name="wire"><site site="a"/><site site="c"/></spatial></tendon>
    <actuator><position name="servo" joint="q1" kp="5" kv=".1"/><motor name="pull" tendon="cable" gear="-1" forcerange="0 6"/>
      <position name="winch" tendon="wire" gear="-1" kp="20" forcerange="0 3"/>
      <general name="p1" joint="stretch" gear="0"/><general name="p2" joint="stretch" gear="0"/>
      <general name="p3" joint="stretch" gear="0" dyntype="filterexact" dynprm="7e-3"/></actuator>
    <keyframe><key name="bent" time="2" qpos=".2 -.1 .01 .05" qvel="1 -1 .02 .1" ctrl=".1 2 -.2 1e4 2e4 1e4"/></keyframe>
    </mujoco>)";
}

inline std::string Key(const std::string& key, const std::string& value) {
  return "<config key=\"" + key + "\" value=\"" + value + "\"/>";
}

inline std::map<std::string, std::string> ChosenLaws() {
  const auto key = Key;
  return {
      {"coulomb", key("joint", "q*") + key("tau_c", ".05")},
      {"stribeck", key("joint", "q2") + key("tau_mu", ".005") + key("tau_c", ".05")},
      {"load_friction", key("joint", "q1") + key("tau_c", ".01") + key("mu_l", ".2")},
      {"position_friction", key("joint", "q1") + key("tau_c", ".05") + key("c", ".03")},
      {"dahl", key("joint", "q1 q2") + key("sigma", "5") + key("f", ".1")},
      {"directional_friction", key("joint", "q*") + key("tau_c_plus", ".05") +
                                   key("tau_c_minus", ".02") + key("b_plus", ".01")},
      {"lugre",
       key("joint", "q1 q2") + key("sigma_0", "5") + key("tau_c", ".05") + key("sigma_1", ".01")},
      {"bouc_wen",
       key("tendon", "cable") + key("kappa_w", ".3") + key("sigma", ".7") + key("n", "1.5")},
      {"maxwell", key("joint", "q1 q2") + key("k_m", ".3") + key("tau_m", ".2")},
      {"backlash", key("actuator", "servo") + key("gap", ".05")},
      {"pt2", key("actuator", "servo pull") + key("w", "30") + key("zeta", ".5")},
      {"tendon_stretch", key("tendon", "wire") + key("compliance", ".01")},
      {"supply_sag", key("actuator", "servo pull winch") + key("r", ".2")},
      {"slack", key("tendon", "wire") + key("length", ".02")},
      {"capstan", key("tendon", "cable") + key("mu", ".3")},
      {"pcc_segment", key("body", "base tip") + key("actuator", "p1 p2 p3") + key("x_m", "-4e-4") +
                          key("y_m", "-1.5e-3") + key("A", "31e-6") + key("d_theta", ".2301") +
                          key("d_dL", "1.8384") + key("k_theta", "183.5195") +
                          key("k_dL1", "251.7274") + key("k_dL3", "-4.2e4")},
      {"braid", key("body", "base tip") + key("actuator", "p1 p2 p3") + key("cot2_gamma", ".3")},
      {"chamber_asymmetry", key("body", "base tip") + key("actuator", "p1 p2 p3") +
                                key("x_m", "1e-3") + key("y_m", "-1e-3")},
      {"formula", key("joint", "q1 q2") + key("force", "p1*q^3 + p2*v*abs(v)") + key("p1", ".2") +
                      key("p2", ".01")},
      {"formula_friction", key("joint", "q1") + key("level", "p1*(1 + q^2)") + key("p1", ".05")},
      {"load_friction.actuator",
       key("joint", "q1") + key("tau_c", ".01") + key("mu_l", ".2") + key("load", "actuator")},
      {"capstan.coulomb", key("tendon", "cable") + key("mu", ".3") + key("law", "coulomb")}};
}

/// A law on the arm's joints, or its cable, with the parameters from which searches start.
template <class E>
std::string WhereSearchesStart() {
  const bool joint = E::kPlaces.front() == Place::kJoint;
  std::string config = joint ? Key("joint", "q1 q2") : Key("tendon", "cable");
  for (const Param& p : E::kParams) config += Key(std::string(p.name), std::to_string(p.initial));
  return config;
}

/// Every law of the plugin. Forces and frictions for which nothing is chosen take part too.
inline const std::map<std::string, std::string>& Laws() {
  static const std::map<std::string, std::string> laws = [] {
    auto all = ChosenLaws();
    All::ForEach([&]<class E>() {
      if constexpr (ForceLaw<E> || FrictionLaw<E>)
        all.try_emplace(std::string(E::kName), WhereSearchesStart<E>());
    });
    return all;
  }();
  return laws;
}
/// A law by another choice is written LAW.CHOICE.
inline std::string EffectOf(const std::string& law) { return law.substr(0, law.find('.')); }

/// Steps the arm with inputs that move all of it.
inline void Drive(const mjModel* m, mjData* d, int steps) {
  for (int k = 0; k < steps; ++k) {
    d->ctrl[0] = std::sin(3 * d->time);
    d->ctrl[1] = 4 + 4 * std::sin(5 * d->time);
    d->ctrl[2] = -.2 + .1 * std::sin(4 * d->time);
    for (int i = 0; i < 3; ++i) d->ctrl[3 + i] = 2e4 * (1 + std::sin(4 * d->time + i));
    mj_step(m, d);
  }
  EXPECT_EQ(d->warning[mjWARN_BADQACC].number, 0);  // MuJoCo would have begun anew
}

}  // namespace continuum::testing
