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

/// The inputs of the actuators named in config. Those with several controls, another gain or other
/// dynamics are none: Config::MatchFit.
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

  std::string WhyNoSlopes(const mjModel&) const override { return ""; }

  void Differentiate(const mjModel& m, const mjData&, const StepTaken& step,
                     LawSlopes& slopes) const override {
    const auto p = DualParams<kN>(AsParams<E>(p_), 1 + kZ);
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const int a = inputs_[i].actuator, first = static_cast<int>(i * kZ);
      const T u(step.control[a], 0);
      Vec<T, kZ> z;
      for (std::size_t k = 0; k < kZ; ++k) z[k] = T(step.z[first + static_cast<int>(k)], 1 + k);
      const auto by = NumbersOf(a, first);
      const T more = E::template Eval<T>(u, z, p) - u;
      step.input[a] += more.a;
      Put(slopes.signals, {Number::Kind::kInput, a}, more, by);
      const auto next = E::template Step<T>(z, u, m.opt.timestep, p);
      for (std::size_t k = 0; k < kZ; ++k)
        Put(slopes.next, {Number::Kind::kNext, first + static_cast<int>(k)}, next[k], by);
    }
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
  // Control; states; parameters.
  static constexpr std::size_t kN = 1 + kZ + kParamCount<E>;
  using T = Dual<kN>;
  static Vec<Number, kN> NumbersOf(int actuator, int state) {
    Vec<Number, kN> numbers;
    numbers[0] = {Number::Kind::kControl, actuator};
    for (std::size_t k = 0; k < kZ; ++k)
      numbers[1 + k] = {Number::Kind::kState, state + static_cast<int>(k)};
    for (std::size_t k = 0; k < kParamCount<E>; ++k)
      numbers[1 + kZ + k] = {Number::Kind::kParameter, static_cast<int>(k)};
    return numbers;
  }

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
