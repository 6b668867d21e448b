#pragma once

#include <algorithm>
#include <cmath>

#include "binding/actuator_force.h"
#include "binding/bound_law.h"

namespace continuum {

/// The actuators that config names, all on one supply. Those with several outputs are none:
/// Config::MatchFit.
std::vector<int> MatchSupplied(const mjModel& m, const Config& config);

/// What an actuator gives within its range, and the number that it then is: the force itself, or an
/// end of its range.
struct ForceInRange {
  double value;
  Number is;
};
ForceInRange InRange(const mjModel& m, int actuator, double force);

/// A Signal law at the supply that actuators share: each gives the same share of its force, which
/// follows from the sum of them all. It acts on forces within their ranges, after all other
/// signals.
template <SupplyLaw E>
class BoundSupply : public BoundLaw {
  static_assert(E::kTap == Tap::kSupply);

 public:
  BoundSupply(const mjModel& m, const Config& config)
      : BoundLaw(ReadParams<E>(config)),
        actuators_(MatchSupplied(m, config)),
        force_(actuators_.size()) {}
  static int StateSize(const mjModel&, const Config&) { return 0; }

  bool IsSignal() const override { return true; }

  bool Evaluate(const mjModel& m, mjData& d, const double*, Stage stage,
                std::span<double>) override {
    if (stage != Stage::kActuator) return false;
    double load = 0;
    for (std::size_t i = 0; i < actuators_.size(); ++i) {
      force_[i] = LimitedForce(m, d, actuators_[i]);
      load += std::abs(force_[i]);
    }
    const double share = E::template Share<double>(load, AsParams<E>(p_));
    if (share == 1) return false;
    for (std::size_t i = 0; i < actuators_.size(); ++i)
      d.actuator_force[m.actuator_outadr[actuators_[i]]] = share * force_[i];
    return false;
  }

  std::string WhyNoSlopes(const mjModel&) const override { return ""; }

  void Differentiate(const mjModel& m, const mjData&, const StepTaken& step,
                     LawSlopes& slopes) const override {
    using Kind = Number::Kind;
    constexpr std::size_t kN = 2 + kParamCount<E>;
    using T = Dual<kN>;
    const Number sum{Kind::kScratch, 0};
    double load = 0;
    for (const int a : actuators_) {
      const auto [force, is] = InRange(m, a, step.force[a]);
      load += std::abs(force);
      slopes.signals.push_back({sum, is, force < 0 ? -1.0 : 1.0});
    }
    const T share = E::template Share<T>(T(load, 1), DualParams<kN>(AsParams<E>(p_), 2));
    Vec<Number, kN> by{};
    by[1] = sum;
    for (std::size_t i = 0; i < kParamCount<E>; ++i)
      by[2 + i] = {Kind::kParameter, static_cast<int>(i)};
    for (const int a : actuators_) {
      const auto [force, is] = InRange(m, a, step.force[a]);
      const T given = share * T(force, 0);
      by[0] = is;
      slopes.signals.push_back({{Kind::kActuatorNext, a}, {Kind::kActuator, a}, -1});
      Put(slopes.signals, {Kind::kActuatorNext, a}, given, by);
      step.force[a] = given.a;
    }
    slopes.scratch = 1;
  }

 private:
  std::vector<int> actuators_;
  std::vector<double> force_;  ///< of the last evaluation, as on a stiff supply
};

}  // namespace continuum
