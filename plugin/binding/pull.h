#pragma once

#include "binding/bound_law.h"

namespace continuum {

/// A tendon and the actuators that pull it. A position servo among them is as stiff along the
/// tendon as k = −bias[1] gear² [N/m].
struct Drive {
  int tendon;
  std::vector<int> actuators;

  double Stiffness(const mjModel& m) const;
  /// Tension [N] of all actuators together, before their force ranges.
  double Tension(const mjModel& m, const mjData& d) const;
  /// Changes the tension; every servo takes its share by stiffness.
  void Add(const mjModel& m, mjData& d, double change) const;
};

std::vector<Drive> MatchDrives(const mjModel& m, const Config& config);
/// A sentence when one of the drives has no position servo, else empty.
std::string WithoutServo(const mjModel& m, std::span<const Drive> drives);

/// A Signal law between the position servos of a tendon and its route. It acts before the
/// actuators' force ranges.
template <PullLaw E>
class BoundPull : public BoundLaw {
  static_assert(E::kTap == Tap::kTendon);

 public:
  BoundPull(const mjModel& m, const Config& config)
      : BoundLaw(ReadParams<E>(config)), drives_(MatchDrives(m, config)) {}
  static int StateSize(const mjModel&, const Config&) { return 0; }

  std::string WhyIdle(const mjModel& m) const override { return WithoutServo(m, drives_); }

  bool IsSignal() const override { return true; }

  bool Evaluate(const mjModel& m, mjData& d, const double*, Stage stage,
                std::span<double>) override {
    if (stage != Stage::kActuator) return false;
    const auto p = AsParams<E>(p_);
    for (const Drive& drive : drives_) {
      const Pull<double> pull{drive.Tension(m, d), drive.Stiffness(m)};
      const double change = E::template Eval<double>(pull, p) - pull.tension;
      if (change != 0) drive.Add(m, d, change);
    }
    return false;
  }

 private:
  std::vector<Drive> drives_;
};

}  // namespace continuum
