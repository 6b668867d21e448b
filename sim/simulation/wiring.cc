#include "sim/simulation/wiring.h"

#include <charconv>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "error.h"

namespace continuum {
namespace {

std::string NamesOf(const mjModel& m, mjtObj type, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) {
    if (const char* name = mj_id2name(&m, type, i))
      all += (all.empty() ? "" : ", ") + std::string(name);
  }
  return all.empty() ? "none" : all;
}

std::string Located(const std::string& where, const std::string& what) {
  return where.empty() ? what : where + ": " + what;
}

int ActuatorId(const mjModel& m, const std::string& name, const std::string& where) {
  const int id = mj_name2id(&m, mjOBJ_ACTUATOR, name.c_str());
  if (id >= 0) return id;
  throw Error::Input(Located(where, "actuator '" + name + "'"), "an actuator of the model",
                     NamesOf(m, mjOBJ_ACTUATOR, static_cast<int>(m.nactuator)));
}

// "[12]" → 12; -1 when it is none.
int Index(std::string_view text) {
  int index = -1;
  if (!text.starts_with('[') || !text.ends_with(']')) return index;
  text = text.substr(1, text.size() - 2);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  return error == std::errc{} && end == text.data() + text.size() ? index : -1;
}

// "servo", or "servo[1]" where it has several controls: the actuator and the address of its
// control.
std::pair<int, int> ControlOf(const mjModel& m, const std::string& written,
                              const std::string& where) {
  std::string name = written;
  int control = -1;
  const std::size_t open = name.rfind('[');
  if (mj_name2id(&m, mjOBJ_ACTUATOR, name.c_str()) < 0 && open != name.npos) {
    control = Index(name.substr(open));
    if (control >= 0) name.resize(open);
  }
  const int id = ActuatorId(m, name, where), count = m.actuator_ctrlnum[id];
  if (control < 0 && count == 1) control = 0;
  if (control >= 0 && control < count) return {id, m.actuator_ctrladr[id] + control};
  throw Error::Input(Located(where, "actuator '" + written + "'"),
                     count > 0 ? "one of its controls, '" + name + "[0]' to '" + name + "[" +
                                     std::to_string(count - 1) + "]'"
                               : "an actuator with a control",
                     std::to_string(count) + (count == 1 ? " control" : " controls"));
}

// A turn needs something that has a direction: a vector of three or a quaternion.
void CheckTurn(const Output& out, int dim) {
  if (out.measurement.angle == 0 || dim == 3 || out.quaternion()) return;
  throw Error::Input(out.where + ".angle", "a turn of a vector or a quaternion",
                     "sensor '" + out.source + "' with " + std::to_string(dim) +
                         (dim == 1 ? " number" : " numbers"));
}

Wiring::Source::Geometry GeometryOf(int type) {
  using Geometry = Wiring::Source::Geometry;
  switch (type) {
    case mjSENS_FRAMEPOS:
      return Geometry::kPoint;
    case mjSENS_FRAMEQUAT:
      return Geometry::kRotation;
    case mjSENS_FRAMEXAXIS:
    case mjSENS_FRAMEYAXIS:
    case mjSENS_FRAMEZAXIS:
    case mjSENS_FRAMELINVEL:
    case mjSENS_FRAMEANGVEL:
    case mjSENS_FRAMELINACC:
    case mjSENS_FRAMEANGACC:
    case mjSENS_SUBTREELINVEL:
      return Geometry::kVector;
    default:
      return Geometry::kNone;
  }
}

// "tip_pos[1]" → sensor and component; the whole sensor is recorded, so that it can be turned.
Wiring::Source SensorSource(const mjModel& m, const Output& out) {
  std::string name = out.source;
  int component = 0;
  int id = mj_name2id(&m, mjOBJ_SENSOR, name.c_str());
  const std::size_t open = name.rfind('[');
  if (id < 0 && open != name.npos && Index(name.substr(open)) >= 0) {
    component = Index(name.substr(open));
    name.resize(open);
    id = mj_name2id(&m, mjOBJ_SENSOR, name.c_str());
  } else if (id >= 0 && m.sensor_dim[id] > 1 && !out.quaternion()) {
    throw Error::Input(Located(out.where, "sensor '" + name + "'"),
                       "a component such as '" + name + "[0]'", "none");
  }
  if (id < 0) {
    throw Error::Input(Located(out.where, "sensor '" + out.source + "'"), "a sensor of the model",
                       NamesOf(m, mjOBJ_SENSOR, static_cast<int>(m.nsensor)));
  }
  const int dim = m.sensor_dim[id];
  if (component >= dim || (out.quaternion() && dim != 4)) {
    throw Error::Input(
        Located(out.where, "sensor '" + out.source + "'"),
        out.quaternion() ? "a quaternion" : "a component below " + std::to_string(dim),
        out.quaternion() ? std::to_string(dim) + " numbers" : std::to_string(component));
  }
  CheckTurn(out, dim);
  return {
      Output::Kind::kSensor, m.sensor_adr[id], dim, component, GeometryOf(m.sensor_type[id]), id};
}

// A marker belongs to a position that is measured.
void CheckMarkers(const Experiment& e, const mjModel& m, const Wiring& wiring) {
  std::set<std::string> points;
  std::string all;
  for (const auto& source : wiring.output) {
    if (source.geometry != Wiring::Source::Geometry::kPoint) continue;
    const std::string name = mj_id2name(&m, mjOBJ_SENSOR, source.sensor);
    if (points.insert(name).second) all += (all.empty() ? "" : ", ") + name;
  }
  for (const auto& [sensor, offset] : e.registration.offset) {
    if (sensor.empty() ? points.empty() : !points.contains(sensor)) {
      throw Error::Input(Located(e.file.string(), "registration.marker"),
                         "a position sensor (framepos) of the outputs",
                         "'" + sensor + "' (" + (all.empty() ? "there is none" : all) + ")");
    }
  }
}

}  // namespace

Wiring::Wiring(const Experiment& e, const mjModel& m) {
  for (const Input& in : e.inputs) {
    const auto [id, address] = ControlOf(m, in.actuator, in.where);
    actuator.push_back(id), control.push_back(address);
    gated.push_back(!in.enable.empty());
  }
  for (const Output& out : e.outputs) {
    if (out.kind == Output::Kind::kSensor) {
      output.push_back(SensorSource(m, out));
    } else if (out.kind == Output::Kind::kControl) {
      output.push_back({out.kind, ControlOf(m, out.source, out.where).second, 1, 0});
    } else {
      const int id = ActuatorId(m, out.source, out.where);
      output.push_back({out.kind, m.actuator_outadr[id], 1, 0});
    }
  }
  CheckMarkers(e, m, *this);
  marked = e.registration.has_marker();
}

}  // namespace continuum
