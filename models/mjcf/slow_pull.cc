#include "models/mjcf/slow_pull.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "sim/io/decimal.h"

namespace continuum {
namespace {

int Find(const mjModel& m, mjtObj kind, const std::string& name, const std::string& what) {
  const int id = mj_name2id(&m, kind, name.c_str());
  if (id < 0) throw Error::Input(what, "a name of the model", "'" + name + "'");
  return id;
}

void SetLoads(mjModel& m, mjData& d, const SlowPull& pull, double share) {
  for (const auto& [actuator, value] : pull.control) {
    d.ctrl[Find(m, mjOBJ_ACTUATOR, actuator, "actuator")] = share * value;
  }
  for (int i = 0; i < 3; ++i) m.opt.gravity[i] = share * pull.gravity[i];
}

double Fastest(const mjModel& m, const mjData& d) {
  double fastest = 0;
  for (int i = 0; i < m.nv; ++i) fastest = std::max(fastest, std::abs(d.qvel[i]));
  return fastest;
}

}  // namespace

void Pull(const ModelAndData& machine, const SlowPull& pull) {
  mjModel& m = *machine.model;
  mjData& d = *machine.data;
  const double begin = d.time, end = begin + pull.rise;
  for (double moved = end; d.time < moved + pull.quiet;) {
    const double left = std::max(0.0, (end - d.time) / pull.rise);
    SetLoads(m, d, pull, 1 - left * left * left);
    mj_step(&m, &d);
    const double fastest = Fastest(m, d);
    if (d.time > end && fastest > pull.still) moved = d.time;
    if (d.warning[mjWARN_BADQACC].number > 0) throw Error::Job("the slow pull diverges");
    if (d.time > end + pull.longest) {
      throw Error::Job("no rest after the slow pull: a joint moves at " + Decimal(fastest) +
                       " rad/s, more than " + Decimal(pull.still));
    }
  }
  mj_forward(&m, &d);
}

std::array<double, 3> SensedPoint(const ModelAndData& machine, const std::string& sensor) {
  const mjModel& m = *machine.model;
  const double* const at =
      machine.data->sensordata + m.sensor_adr[Find(m, mjOBJ_SENSOR, sensor, "sensor")];
  return {at[0], at[1], at[2]};
}

}  // namespace continuum
