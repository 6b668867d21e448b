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
  /// The same tension of given forces [nactuator], and the change of these.
  double Tension(const mjModel& m, const double* force) const;
  void Add(const mjModel& m, double change, double* force) const;
  /// Adds how tension and stiffness follow actuators and their attributes: scratch numbers first
  /// and first + 1.
  void PutPull(const mjModel& m, const double* force, int first, LawSlopes& slopes) const;
  /// Adds how the forces follow a change of the tension, which is scratch number first + 2, and the
  /// shares it is taken by.
  void PutChange(const mjModel& m, double change, int first, LawSlopes& slopes) const;
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

  std::string WhyNoSlopes(const mjModel&) const override { return ""; }

  void Differentiate(const mjModel& m, const mjData&, const StepTaken& step,
                     LawSlopes& slopes) const override {
    using Kind = Number::Kind;
    constexpr std::size_t kN = 2 + kParamCount<E>;
    using T = Dual<kN>;
    const auto p = DualParams<kN>(AsParams<E>(p_), 2);
    int first = 0;
    for (const Drive& drive : drives_) {
      const Pull<T> pull{{drive.Tension(m, step.force), 0}, {drive.Stiffness(m), 1}};
      const T change = E::template Eval<T>(pull, p) - pull.tension;
      drive.PutPull(m, step.force, first, slopes);
      Vec<Number, kN> by{{{Kind::kScratch, first}, {Kind::kScratch, first + 1}}};
      for (std::size_t i = 0; i < kParamCount<E>; ++i)
        by[2 + i] = {Kind::kParameter, static_cast<int>(i)};
      Put(slopes.signals, {Kind::kScratch, first + 2}, change, by);
      if (drive.Stiffness(m) > 0) {
        drive.PutChange(m, change.a, first, slopes);
        drive.Add(m, change.a, step.force);
      }
      slopes.scratch = first += 3;
    }
  }

 private:
  std::vector<Drive> drives_;
};

}  // namespace continuum
