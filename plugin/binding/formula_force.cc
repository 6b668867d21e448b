#include "binding/formula_force.h"

#include <algorithm>
#include <cmath>

#include "binding/actuator_force.h"
#include "error.h"

namespace continuum {
namespace {

constexpr std::size_t kVariables = Formula::kVariables.size();
constexpr std::size_t kHeatTime = kParamCount<Formula> - 1;
constexpr char kTwin[] = "other";

bool IsHingeOrSlide(const mjModel& m, int joint) {
  return m.jnt_type[joint] == mjJNT_HINGE || m.jnt_type[joint] == mjJNT_SLIDE;
}

}  // namespace

BoundFormula::BoundFormula(const mjModel& m, const Config& config)
    : BoundLaw(ReadParams<Formula>(config)),
      lines_(LinesOf(m, config, JointsOf<Formula>())),
      force_(ReadFormula<Formula>(config, OtherNames(config))) {
  RequireJoints(config);
  FindOthers(m, config);
  values_.resize(kVariables + p_.size() + others_.size());
}

int BoundFormula::StateSize(const mjModel& m, const Config& config) {
  const Expression force = ReadFormula<Formula>(config, OtherNames(config));
  if (!force.Uses(kHeat)) return 0;
  return static_cast<int>(LinesOf(m, config, JointsOf<Formula>()).size());
}

// "q[knee]": those of variables that another joint has too.
std::vector<std::string> BoundFormula::OtherNames(const Config& config) {
  std::vector<std::string> names = Expression::BracketNames(config.Get(Formula::kText));
  std::erase_if(names, [](const std::string& name) {
    const std::string base = name.substr(0, name.find('['));
    const auto last = Formula::kVariables.begin() + Formula::kOfOthers;
    return std::find(Formula::kVariables.begin(), last, base) == last;
  });
  return names;
}

void BoundFormula::RequireJoints(const Config& config) const {
  for (const Variable v : {kMotor, kWeight, kHeat}) {
    if (!Uses(v) || lines_.empty() || lines_.front().joint) continue;
    throw Error::Input(config.Who() + ": " + std::string(Formula::kText),
                       "a joint for " + std::string(Formula::kVariables[v]), "a tendon");
  }
  if (Uses(kHeat) && config.Get(Formula::kHeatTime).empty())
    throw Error::Input(config.Who(), "the key 'heat_time' for heat", "none");
}

void BoundFormula::FindOthers(const mjModel& m, const Config& config) {
  for (const std::string& name : OtherNames(config)) {
    const std::size_t open = name.find('[');
    const std::string joint = name.substr(open + 1, name.size() - open - 2);
    Other other{name.substr(0, open) == Formula::kVariables[kSpeed], false,
                config.Find(Place::kJoint, joint)};
    const bool two = lines_.size() == 2 && lines_.front().joint;
    other.twin = other.joint < 0 && joint == kTwin && two;
    if (!other.twin && (other.joint < 0 || !IsHingeOrSlide(m, other.joint))) {
      throw Error::Input(
          config.Who() + ": " + std::string(Formula::kText) + ": " + name,
          joint == kTwin ? "a law on two joints" : "a hinge or slide joint of the model",
          joint == kTwin    ? std::to_string(lines_.size())
          : other.joint < 0 ? "no joint '" + joint + "'"
                            : std::string(JointType(m.jnt_type[other.joint])));
    }
    others_.push_back(other);
  }
}

int BoundFormula::JointOf(const Other& other, std::size_t line) const {
  return other.twin ? lines_[1 - line].id : other.joint;
}

void BoundFormula::SetValues(const mjModel& m, const mjData& d, const double* z,
                             const GearTorques& gears, std::size_t i,
                             std::vector<double>& values) const {
  const Line& line = lines_[i];
  values[kPosition] = line.joint ? d.qpos[m.jnt_qposadr[line.id]] : d.ten_length[line.id];
  values[kSpeed] = line.joint ? d.qvel[line.dof] : d.ten_velocity[line.id];
  values[kMotor] = Uses(kMotor) ? gears.At(m, d, line.dof, 1) : 0;
  values[kWeight] = Uses(kWeight) ? WeightTorque(m, d, line.dof) : 0;
  values[kTime] = d.time;
  values[kHeat] = Uses(kHeat) && z ? z[i] : 0;
  auto next = std::copy(p_.begin(), p_.end(), values.begin() + kVariables);
  for (const Other& other : others_) {
    const int joint = JointOf(other, i);
    *next++ = other.speed ? d.qvel[m.jnt_dofadr[joint]] : d.qpos[m.jnt_qposadr[joint]];
  }
}

// What the actuators do is known behind them.
bool BoundFormula::Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                            std::span<double> force) {
  const bool behind = Uses(kMotor) && !IsUnactuated(m);
  if (stage != (behind ? Stage::kActuator : Stage::kPassive)) return false;
  const GearTorques gears = behind ? GearTorques(m, d) : GearTorques(m);
  std::fill(force.begin(), force.end(), 0.0);
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    SetValues(m, d, z, gears, i, values_);
    lines_[i].Add(m, d, -force_(values_), force);
  }
  return true;
}

// Exactly at a constant torque of the motor.
void BoundFormula::Advance(const mjModel& m, const mjData& d, double* z) {
  if (!Uses(kHeat)) return;
  const GearTorques gears = IsUnactuated(m) ? GearTorques(m) : GearTorques(m, d);
  const double keeps = std::exp(-m.opt.timestep / p_[kHeatTime]);
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const double motor = gears.At(m, d, lines_[i].dof, 1);
    z[i] = motor * motor + (z[i] - motor * motor) * keeps;
  }
}

std::string BoundFormula::WhyNoSlopes(const mjModel&) const {
  for (const Variable v : {kMotor, kWeight, kHeat}) {
    if (Uses(v)) return "it has " + std::string(Formula::kVariables[v]);
  }
  return "";
}

std::vector<Number> BoundFormula::NumbersOf(const mjModel& m, std::size_t i) const {
  using Kind = Number::Kind;
  const Line& line = lines_[i];
  std::vector<Number> numbers(kVariables, {Kind::kScratch, 0});  // of the others there are none
  numbers[kPosition] =
      line.joint ? Number{Kind::kPosition, line.dof} : Number{Kind::kLength, line.id};
  numbers[kSpeed] = line.joint ? Number{Kind::kSpeed, line.dof} : Number{Kind::kRate, line.id};
  for (std::size_t p = 0; p < p_.size(); ++p)
    numbers.push_back({Kind::kParameter, static_cast<int>(p)});
  for (const Other& other : others_) {
    numbers.push_back(
        {other.speed ? Kind::kSpeed : Kind::kPosition, m.jnt_dofadr[JointOf(other, i)]});
  }
  return numbers;
}

void BoundFormula::Differentiate(const mjModel& m, const mjData& d, const StepTaken&,
                                 LawSlopes& slopes) const {
  std::vector<double> values(values_.size()), by_value(values_.size());
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    SetValues(m, d, nullptr, {}, i, values);
    values[kTime] -= m.opt.timestep;  // the step has been taken
    const double force = force_.Differentiate(values, by_value);
    by_value[kTime] = 0;  // nothing moves it
    const auto numbers = NumbersOf(m, i);
    const Number of =
        line.joint ? Number{Number::Kind::kForce, line.dof} : Number{Number::Kind::kPull, line.id};
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (by_value[k] != 0) slopes.forces.push_back({of, numbers[k], -by_value[k]});
    }
    if (!line.joint) slopes.pulls.push_back({line.id, -force});
  }
}

}  // namespace continuum
