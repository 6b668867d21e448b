#pragma once

#include "binding/actuator_type.h"
#include "binding/bound_law.h"

namespace continuum {

/// A Signal law at the error of position servos: the servo acts as if its error were Eval(error).
///
///   actuator_force += k_p (Eval(e) − e),   e = (force − b_0 − k_v-term)/k_p
///
/// It acts before the actuator's force range.
template <SignalLaw E>
class BoundSignal : public BoundLaw {
  static_assert(E::kTap == Tap::kServoError);

 public:
  BoundSignal(const mjModel& m, const Config& config)
      : BoundLaw(ReadParams<E>(config)), actuators_(config.Match(Place::kActuator)) {
    for (const int a : actuators_) {
      const double kp = m.actuator_gainprm[mjNGAIN * a], k = -m.actuator_biasprm[mjNBIAS * a + 1];
      const bool servo =
          m.actuator_gaintype[a] == mjGAIN_FIXED && m.actuator_biastype[a] == mjBIAS_AFFINE;
      if (servo && kp == k) continue;
      throw Error::Input(config.Who() + ": actuator '" + mj_id2name(&m, mjOBJ_ACTUATOR, a) + "'",
                         "a position servo",
                         servo ? "a gain of " + std::to_string(kp) + " on the control and of " +
                                     std::to_string(k) + " on the position"
                               : ActuatorType(m.actuator_gaintype[a], m.actuator_biastype[a],
                                              m.actuator_dyntype[a]));
    }
  }
  static int StateSize(const mjModel&, const Config&) { return 0; }

  bool IsSignal() const override { return true; }

  bool Evaluate(const mjModel& m, mjData& d, const double*, Stage stage,
                std::span<double>) override {
    if (stage != Stage::kActuator) return false;
    const auto p = AsParams<E>(p_);
    for (const int a : actuators_) {
      const double kp = m.actuator_gainprm[mjNGAIN * a];
      if (kp == 0) continue;
      const double* const bias = m.actuator_biasprm + mjNBIAS * a;
      const double e = (d.actuator_force[a] - bias[0] - bias[2] * d.actuator_velocity[a]) / kp;
      d.actuator_force[a] += kp * (E::template Eval<double>(e, p) - e);
    }
    return false;
  }

 private:
  std::vector<int> actuators_;
};

}  // namespace continuum
