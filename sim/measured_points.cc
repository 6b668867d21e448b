#include "sim/measured_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "sim/measurement.h"
#include "sim/object_frame.h"
#include "sim/registration.h"

namespace continuum {
namespace {

using Vector = std::array<double, 3>;

// The row in which a late clock shows what another row's time had.
std::size_t RowShown(const Log& log, std::size_t row, double shift) {
  const auto next = std::lower_bound(log.time.begin(), log.time.end(), log.time[row] + shift);
  if (next == log.time.begin()) return 0;
  if (next == log.time.end()) return log.rows() - 1;
  const bool before = log.time[row] + shift - *(next - 1) < *next - log.time[row] - shift;
  return static_cast<std::size_t>(next - log.time.begin()) - (before ? 1 : 0);
}

// What the log says of each position sensor; NaN: not measured.
std::map<int, Vector> PositionsAt(const Experiment& e, const Wiring& wiring, const Log& log,
                                  std::size_t row) {
  constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  std::map<int, Vector> positions;
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const auto& source = wiring.output[e.channels[c].output];
    if (source.seen != Wiring::Source::Seen::kPoint) continue;
    Vector& y =
        positions.try_emplace(source.sensor, Vector{kMissing, kMissing, kMissing}).first->second;
    y[source.component] = SignalOf(e, c, log.measured[c][row]);
  }
  return positions;
}

// R' (y - T): out of the frame of the measurement.
void Unregister(const Registration& r, Vector& y) {
  double quat[4], unit[3] = {-r.rotation[0], -r.rotation[1], -r.rotation[2]};
  const double angle = mju_normalize3(unit);
  mju_axisAngle2Quat(quat, unit, angle);
  mju_subFrom3(y.data(), r.translation.data());
  const Vector shifted = y;
  mju_rotVecQuat(y.data(), shifted.data(), quat);
}

}  // namespace

std::vector<MeasuredPoint> MeasuredPoints(const Experiment& e, const Wiring& wiring, const Log& log,
                                          std::size_t row, const mjModel& m, const mjData& d) {
  std::vector<MeasuredPoint> points;
  const std::size_t shown = RowShown(log, row, e.registration.clock_shift);
  for (auto [sensor, y] : PositionsAt(e, wiring, log, shown)) {
    if (!std::all_of(y.begin(), y.end(), [](double v) { return std::isfinite(v); })) continue;
    MeasuredPoint p;
    Unregister(e.registration, y);
    p.measured = y;
    if (m.sensor_refid[sensor] >= 0) {
      const ObjectFrame reference = FrameOf(d, m.sensor_reftype[sensor], m.sensor_refid[sensor]);
      mju_mulMatVec3(p.measured.data(), reference.axes, y.data());
      mju_addTo3(p.measured.data(), reference.position);
    }
    const ObjectFrame object = FrameOf(d, m.sensor_objtype[sensor], m.sensor_objid[sensor]);
    const Vector offset = OffsetOf(e.registration, mj_id2name(&m, mjOBJ_SENSOR, sensor));
    mju_mulMatVec3(p.simulated.data(), object.axes, offset.data());
    mju_addTo3(p.simulated.data(), object.position);
    points.push_back(p);
  }
  return points;
}

}  // namespace continuum
