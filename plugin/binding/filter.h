#pragma once

#include <algorithm>

#include "binding/bound_law.h"

namespace continuum {

/// The input of one actuator: a single control that acts with a fixed gain, on the force itself or
/// through a native lag or integrator.
struct ActuatorInput {
  int actuator;

  /// The control as the actuator meets it: after its delay, within its range.
  double Control(const mjModel& m, const mjData& d) const;
  /// Lets the actuator act as if its control were larger by `change`.
  void Shift(const mjModel& m, mjData& d, double change) const;
};

/// The inputs of the actuators named in config. Throws Error for an actuator with several controls,
/// another gain or other dynamics.
std::vector<ActuatorInput> MatchInputs(const mjModel& m, const Config& config);

/// A Signal law with states at the input of actuators: they receive y = Eval(u, z) instead of u.
/// The states follow the controls from step to step, and y is held over a step as u is.
template <FilterLaw E>
class BoundFilter : public BoundLaw {
  static_assert(E::kTap == Tap::kInput);

 public:
  static constexpr std::size_t kZ = E::kStates.size();

  BoundFilter(const mjModel& m, const Config& config)
      : BoundLaw(ReadParams<E>(config)), inputs_(MatchInputs(m, config)), u_(inputs_.size()) {}

  static int StateSize(const mjModel&, const Config& config) {
    return static_cast<int>(kZ * config.Match(Place::kActuator).size());
  }

  bool IsSignal() const override { return true; }

  bool Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                std::span<double>) override {
    if (stage != Stage::kActuator) return false;
    const auto p = AsParams<E>(p_);
    for (std::size_t i = 0; i < inputs_.size(); ++i, z += kZ) {
      u_[i] = inputs_[i].Control(m, d);
      inputs_[i].Shift(m, d, E::template Eval<double>(u_[i], Load(z), p) - u_[i]);
    }
    return false;
  }

  void Advance(const mjModel& m, const mjData&, double* z) override {
    const auto p = AsParams<E>(p_);
    for (const double u : u_) z = Store(E::template Step<double>(Load(z), u, m.opt.timestep, p), z);
  }

  void Settle(const mjModel& m, const mjData& d, double* z) const override {
    const auto p = AsParams<E>(p_);
    const double for_ever = 1e9;  // s
    for (const ActuatorInput& input : inputs_) {
      z = Store(E::template Step<double>(Load(z), input.Control(m, d), for_ever, p), z);
    }
  }

  void CopyFrom(const BoundLaw& other) override { u_ = static_cast<const BoundFilter&>(other).u_; }

 private:
  static Vec<double, kZ> Load(const double* z) {
    Vec<double, kZ> state;
    std::copy_n(z, kZ, state.begin());
    return state;
  }
  static double* Store(const Vec<double, kZ>& state, double* z) {
    return std::copy(state.begin(), state.end(), z);
  }

  std::vector<ActuatorInput> inputs_;
  std::vector<double> u_;  ///< controls of the last evaluation
};

}  // namespace continuum
