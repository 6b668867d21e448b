#include "sim/simulation/trace_measurement.h"

#include <algorithm>

#include "sim/experiment/registration.h"
#include "sim/io/units.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

using Record = std::vector<std::vector<double>>;  // [component][row]

// Of the parabola through a row and those beside it; at the ends of a line.
double Slope(const std::vector<double>& time, const std::vector<double>& y, std::size_t i) {
  const auto chord = [&](std::size_t k) { return (y[k + 1] - y[k]) / (time[k + 1] - time[k]); };
  if (i == 0) return chord(0);
  if (i + 1 == time.size()) return chord(i - 1);
  const double before = time[i] - time[i - 1], after = time[i + 1] - time[i];
  return (chord(i - 1) * after + chord(i) * before) / (before + after);
}

// Hermite's cubic between two rows: a line would leave an error of T² ÿ/8.
double At(const std::vector<double>& time, const std::vector<double>& y, double t) {
  if (t <= time.front()) return y.front();
  const auto next = std::upper_bound(time.begin(), time.end(), t);
  if (next == time.end()) return y.back();
  const std::size_t i = next - time.begin();
  const double T = time[i] - time[i - 1], s = (t - time[i - 1]) / T;
  const double from = T * Slope(time, y, i - 1), to = T * Slope(time, y, i);
  const double rise = y[i] - y[i - 1];
  return y[i - 1] + s * (from + s * (3 * rise - 2 * from - to + s * (from + to - 2 * rise)));
}

using Geometry = Wiring::Source::Geometry;

// R (p + Q o) + T, R v or R q.
void Register(Record& record, const Registration& r, Geometry geometry, const Record& axes,
              const Registration::Vector& offset) {
  if (geometry == Geometry::kNone) return;
  double quat[4], unit[3] = {r.rotation[0], r.rotation[1], r.rotation[2]};
  const double angle = mju_normalize3(unit);
  mju_axisAngle2Quat(quat, unit, angle);
  for (std::size_t k = 0; k < record.front().size(); ++k) {
    double y[4], out[4];
    for (std::size_t c = 0; c < record.size(); ++c) y[c] = record[c][k];
    if (geometry == Geometry::kRotation) {
      mju_mulQuat(out, quat, y);
    } else {
      for (int c = 0; c < 3 && !axes.empty(); ++c) {
        for (int i = 0; i < 3; ++i) y[c] += axes[3 * c + i][k] * offset[i];
      }
      mju_rotVecQuat(out, y, quat);
      for (int c = 0; c < 3 && geometry == Geometry::kPoint; ++c) out[c] += r.translation[c];
    }
    for (std::size_t c = 0; c < record.size(); ++c) record[c][k] = out[c];
  }
}

// The same numbers, later by delay (they are held at the ends).
Record Later(const Record& record, const std::vector<double>& time, double delay) {
  Record late = record;
  if (delay == 0) return late;
  for (std::size_t c = 0; c < record.size(); ++c) {
    for (std::size_t k = 0; k < time.size(); ++k) late[c][k] = At(time, record[c], time[k] - delay);
  }
  return late;
}

// Writes what is measured of a record (Measurement), in SI units. factor: of the output's unit.
void Measure(Record& record, const Measurement& how, double shift, const Log& log, double factor) {
  if (how == Measurement{} && shift == 0) return;
  const std::vector<double>& time = log.time;
  Record late = Later(record, time, how.delay + shift);
  double quat[4] = {1, 0, 0, 0};
  double axis[3] = {how.axis[0], how.axis[1], how.axis[2]};
  if (how.angle != 0) {
    mju_normalize3(axis);
    mju_axisAngle2Quat(quat, axis, how.angle);
  }
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (record.size() == 3) {
      double y[3] = {late[0][k], late[1][k], late[2][k]}, turned[3];
      mju_rotVecQuat(turned, y, quat);
      for (int c = 0; c < 3; ++c) late[c][k] = turned[c];
    } else if (record.size() == 4) {
      double y[4] = {late[0][k], late[1][k], late[2][k], late[3][k]}, turned[4];
      mju_mulQuat(turned, quat, y);
      for (int c = 0; c < 4; ++c) late[c][k] = turned[c];
    }
    for (std::size_t c = 0; c < record.size(); ++c) {
      const double turn = record.size() == 1 ? how.Eccentricity(late[c][k] / factor) : 0;
      record[c][k] = how.scale * (late[c][k] + factor * turn) +
                     factor * (how.bias + how.rate * (time[k] - log.Begin()));
    }
  }
}

}  // namespace

void MeasureTrace(const Experiment& e, const Wiring& wiring, const Log& log, Trace& trace) {
  const Registration& r = e.registration;
  trace.channel.clear();
  for (std::size_t o = 0; o < trace.raw.size(); ++o) {
    const Output& out = e.outputs[o];
    Record record = trace.raw[o];
    if (r.has_frame() || r.has_marker())
      Register(record, r, wiring.output[o].geometry, trace.axes[o], OffsetOf(r, out.source));
    Measure(record, out.measurement, r.clock_shift, log, UnitFactor(out.unit, ""));
    if (out.quaternion()) {
      for (auto& component : record) trace.channel.push_back(std::move(component));
    } else {
      trace.channel.push_back(std::move(record[wiring.output[o].component]));
    }
  }
}

}  // namespace continuum
