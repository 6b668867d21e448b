#include "identification/candidates/parameter_size.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "error.h"
#include "identification/candidates/unit_powers.h"

namespace continuum {
namespace {

// Sizes as the coordinates of a place have them.
struct LocalSizes {
  const Sizes& all;
  Place place;
  bool line = place == Place::kTendon;
  double force = line ? all.tension : all.torque;
  double lever = line ? all.torque / all.tension : 1;  ///< makes a torque of a tension
  double angle = lever * all.angle;
  double velocity = lever * all.velocity;
  bool part = place == Place::kBody || place == Place::kSite;  ///< where a force acts at a distance
};

using SizeRule = ParameterSize (*)(const LocalSizes&);

ParameterSize Slope(const LocalSizes& s) { return {s.force / (0.02 * s.lever * s.all.angle)}; }
ParameterSize Force(const LocalSizes& s) { return {s.force}; }

// A light robot of many links carries more than a few of them weigh; and whatever a model weighs,
// its machine may carry what the forces on it lift.
ParameterSize Mass(const LocalSizes& s) {
  constexpr double kGravity = 9.81;  // m/s^2
  const double lifted = s.all.torque / (kGravity * (s.part ? s.all.lever : 1));
  return {s.all.mass, 5 * std::max(s.all.robot, lifted) / s.all.mass};
}

// Units whose size is not the product of those of their factors: a spring is felt within a
// fiftieth of the range, a delay lasts a few samples.
const std::map<Powers, SizeRule>& Rules() {
  using Local = const LocalSizes&;
  using Size = ParameterSize;
  static const std::map<Powers, SizeRule> rules{
      {PowersOf("1"),
       [](Local) {
         return Size{1, 10, 0.1};
       }},
      {PowersOf("N"), [](Local s) { return Size{s.part ? s.force / s.all.lever : s.force}; }},
      {PowersOf("N*m"), Force},
      {PowersOf("rad"),
       [](Local s) {
         return Size{s.angle, 3, 0.02};
       }},
      {PowersOf("rad/s"),
       [](Local s) {
         return Size{s.place == Place::kActuator ? 0.25 / s.all.period : s.velocity};
       }},
      {PowersOf("N*m*s/rad"), [](Local s) { return Size{s.force / s.velocity}; }},
      {PowersOf("N*m/rad"), Slope},
      {PowersOf("N/m"), Slope},
      // The angle is a range over all joints, and its cube much larger than that of any one motion.
      {PowersOf("N*m/rad^3"),
       [](Local s) {
         return Size{s.all.torque / std::pow(s.all.angle, 3), 100};
       }},
      {PowersOf("kg"), Mass},
      {PowersOf("kg*m^2"), [](Local s) { return Size{s.all.inertia}; }},
      {PowersOf("1/rad"), [](Local s) { return Size{50 / s.angle}; }},
      {PowersOf("m/N"), [](Local s) { return Size{0.01 / s.all.tension}; }},
      {PowersOf("s"), [](Local s) {
         return Size{4 * s.all.period, 25, 0.125};
       }}};
  return rules;
}

// The product of the sizes of a unit's factors. Newtons come as N*m, so that a force without that
// metre is a torque over a length; a second is the time in which the angle is passed.
double Product(const Powers& powers, const LocalSizes& s, const Param& p) {
  const std::map<std::string, double> factors{
      {"N", s.force / s.all.length}, {"m", s.all.length},   {"kg", s.all.mass}, {"rad", s.angle},
      {"s", s.angle / s.velocity},   {"input", s.all.input}};
  double product = 1;
  for (const auto& [name, power] : powers) {
    const auto found = factors.find(name);
    if (found == factors.end()) {
      throw Error::Input("parameter " + std::string(p.name) + " of a candidate",
                         "a unit made of 1 N J m kg s rad input", "'" + std::string(p.unit) + "'");
    }
    product *= std::pow(found->second, power);
  }
  return product;
}

}  // namespace

ParameterSize SizeAlongCable(const Param& param, const Sizes& sizes) {
  // The cable wraps a contact by as much as the joint beside it turns.
  const LocalSizes local{sizes, Place::kJoint};
  const Powers powers = PowersOf(param.unit);
  const auto rule = Rules().find(powers);
  return powers.empty() && rule != Rules().end() ? rule->second(local)
                                                 : ParameterSize{Product(powers, local, param)};
}

ParameterSize SizeOf(const Param& param, Place place, const Sizes& sizes) {
  const LocalSizes local{sizes, place};
  const Powers powers = PowersOf(param.unit);
  const auto rule = Rules().find(powers);
  return rule != Rules().end() ? rule->second(local) : ParameterSize{Product(powers, local, param)};
}

}  // namespace continuum
