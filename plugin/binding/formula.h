#pragma once

#include "binding/expression.h"
#include "binding/force.h"
#include "binding/friction.h"
#include "effects/formula.h"

namespace continuum {

/// The formula of an instance, of its law's variables and then its parameters.
template <FormulaLaw E>
Expression ReadFormula(const Config& config) {
  const std::string key(E::kText);
  if (config.Get(key).empty()) throw Error::Input(config.Who(), "the key '" + key + "'", "none");
  std::vector<std::string> names(E::kVariables.begin(), E::kVariables.end());
  for (const Param& p : E::kParams) names.emplace_back(p.name);
  return {config.Get(key), names, config.Who() + ": " + key};
}

/// The values of a formula's variables and parameters.
template <FormulaLaw E>
using FormulaValues = Vec<double, E::kVariables.size() + kParamCount<E>>;

template <FormulaLaw E>
FormulaValues<E> ValuesOf(const std::vector<double>& p) {
  FormulaValues<E> values{};
  std::copy(p.begin(), p.end(), values.begin() + E::kVariables.size());
  return values;
}

/// A written force on joints or tendons.
class BoundFormula : public BoundLaw {
 public:
  BoundFormula(const mjModel& m, const Config& config)
      : BoundLaw(ReadParams<Formula>(config)),
        lines_(LinesOf(m, config, JointsOf<Formula>())),
        force_(ReadFormula<Formula>(config)) {}
  static int StateSize(const mjModel&, const Config&) { return 0; }

  bool GivesForce() const override { return true; }

  bool Evaluate(const mjModel& m, mjData& d, const double*, Stage stage,
                std::span<double> force) override {
    if (stage != Stage::kPassive) return false;
    std::fill(force.begin(), force.end(), 0.0);
    auto values = ValuesOf<Formula>(p_);
    for (const Line& line : lines_) {
      values[0] = line.joint ? d.qpos[m.jnt_qposadr[line.id]] : d.ten_length[line.id];
      values[1] = line.joint ? d.qvel[line.dof] : d.ten_velocity[line.id];
      line.Add(m, d, -force_(values), force);
    }
    return true;
  }

 private:
  std::vector<Line> lines_;
  Expression force_;
};

/// A written dry friction on joints or tendons, as rows.
class BoundFormulaFriction : public BoundLaw {
 public:
  BoundFormulaFriction(const mjModel& m, const Config& config, int instance)
      : BoundLaw(ReadParams<FormulaFriction>(config)),
        rows_(m, config, JointsOf<FormulaFriction>(), instance),
        level_(ReadFormula<FormulaFriction>(config)) {}
  static int StateSize(const mjModel& m, const Config& config) {
    return FrictionRows::StateSize(m, config, JointsOf<FormulaFriction>());
  }

  bool IsRow() const override { return true; }
  void Impose(mjModel& m) const override { rows_.Impose(m); }

  bool Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                std::span<double>) override {
    auto values = ValuesOf<FormulaFriction>(p_);
    rows_.Write(m, d, z, stage, [&](const FrictionRow& row, double v) {
      values[0] = row.joint ? d.qpos[m.jnt_qposadr[row.id]] : d.ten_length[row.index];
      values[1] = v;
      values[2] = row.joint ? GearLoad(m, d, row.index, 0) : 0;
      return std::max(0.0, level_(values));
    });
    return false;
  }

  void Advance(const mjModel& m, const mjData& d, double* z) override { rows_.Advance(m, d, z); }

 private:
  FrictionRows rows_;
  Expression level_;
};

}  // namespace continuum
