#pragma once

#include "binding/formula.h"
#include "binding/friction.h"

namespace continuum {

/// The values of a formula's variables and parameters.
template <FormulaLaw E>
using FormulaValues = Vec<double, E::kVariables.size() + kParamCount<E>>;

template <FormulaLaw E>
FormulaValues<E> ValuesOf(const std::vector<double>& p) {
  FormulaValues<E> values{};
  std::copy(p.begin(), p.end(), values.begin() + E::kVariables.size());
  return values;
}

/// Adds the derivatives of a formula that are not zero.
template <std::size_t N>
void Put(std::vector<Slope>& to, Number of, const Vec<double, N>& slopes, const Vec<Number, N>& by,
         double factor = 1) {
  for (std::size_t i = 0; i < N; ++i) {
    if (slopes[i] != 0) to.push_back({of, by[i], factor * slopes[i]});
  }
}

/// A written dry friction on joints or tendons, as rows.
class BoundFormulaFriction : public BoundLaw {
 public:
  BoundFormulaFriction(const mjModel& m, const Config& config, int instance)
      : BoundLaw(ReadParams<FormulaFriction>(config)),
        rows_(m, config, JointsOf<FormulaFriction>(), instance),
        level_(ReadFormula<FormulaFriction>(config, {})) {}
  static int StateSize(const mjModel& m, const Config& config) {
    return FrictionRows::StateSize(m, config, JointsOf<FormulaFriction>());
  }

  bool IsRow() const override { return true; }
  std::string WhyIdle(const mjModel& m) const override { return rows_.WhySoft(m); }
  void Impose(mjModel& m) const override { rows_.Impose(m); }

  bool Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                std::span<double>) override {
    const GearTorques gears(m, d);
    rows_.Write(m, d, z, stage, FrictionRows::Absent::kAtZero,
                [&](const FrictionRow& row, double v) { return LevelAt(m, d, gears, row, v); });
    return false;
  }

  std::string WhyNoBristles(const mjModel&) const override { return rows_.WhyNoBristles(); }
  std::vector<int> BristleStates() const override { return rows_.BristleStates(); }
  void Bristles(const mjModel& m, const mjData& d, const double* z, double* rate,
                std::span<double> force) const override {
    const GearTorques gears(m, d);
    rows_.Bristles(m, d, z, rate, force, 0,
                   [&](const FrictionRow& row, double v) { return LevelAt(m, d, gears, row, v); });
  }

  std::string WhyNoSlopes(const mjModel& m) const override { return rows_.WhyNoSlopes(m); }

  void Differentiate(const mjModel& m, const mjData& d, const StepTaken& step,
                     LawSlopes& slopes) const override {
    const GearTorques gears(m, d);
    rows_.Differentiate(m, d, step, slopes,
                        [&](const FrictionRow& row, int r, double v, bool moves) {
                          FormulaValues<FormulaFriction> by_value;
                          if (level_.Differentiate(At(m, d, gears, row, v), by_value) <= 0) return;
                          const double torque = row.joint ? gears.At(m, d, row.index, 0) : 0;
                          by_value[2] *= torque < 0 ? -LoadOf(1, 0) : LoadOf(1, 0);
                          if (!moves) by_value[1] = 0;
                          if (!row.joint) by_value[2] = 0;
                          Put(slopes.levels, {Number::Kind::kLevel, r}, by_value,
                              NumbersOf<kParamCount<FormulaFriction>>(row, 0));
                        });
  }

  void Advance(const mjModel& m, const mjData& d, double* z) override { rows_.Advance(m, d, z); }

 private:
  // What is no number stays so: MuJoCo warns of the acceleration that it makes.
  double LevelAt(const mjModel& m, const mjData& d, const GearTorques& gears,
                 const FrictionRow& row, double v) const {
    const double level = level_(At(m, d, gears, row, v));
    return level < 0 ? 0 : level;
  }
  FormulaValues<FormulaFriction> At(const mjModel& m, const mjData& d, const GearTorques& gears,
                                    const FrictionRow& row, double v) const {
    auto values = ValuesOf<FormulaFriction>(p_);
    values[0] = PositionOf(m, d, row);
    values[1] = v;
    values[2] = row.joint ? LoadOf(gears.At(m, d, row.index, 0), 0) : 0;
    return values;
  }

  FrictionRows rows_;
  Expression level_;
};

}  // namespace continuum
