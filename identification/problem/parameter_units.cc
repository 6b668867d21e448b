#include "identification/problem/parameter_units.h"

#include <array>
#include <string_view>
#include <utility>

#include "binding/config.h"
#include "effects/all.h"
#include "sim/model/native_effect.h"

namespace continuum {
namespace {

enum class Motion { kTurn, kLine, kMixed };

Motion MotionOf(const mjModel& m, std::string_view kind, std::string_view globs) {
  if (kind == "tendon") return Motion::kLine;
  if (kind != "joint") return Motion::kTurn;
  bool turns = false, slides = false;
  for (int j = 0; j < m.njnt; ++j) {
    const char* const name = mj_id2name(&m, mjOBJ_JOINT, j);
    if (!name || !AnyGlobMatches(globs, name)) continue;
    turns |= m.jnt_type[j] != mjJNT_SLIDE;
    slides |= m.jnt_type[j] == mjJNT_SLIDE || m.jnt_type[j] == mjJNT_FREE;
  }
  return !slides ? Motion::kTurn : turns ? Motion::kMixed : Motion::kLine;
}

// A unit of turns, read for another motion.
std::string UnitForMotion(std::string unit, Motion motion) {
  using Pair = std::pair<std::string_view, std::string_view>;
  const std::string turn = unit;
  for (const auto& [old, by] : {Pair{"kg*m^2", "kg"}, Pair{"N*m", "N"}, Pair{"rad", "m"}}) {
    if (const std::size_t at = unit.find(old); at != unit.npos) unit.replace(at, old.size(), by);
  }
  if (motion == Motion::kTurn || unit == turn) return turn;
  return motion == Motion::kLine ? unit : "1";
}

std::string PluginUnit(const mjModel& m, const Parameter& p) {
  const int id = mj_name2id(&m, mjOBJ_PLUGIN, p.target.substr(p.target.find(':') + 1).c_str());
  if (id < 0) return "1";
  const Config config(m, id);
  const std::string_view kind = config.Get("tendon").empty() ? "joint" : "tendon";
  const std::string plugin = mjp_getPluginAtSlot(m.plugin[id])->name;
  std::string unit = "1";
  All::ForEach([&]<class E>() {
    if (plugin != "continuum." + std::string(E::kName)) return;
    for (const Param& param : E::kParams) {
      if (param.name != p.attribute) continue;
      // The angles of a path are those at which a cable wraps its contacts.
      const Motion motion = PathLaw<E> ? Motion::kTurn : MotionOf(m, kind, config.Get(kind));
      unit = UnitForMotion(std::string(param.unit), motion);
    }
  });
  return unit;
}

// Whether the first number of the dynamics of all these actuators is the time of a lag.
bool HasLag(const mjModel& m, std::string_view globs) {
  bool lags = false;
  for (int i = 0; i < m.nu; ++i) {
    const char* const name = mj_id2name(&m, mjOBJ_ACTUATOR, i);
    if (!name || !AnyGlobMatches(globs, name)) continue;
    lags = m.actuator_dyntype[i] == mjDYN_FILTER || m.actuator_dyntype[i] == mjDYN_FILTEREXACT;
    if (!lags) return false;
  }
  return lags;
}

// Of MuJoCo's attributes, on what turns.
std::string AttributeUnit(const std::string& name) {
  if (name == "mass" || name == "point_mass") return "kg";
  if (name == "inertia" || name == "fullinertia" || name == "armature") return "kg*m^2";
  if (name == "ref" || name == "springref") return "rad";
  if (name == "pos" || name == "springlength") return "m";
  if (name == "delay" || name == "lag" || name == "timestep") return "s";
  if (name == "gravity") return "m/s^2";
  if (name == "stiffness") return "N*m/rad";
  if (name == "damping") return "N*m*s/rad";
  if (name == "frictionloss") return "N*m";
  return "1";
}

}  // namespace

std::string UnitOn(const mjModel& m, const std::string& unit, std::string_view kind,
                   std::string_view globs) {
  return UnitForMotion(unit, MotionOf(m, kind, globs));
}

std::string UnitOf(const ModelSpec& system, const Parameter& p) {
  if (!p.unit.empty()) return p.unit;
  if (p.operation == Change::Operation::kScale) return "1";
  const mjModel& m = system.model();
  if (p.target.starts_with("plugin:")) return PluginUnit(m, p);
  const std::size_t colon = p.target.find(':');
  const std::string kind = p.target.substr(0, colon);
  const std::string globs = colon == p.target.npos ? "" : p.target.substr(colon + 1);
  if (kind == "actuator" && p.attribute == "dynprm[0]" && HasLag(m, globs)) return "s";
  const Motion motion = MotionOf(m, kind, globs);
  if (IsNativeEffect({p.target, p.attribute}))
    return UnitForMotion(UnitOfNativeEffect(p.attribute), motion);
  return UnitForMotion(AttributeUnit(p.attribute.substr(0, p.attribute.find('['))), motion);
}

}  // namespace continuum
