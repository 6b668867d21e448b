#include "identification/sensitivity/effect_derivatives.h"

#include <algorithm>
#include <limits>

#include "binding/effect_catalog.h"
#include "engine.h"
#include "sim/model/mujoco_handles.h"

namespace continuum {
namespace {

using Kind = Number::Kind;
using Group = EffectDerivatives::Group;

Group GroupOf(const EffectInfo& info) {
  if (!info.tap) return Group::kOthers;
  return info.tap == Tap::kInput ? Group::kInputs : Group::kDrives;
}

bool UsesActuators(const EffectInfo& info) {
  using Of = EffectInfo::Kind;
  return info.kind == Of::kSignal || info.kind == Of::kSegment || info.kind == Of::kPath;
}

const std::vector<double>& ParametersOf(const ModelAndData& machine, int instance) {
  return BoundOf(*machine.model, *machine.data, instance).parameters();
}

}  // namespace

std::string EffectDerivatives::Obstacle(const mjModel& m, const mjData& d) {
  const int off = mjDSBL_SPRING | mjDSBL_DAMPER;
  if (m.nplugin > 0 && (m.opt.disableflags & off) == off) return "there are no passive forces";
  int cables = 0;
  for (int i = 0; i < m.nplugin; ++i) {
    const std::string name = "effect " + Called(m, mjOBJ_PLUGIN, i);
    if (!EffectOf(m, i)) return name + " is a plugin of others";
    const std::string why = BoundOf(m, d, i).WhyNoSlopes(m);
    if (!why.empty()) return name + ": " + why;
    cables += BoundOf(m, d, i).NeedsAllForces();
    if (cables > 1) return name + ": several cause friction of cables";
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
    const EffectInfo& info = *EffectOf(m, i);
    const bool row = info.kind == EffectInfo::Kind::kFriction;
    instances_.push_back({i, GroupOf(info), row, static_cast<int>(here.size()), {}});
    uses_actuators_ |= UsesActuators(info);
    for (const double p : ParametersOf(machine, i)) here.push_back(p);
    for (std::size_t c = 0; c < perturbed.size(); ++c) {
      for (const double p : ParametersOf(*perturbed[c], i)) there[c].push_back(p);
    }
  }
  // As the engine orders them: as their plugins are registered.
  std::stable_sort(instances_.begin(), instances_.end(),
                   [&](const auto& a, const auto& b) { return m.plugin[a.id] < m.plugin[b.id]; });
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
  tendon_stiffness_ = ArrayTangents(m, perturbed, move, &mjModel::tendon_stiffness, m.ntendon);
  tendon_damping_ = ArrayTangents(m, perturbed, move, &mjModel::tendon_damping, m.ntendon);
}

void EffectDerivatives::Update(Group group, const mjModel& m, const mjData& d,
                               const StepTaken& step) {
  for (Instance& instance : instances_) {
    if (instance.group != group) continue;
    instance.slopes.Clear();
    StepTaken own = step;
    own.z += state_[instance.id];
    BoundOf(m, d, instance.id).Differentiate(m, d, own, instance.slopes);
  }
}

void EffectDerivatives::KeepGiven(std::span<double> force) const {
  std::vector<bool> changed(force.size());
  for (const Instance& instance : instances_) {
    for (const Slope& slope : instance.slopes.signals) {
      if (slope.of.kind == Kind::kInput || slope.of.kind == Kind::kActuatorNext)
        changed[slope.of.index] = true;
    }
  }
  for (std::size_t a = 0; a < force.size(); ++a) {
    if (!changed[a]) force[a] = std::numeric_limits<double>::quiet_NaN();
  }
}

CableDerivatives::Law EffectDerivatives::Cable(const mjModel& m, const mjData& d,
                                               const double* state) const {
  for (const Instance& instance : instances_) {
    const int first = state_[instance.id];
    if (const auto* law = dynamic_cast<const CableFriction*>(&BoundOf(m, d, instance.id)))
      return {law, state + first, first, instance.parameter};
  }
  return {};
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
  numbers.tendon_stiffness = tendon_stiffness_;
  numbers.tendon_damping = tendon_damping_;
}

bool EffectDerivatives::Reads(Number::Kind kind) const {
  for (const Instance& instance : instances_) {
    for (const Slope& slope : instance.slopes.levels) {
      if (slope.by.kind == kind) return true;
    }
  }
  return false;
}

// Each drive sees the forces that the one before it has left.
void EffectDerivatives::AddSignals(Group group, NumberTangents& numbers) const {
  for (const Instance& instance : instances_) {
    if (instance.group != group) continue;
    numbers[Kind::kActuatorNext] = numbers[Kind::kActuator];
    numbers.SetScratch(instance.slopes.scratch);
    Apply(instance, instance.slopes.signals, numbers);
    numbers[Kind::kActuator].swap(numbers[Kind::kActuatorNext]);
  }
}

void EffectDerivatives::AddForces(NumberTangents& numbers, bool rows) const {
  for (const Instance& instance : instances_) {
    if (instance.row != rows) continue;
    numbers.SetScratch(instance.slopes.scratch);
    Apply(instance, instance.slopes.forces, numbers);
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
