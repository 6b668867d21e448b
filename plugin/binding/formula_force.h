#pragma once

#include <array>
#include <string>
#include <vector>

#include "binding/bound_law.h"
#include "binding/force.h"
#include "binding/formula.h"
#include "binding/gear_load.h"

namespace continuum {

/// A written force on joints or tendons.
class BoundFormula : public BoundLaw {
 public:
  BoundFormula(const mjModel& m, const Config& config);
  /// One for each joint where the formula has heat.
  static int StateSize(const mjModel& m, const Config& config);

  bool GivesForce() const override { return true; }
  bool Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                std::span<double> force) override;
  void Advance(const mjModel& m, const mjData& d, double* z) override;
  std::string WhyNoSlopes(const mjModel&) const override;
  void Differentiate(const mjModel& m, const mjData& d, const StepTaken&,
                     LawSlopes& slopes) const override;

 private:
  enum Variable { kPosition, kSpeed, kMotor, kWeight, kTime, kHeat };

  /// A variable of another joint than the one that the force is on; twin: of the other of two.
  struct Other {
    bool speed, twin;
    int joint;
  };
  static std::vector<std::string> OtherNames(const Config& config);
  void FindOthers(const mjModel& m, const Config& config);
  void RequireJoints(const Config& config) const;

  bool Uses(Variable variable) const { return force_.Uses(variable); }
  int JointOf(const Other& other, std::size_t line) const;
  void SetValues(const mjModel& m, const mjData& d, const double* z, const GearTorques& gears,
                 std::size_t line, std::vector<double>& values) const;
  std::vector<Number> NumbersOf(const mjModel& m, std::size_t line) const;

  std::vector<Line> lines_;
  Expression force_;
  std::vector<Other> others_;
  std::vector<double> values_;  ///< of one evaluation
};

}  // namespace continuum
