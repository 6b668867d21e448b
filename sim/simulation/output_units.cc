#include "sim/simulation/output_units.h"

#include <algorithm>

#include "sim/experiment/measurement_model.h"
#include "sim/io/units.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

// Of a joint's one coordinate; empty: it has several.
std::string OfJoint(const mjModel& m, int joint, const char* turn, const char* slide) {
  const int type = m.jnt_type[joint];
  return type == mjJNT_HINGE ? turn : type == mjJNT_SLIDE ? slide : "";
}
// Of a tendon through sites; empty: one of joints has the unit of its coefficients.
std::string OfTendon(const mjModel& m, int tendon, const char* unit) {
  const int first = m.tendon_adr[tendon];
  return m.tendon_num[tendon] > 0 && m.wrap_type[first] != mjWRAP_JOINT ? unit : "";
}

std::string OfSensor(const mjModel& m, int sensor) {
  const int object = m.sensor_objid[sensor];
  switch (m.sensor_type[sensor]) {
    case mjSENS_JOINTPOS:
      return OfJoint(m, object, "rad", "m");
    case mjSENS_JOINTVEL:
      return OfJoint(m, object, "rad/s", "m/s");
    case mjSENS_JOINTACTFRC:
      return OfJoint(m, object, "Nm", "N");
    case mjSENS_TENDONPOS:
      return OfTendon(m, object, "m");
    case mjSENS_TENDONVEL:
      return OfTendon(m, object, "m/s");
    case mjSENS_FRAMEPOS:
    case mjSENS_SUBTREECOM:
    case mjSENS_RANGEFINDER:
      return "m";
    case mjSENS_FRAMELINVEL:
    case mjSENS_SUBTREELINVEL:
    case mjSENS_VELOCIMETER:
      return "m/s";
    case mjSENS_FRAMEANGVEL:
    case mjSENS_GYRO:
    case mjSENS_BALLANGVEL:
      return "rad/s";
    case mjSENS_FRAMELINACC:
    case mjSENS_ACCELEROMETER:
      return "m/s^2";
    case mjSENS_FORCE:
    case mjSENS_TOUCH:
      return "N";
    case mjSENS_TORQUE:
      return "Nm";
    default:
      return "";
  }
}

// An output whose scale is given or sought may be in the unit of the sensor's signal.
bool IsScaled(const Experiment& e, const Output& out) {
  if (out.measurement.scale != 1) return true;
  return std::any_of(e.parameters.begin(), e.parameters.end(), [](const Parameter& p) {
    return p.attribute == "scale" && IsMeasurement(p.target, p.attribute);
  });
}

}  // namespace

void CheckUnits(const Experiment& e, const mjModel& m) {
  const Wiring wiring(e, m);
  for (std::size_t i = 0; i < e.outputs.size(); ++i) {
    const Output& out = e.outputs[i];
    const auto& source = wiring.output[i];
    if (source.kind != Output::Kind::kSensor || IsScaled(e, out) || out.quaternion()) continue;
    const std::string expected = OfSensor(m, source.sensor);
    if (!expected.empty()) RequireUnitLike(expected, out.unit, out.where + ".unit");
  }
}

}  // namespace continuum
