#include "binding/filter.h"

#include "binding/actuator_type.h"
#include "mujoco_compat.h"

namespace continuum {
namespace {

bool IsLag(int dynamics) { return dynamics == mjDYN_FILTER || dynamics == mjDYN_FILTEREXACT; }

bool IsUsable(const mjModel& m, int a) {
  const int dynamics = m.actuator_dyntype[a];
  return m.actuator_ctrlnum[a] == 1 && m.actuator_outnum[a] == 1 &&
         m.actuator_gaintype[a] == mjGAIN_FIXED && !m.actuator_actearly[a] &&
         (dynamics == mjDYN_NONE || dynamics == mjDYN_INTEGRATOR || IsLag(dynamics));
}

std::string Found(const mjModel& m, int a) {
  if (m.actuator_ctrlnum[a] != 1) return std::to_string(m.actuator_ctrlnum[a]) + " controls";
  if (m.actuator_outnum[a] != 1) return std::to_string(m.actuator_outnum[a]) + " outputs";
  if (m.actuator_actearly[a]) return "actearly=\"true\"";
  return ActuatorType(m.actuator_gaintype[a], m.actuator_biastype[a], m.actuator_dyntype[a]);
}

}  // namespace

double ActuatorInput::Control(const mjModel& m, const mjData& d) const {
  const double value = ReadControl(m, d, actuator);
  const int u = m.actuator_ctrladr[actuator];
  if (!m.actuator_ctrllimited[u] || (m.opt.disableflags & mjDSBL_CLAMPCTRL)) return value;
  return std::clamp(value, m.actuator_ctrlrange[2 * u], m.actuator_ctrlrange[2 * u + 1]);
}

void ActuatorInput::Shift(const mjModel& m, mjData& d, double change) const {
  const int dynamics = m.actuator_dyntype[actuator];
  if (dynamics == mjDYN_NONE) {
    d.actuator_force[m.actuator_outadr[actuator]] +=
        m.actuator_gainprm[mjNGAIN * actuator] * change;
    return;
  }
  const double T = std::max(mjMINVAL, m.actuator_dynprm[mjNDYN * actuator]);
  d.act_dot[m.actuator_actadr[actuator]] += IsLag(dynamics) ? change / T : change;
}

std::vector<ActuatorInput> MatchInputs(const mjModel& m, const Config& config) {
  const auto judge = [&](int a) -> Misfit {
    if (IsUsable(m, a)) return {};
    return {"one control with a fixed gain, without dynamics or through a lag or an integrator",
            Found(m, a)};
  };
  std::vector<ActuatorInput> inputs;
  for (const int a : config.MatchFit(Place::kActuator, judge)) inputs.push_back({a});
  return inputs;
}

}  // namespace continuum
