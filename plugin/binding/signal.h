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
      : BoundLaw(ReadParams<E>(config)),
        actuators_(config.MatchFit(Place::kActuator, [&](int a) { return WhyNoServo(m, a); })) {}
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

  std::string WhyNoSlopes(const mjModel&) const override { return ""; }

  void Differentiate(const mjModel& m, const mjData& d, const StepTaken& step,
                     LawSlopes& slopes) const override {
    using Kind = Number::Kind;
    constexpr std::size_t kN = 5 + kParamCount<E>;
    using T = Dual<kN>;
    const auto p = DualParams<kN>(AsParams<E>(p_), 5);
    for (const int a : actuators_) {
      const T kp(m.actuator_gainprm[mjNGAIN * a], 2);
      if (kp == 0.0) continue;
      const double* const bias = m.actuator_biasprm + mjNBIAS * a;
      const T force(step.force[a], 0), speed(d.actuator_velocity[a], 1);
      const T e = (force - T(bias[0], 3) - T(bias[2], 4) * speed) / kp;
      const T more = kp * (E::template Eval<T>(e, p) - e);
      Vec<Number, kN> by{{{Kind::kActuator, a},
                          {Kind::kActuatorRate, a},
                          {Kind::kGain, a},
                          {Kind::kBias, 3 * a},
                          {Kind::kBias, 3 * a + 2}}};
      for (std::size_t i = 0; i < kParamCount<E>; ++i)
        by[5 + i] = {Kind::kParameter, static_cast<int>(i)};
      Put(slopes.signals, {Kind::kActuatorNext, a}, more, by);
      step.force[a] += more.a;
    }
  }

 private:
  static Misfit WhyNoServo(const mjModel& m, int a) {
    const double kp = m.actuator_gainprm[mjNGAIN * a], k = -m.actuator_biasprm[mjNBIAS * a + 1];
    const bool servo =
        m.actuator_gaintype[a] == mjGAIN_FIXED && m.actuator_biastype[a] == mjBIAS_AFFINE;
    if (servo && kp == k) return {};
    return {"a position servo", servo ? "a gain of " + std::to_string(kp) +
                                            " on the control and of " + std::to_string(k) +
                                            " on the position"
                                      : ActuatorType(m.actuator_gaintype[a], m.actuator_biastype[a],
                                                     m.actuator_dyntype[a])};
  }

  std::vector<int> actuators_;
};

}  // namespace continuum
