#include "binding/supply.h"

namespace continuum {

std::vector<int> MatchSupplied(const mjModel& m, const Config& config) {
  return config.MatchFit(Place::kActuator, [&](int a) -> Misfit {
    if (m.actuator_outnum[a] == 1) return {};
    return {"one output", std::to_string(m.actuator_outnum[a]) + " outputs"};
  });
}

ForceInRange InRange(const mjModel& m, int a, double force) {
  using Kind = Number::Kind;
  const double* const range = m.actuator_forcerange + 2 * a;
  if (m.actuator_forcelimited[a] && force < range[0]) return {range[0], {Kind::kRange, 2 * a}};
  if (m.actuator_forcelimited[a] && force > range[1]) return {range[1], {Kind::kRange, 2 * a + 1}};
  return {force, {Kind::kActuator, a}};
}

}  // namespace continuum
