#include "sim/film/measured_points.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/experiment/measurement_model.h"
#include "sim/experiment/registration.h"
#include "sim/model/object_frame.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

using Vector = std::array<double, 3>;

// The row in which a late clock shows what another row's time had.
std::size_t RowOfClock(const Log& log, std::size_t row, double shift) {
  const auto next = std::lower_bound(log.time.begin(), log.time.end(), log.time[row] + shift);
  if (next == log.time.begin()) return 0;
  if (next == log.time.end()) return log.rows() - 1;
  const bool before = log.time[row] + shift - *(next - 1) < *next - log.time[row] - shift;
  return static_cast<std::size_t>(next - log.time.begin()) - (before ? 1 : 0);
}

// The channels of the position sensors that have one for two directions or all.
using Directions = std::map<int, std::size_t>;
std::map<int, Directions> PositionSensors(const Experiment& e, const Wiring& wiring) {
  std::map<int, Directions> sensors;
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const auto& source = wiring.output[e.channels[c].output];
    if (source.geometry == Wiring::Source::Geometry::kPoint)
      sensors[source.sensor][source.component] = c;
  }
  std::erase_if(sensors, [](const auto& sensor) { return sensor.second.size() < 2; });
  return sensors;
}

// From the frame of a sensor into that of the measurement, y = R x + T, and back.
class MeasurementFrame {
 public:
  explicit MeasurementFrame(const Registration& r) : shift_(r.translation) {
    Vector axis = r.rotation;
    const double angle = mju_normalize3(axis.data());
    mju_axisAngle2Quat(turn_, axis.data(), angle);
    mju_negQuat(back_, turn_);
  }
  Vector FromSensor(const Vector& x) const {
    Vector y;
    mju_rotVecQuat(y.data(), x.data(), turn_);
    mju_addTo3(y.data(), shift_.data());
    return y;
  }
  Vector ToSensor(const Vector& y) const {
    Vector x, shifted = y;
    mju_subFrom3(shifted.data(), shift_.data());
    mju_rotVecQuat(x.data(), shifted.data(), back_);
    return x;
  }

 private:
  Vector shift_;
  double turn_[4], back_[4];
};

// From the world into the frame of a sensor, and back.
struct SensorFrame {
  std::optional<ObjectFrame> reference;

  Vector Of(const Vector& world) const {
    if (!reference) return world;
    Vector x, shifted = world;
    mju_subFrom3(shifted.data(), reference->position);
    mju_mulMatTVec3(x.data(), reference->axes, shifted.data());
    return x;
  }
  Vector InWorld(const Vector& x) const {
    if (!reference) return x;
    Vector world;
    mju_mulMatVec3(world.data(), reference->axes, x.data());
    mju_addTo3(world.data(), reference->position);
    return world;
  }
};

}  // namespace

std::optional<MeasuredRow> FindMeasured(const Log& log, std::size_t row,
                                        const std::function<bool(std::size_t)>& measured) {
  constexpr double kGap = 0.5;  // s
  if (measured(row)) return MeasuredRow{row, 0};
  std::size_t before = row, after = row;
  while (before > 0 && !measured(before) && log.time[row] - log.time[before] < kGap) --before;
  while (after + 1 < log.rows() && !measured(after) && log.time[after] - log.time[row] < kGap)
    ++after;
  if (!measured(before) || !measured(after)) return std::nullopt;
  if (log.time[after] - log.time[before] > kGap) return std::nullopt;
  const bool later = log.time[after] - log.time[row] < log.time[row] - log.time[before];
  return MeasuredRow{later ? after : before, after - before - 1};
}

std::vector<MeasuredPoint> MeasuredPoints(const Experiment& e, const Wiring& wiring, const Log& log,
                                          std::size_t row, const mjModel& m, const mjData& d) {
  std::vector<MeasuredPoint> points;
  const std::size_t clock_row = RowOfClock(log, row, e.registration.clock_shift);
  const MeasurementFrame frame_of_measurement(e.registration);
  for (const auto& [sensor, channels] : PositionSensors(e, wiring)) {
    const auto found = FindMeasured(log, clock_row, [&log, &c = channels](std::size_t k) {
      return std::all_of(c.begin(), c.end(), [&](const auto& direction) {
        return std::isfinite(log.measured[direction.second][k]);
      });
    });
    if (!found) continue;
    const ObjectFrame object = FrameOf(d, m.sensor_objtype[sensor], m.sensor_objid[sensor]);
    const Vector offset = OffsetOf(e.registration, mj_id2name(&m, mjOBJ_SENSOR, sensor));
    SensorFrame frame;
    if (m.sensor_refid[sensor] >= 0)
      frame.reference = FrameOf(d, m.sensor_reftype[sensor], m.sensor_refid[sensor]);
    MeasuredPoint p;
    p.held = found->gap > 1;
    mju_mulMatVec3(p.simulated.data(), object.axes, offset.data());
    mju_addTo3(p.simulated.data(), object.position);
    Vector y = frame_of_measurement.FromSensor(frame.Of(p.simulated));
    for (const auto& [i, c] : channels) y[i] = SignalOf(e, log, c, found->row);
    p.measured = frame.InWorld(frame_of_measurement.ToSensor(y));
    points.push_back(p);
  }
  return points;
}

}  // namespace continuum
