#include "identification/sensitivity/effect_derivatives.h"

#include "binding/effect_catalog.h"
#include "engine.h"
#include "sim/model/mujoco_handles.h"

namespace continuum {
namespace {

const std::vector<double>& ParametersOf(const ModelAndData& machine, int instance) {
  return BoundOf(*machine.model, *machine.data, instance).parameters();
}

}  // namespace

std::string EffectDerivatives::Obstacle(const mjModel& m, const mjData& d) {
  for (int i = 0; i < m.nplugin; ++i) {
    const std::string name = "effect " + Called(m, mjOBJ_PLUGIN, i);
    if (!EffectOf(m, i)) return name + " is a plugin of others";
    const std::string why = BoundOf(m, d, i).WhyNoSlopes(m);
    if (!why.empty()) return name + ": " + why;
  }
  return "";
}

EffectDerivatives::EffectDerivatives(const ModelAndData& machine,
                                     std::span<const ModelAndData* const> perturbed, double move) {
  const mjModel& m = *machine.model;
  state_.assign(m.plugin_stateadr, m.plugin_stateadr + m.nplugin);
  std::vector<double> here;
  std::vector<std::vector<double>> there(perturbed.size());
  for (int i = 0; i < m.nplugin; ++i) {
    instances_.push_back({i,
                          EffectOf(m, i)->kind == EffectInfo::Kind::kFriction,
                          static_cast<int>(here.size()),
                          {}});
    for (const double p : ParametersOf(machine, i)) here.push_back(p);
    for (std::size_t c = 0; c < perturbed.size(); ++c) {
      for (const double p : ParametersOf(*perturbed[c], i)) there[c].push_back(p);
    }
  }
  parameters_.resize(std::ssize(here), std::ssize(perturbed));
  for (Eigen::Index c = 0; c < parameters_.cols(); ++c) {
    for (Eigen::Index k = 0; k < parameters_.rows(); ++k) {
      const double from = here[k], to = there[c][k];
      parameters_(k, c) = from == to ? 0 : (to - from) / move;  // both may be infinite
    }
  }
  // Of hinges and slides, whose positions are numbered as their speeds are.
  spring_rest_ = ArrayTangents(m, perturbed, move, &mjModel::qpos_spring, m.nv);
  tendon_rest_ = ArrayTangents(m, perturbed, move, &mjModel::tendon_lengthspring, 2 * m.ntendon);
}

void EffectDerivatives::Update(const mjModel& m, const mjData& d, const double* state,
                               const double* qpos_after, const double* qvel_after) {
  for (Instance& instance : instances_) {
    instance.slopes.Clear();
    BoundOf(m, d, instance.id)
        .Differentiate(m, d, {state + state_[instance.id], qpos_after, qvel_after},
                       instance.slopes);
  }
}

void EffectDerivatives::AddPulls(std::span<double> pull) const {
  for (const Instance& instance : instances_) {
    for (const auto& [tendon, value] : instance.slopes.pulls) pull[tendon] += value;
  }
}

void EffectDerivatives::WriteConstants(NumberTangents& numbers) const {
  numbers[Number::Kind::kParameter] = parameters_;
  numbers[Number::Kind::kSpringRest] = spring_rest_;
  numbers[Number::Kind::kTendonRest] = tendon_rest_;
}

bool EffectDerivatives::Reads(Number::Kind kind) const {
  for (const Instance& instance : instances_) {
    for (const Slope& slope : instance.slopes.levels) {
      if (slope.by.kind == kind) return true;
    }
  }
  return false;
}

void EffectDerivatives::AddForces(NumberTangents& numbers, bool rows) const {
  for (const Instance& instance : instances_) {
    if (instance.row == rows) Apply(instance, instance.slopes.forces, numbers);
  }
}

void EffectDerivatives::AddLevels(NumberTangents& numbers) const {
  for (const Instance& instance : instances_) Apply(instance, instance.slopes.levels, numbers);
}

void EffectDerivatives::AddNext(NumberTangents& numbers) const {
  for (const Instance& instance : instances_) Apply(instance, instance.slopes.next, numbers);
}

void EffectDerivatives::Apply(const Instance& instance, const std::vector<Slope>& slopes,
                              NumberTangents& numbers) const {
  using Kind = Number::Kind;
  const auto row = [&](const Number& number) {
    const bool state = number.kind == Kind::kState || number.kind == Kind::kNext;
    const int first = state                             ? state_[instance.id]
                      : number.kind == Kind::kParameter ? instance.parameter
                                                        : 0;
    return numbers[number.kind].row(first + number.index);
  };
  for (const Slope& slope : slopes) row(slope.of) += slope.value * row(slope.by);
}

}  // namespace continuum
