#pragma once

#include "effects/effect.h"

namespace continuum {

/// A gear that gives: a spring, a damper and play between the motor and the joint that it turns.
///
///   J θ̈ = τ_m − τ                                                         (1)
///   M(q) q̈ + … = τ + …,   τ = z(θ − q)/c + d (θ̇ − q̇)                      (2)
///   z(e) = e − clamp(e, −gap/2, gap/2)                                     (3)
///
/// q [rad] the joint · θ [rad] the motor, as seen behind the gear · J [kg*m²] the joint's armature,
/// which is the motor's inertia · τ_m [N*m] all actuators of the joint · c [rad/(N*m)] compliance ·
/// d [N*m*s/rad] · gap [rad] play. On a slide joint read m for rad and N for N*m. At c = 0 motor
/// and joint turn as one, which is the model as it is. Actuators pull the motor and see its angle;
/// springs, dampers, friction and sensors of the joint stay on its side.
///
/// The motor is a joint of its own, of a body without mass on the joint's, and (2) is a fixed
/// tendon: the model needs no plugin, and derivatives and energy are MuJoCo's. That is simpler than
/// states of an effect, whose torque would be a step late. The motor's spin about other axes is
/// left out, as for large ratios. It begins where the spring is at rest. A gear whose oscillation
/// the time step cannot follow is rigid.
///
/// No candidate by itself: it needs an armature, and on a slow motion it says what a softer servo
/// or a late input does. A search leaves gap at 0. Source: spong1987.
struct ElasticGear {
  static constexpr std::string_view kName = "elastic_gear", kSource = "spong1987",
                                    kSummary = "a spring, a damper and play behind the motor";
  static constexpr bool kOnlyListed = true, kOwnStep = true;
  static constexpr std::array kPlaces{Place::kJoint};
  static constexpr std::array kParams{Magnitude("c", "rad/N/m", 0.02),
                                      Magnitude("d", "N*m*s/rad", 0.02),
                                      Param{"gap", "rad", 0, kInfinity, 0, 0, 0}};

  template <class Element>
  static void Apply(Element& joint, const Vec<double, 3>& p) {
    const auto& [c, d, gap] = p;
    if (c == 0) return;
    joint.Set("gear_compliance", c);
    joint.Set("gear_damping", d);
    joint.Set("gear_play", gap);
  }
};

}  // namespace continuum
