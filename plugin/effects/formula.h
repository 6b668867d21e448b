#pragma once

#include "effects/effect.h"

namespace continuum {

/// A parameter of a formula: any number, 0 where the MJCF gives none.
constexpr Param FormulaParam(std::string_view name) {
  return {name, "1", -kInfinity, kInfinity, 0, 0};
}
inline constexpr std::array kFormulaParams{
    FormulaParam("p1"), FormulaParam("p2"), FormulaParam("p3"), FormulaParam("p4"),
    FormulaParam("p5"), FormulaParam("p6"), FormulaParam("p7"), FormulaParam("p8")};

/// A force law that is written in the MJCF, as a formula of
///
///   q, v              position and speed of the joint or tendon
///   motor, weight     torques that the actuators and gravity have at the joint
///   time              of the simulation [s]
///   heat              z of  heat_time·ż = motor² − z,  0 at the start: what a winding heats up by
///   q[knee], v[knee]  of another joint, by its name; q[other], v[other]: of the other one, where
///                     the law is on two joints
///   p1 .. p8          its parameters
///
/// as
///
///   force = p1*v*abs(v)          [N*m] on the effect                       (1)
///
/// The sign rule is that of every law: force·v is power into the effect, so that (1) with p1 > 0
/// brakes. On a slide joint or a tendon read m and N. No promise of passivity: it is the formula's.
/// As every explicit force it must not be stiff in v. motor is that of the evaluation itself;
/// mj_inverse, which computes no actuators, has the one before.
struct Formula {
  static constexpr std::string_view kName = "formula", kSource = "the MJCF",
                                    kSummary = "a force that is written as a formula",
                                    kText = "force", kHeatTime = "heat_time";
  static constexpr std::array kPlaces{Place::kJoint, Place::kTendon};
  static constexpr std::array kParams{
      kFormulaParams[0], kFormulaParams[1], kFormulaParams[2],
      kFormulaParams[3], kFormulaParams[4], kFormulaParams[5],
      kFormulaParams[6], kFormulaParams[7], Positive(kHeatTime, "s", 10)};
  static constexpr std::array<std::string_view, 6> kVariables{"q",      "v",    "motor",
                                                              "weight", "time", "heat"};
  /// Whose variables may be of another joint, as kVariables[i] and its name in brackets.
  static constexpr std::size_t kOfOthers = 2;
};

/// A dry friction whose level is written in the MJCF, as a formula of q, v, the load on the joint's
/// gear [N*m] and p1 .. p8:
///
///   |τ_f| ≤ level = p1 + p2*load                                           (2)
///
/// A level below zero counts as zero. It holds at rest as every dry friction of ours.
struct FormulaFriction {
  static constexpr std::string_view kName = "formula_friction", kSource = "the MJCF",
                                    kSummary = "a dry friction that is written as a formula",
                                    kText = "level";
  static constexpr std::array kPlaces{Place::kJoint, Place::kTendon};
  static constexpr std::array kParams = kFormulaParams;
  static constexpr std::array<std::string_view, 3> kVariables{"q", "v", "load"};
};

}  // namespace continuum
