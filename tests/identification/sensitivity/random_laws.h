#pragma once

#include <string>
#include <vector>

#include "random_machine.h"

namespace continuum::testing {

/// The laws whose steps have derivatives in closed form.
inline std::vector<RandomLaw> RandomLaws() {
  const std::string kJoints = "<config key='joint' value='x* y1'/>",
                    kTendons = "<config key='tendon' value='tb tf'/>",
                    kActuated = "<config key='joint' value='y0 x1 x2'/>";
  return {RandomLaw{"Coulomb", "coulomb", kJoints, {{"tau_c", {5e-3, 4e-2}}}},
          RandomLaw{"CoulombOfTendons", "coulomb", kTendons, {{"tau_c", {5e-3, 4e-1}}}},
          RandomLaw{"Stribeck",
                    "stribeck",
                    "<config key='joint' value='y2'/>",
                    {{"tau_c", {5e-3, 4e-2}}, {"S", {0.2, 1}}, {"v_d", {0.1, 0.5}}}},
          RandomLaw{"LoadFriction",
                    "load_friction",
                    kActuated,
                    {{"tau_c", {5e-3, 2e-2}}, {"mu_l", {0.05, 0.2}}}},
          RandomLaw{"LoadFrictionOfActuators",
                    "load_friction",
                    kActuated,
                    {{"tau_c", {5e-3, 2e-2}}, {"mu_l", {0.05, 0.2}}},
                    "<config key='load' value='actuator'/>"},
          RandomLaw{"DirectionalFriction",
                    "directional_friction",
                    kJoints,
                    {{"tau_c_plus", {5e-3, 2e-2}},
                     {"tau_c_minus", {1e-2, 4e-2}},
                     {"b_plus", {1e-3, 1e-2}},
                     {"b_minus", {1e-3, 1e-2}}}},
          RandomLaw{"PositionFriction",
                    "position_friction",
                    kJoints,
                    {{"tau_c", {2e-2, 4e-2}}, {"c", {-1e-2, 1e-2}}, {"s", {-1e-2, 1e-2}}}},
          RandomLaw{"CubicStiffness", "cubic_stiffness", kJoints, {{"k3", {-1, 2}}}},
          RandomLaw{"Dahl", "dahl", kJoints, {{"sigma", {0.3, 2}}, {"f", {1e-2, 5e-2}}}},
          RandomLaw{"DahlOfTendons", "dahl", kTendons, {{"sigma", {5, 20}}, {"f", {1e-2, 1}}}},
          RandomLaw{"Lugre",
                    "lugre",
                    kJoints,
                    {{"sigma_0", {0.3, 2}},
                     {"sigma_1", {1e-4, 1e-3}},
                     {"tau_c", {1e-2, 5e-2}},
                     {"S", {0.2, 1}},
                     {"v_s", {0.1, 0.5}}}},
          RandomLaw{"Formula",
                    "formula",
                    kJoints,
                    {{"p1", {1e-3, 5e-3}}, {"p2", {0.1, 0.5}}},
                    "<config key='force' value='a = sin(3*q); p1*v*abs(v) + p2*a^3'/>"},
          RandomLaw{"FormulaOfTendons",
                    "formula",
                    kTendons,
                    {{"p1", {0.01, 0.1}}, {"p2", {0.05, 0.1}}},
                    "<config key='force' value='p1*v*where(q, 1, 2) + p2*exp(3*q)'/>"},
          RandomLaw{"FormulaFriction",
                    "formula_friction",
                    kActuated,
                    {{"p1", {5e-3, 2e-2}}, {"p2", {0.05, 0.2}}, {"p3", {0.2, 1}}},
                    "<config key='level' value='p1*(1 + p3*exp(-(v/0.3)^2)) + p2*load*cos(q)'/>"},
          RandomLaw{"NativeFriction", "", "", {}, "", "frictionloss='0.01'", "frictionloss='0.1'"},
          RandomLaw{"JointLimits", "", "", {}, "", "limited='true' range='-3 2'"},
          RandomLaw{"TendonLimits", "", "", {}, "", "", "limited='true' range='0.19 0.195'"},
          RandomLaw{"JointEqualities",
                    "",
                    "",
                    {},
                    "",
                    "",
                    "",
                    "<equality><joint joint1='y1' joint2='y2' polycoef='0 0.7 0.3'/>"
                    "<joint joint1='x2' polycoef='0.1'/></equality>"},
          RandomLaw{"FrictionAtLimits",
                    "coulomb",
                    kJoints,
                    {{"tau_c", {5e-3, 4e-2}}},
                    "",
                    "limited='true' range='-6 6'"},
          RandomLaw{"Maxwell", "maxwell", kJoints, {{"k_m", {0.1, 0.5}}, {"tau_m", {0.02, 0.5}}}}};
}

}  // namespace continuum::testing
