#include "sim/simulation/output_recorder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/model/object_frame.h"
#include "sim/simulation/wiring.h"

namespace continuum {

using Geometry = Wiring::Source::Geometry;

Recorder::Recorder(const mjModel& m, const Wiring& wiring, std::size_t rows)
    : m_(m), wiring_(wiring), axes_(wiring.output.size()) {
  constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t o = 0; o < wiring.output.size(); ++o) {
    const auto& source = wiring.output[o];
    raw_.emplace_back(source.size, std::vector<double>(rows, kMissing));
    if (wiring.marked && source.geometry == Geometry::kPoint)
      axes_[o].assign(9, std::vector<double>(rows, kMissing));
  }
}

void Recorder::Take(const mjData& d, std::size_t row) {
  for (std::size_t o = 0; o < raw_.size(); ++o) {
    const auto& source = wiring_.output[o];
    const double* const from = source.kind == Output::Kind::kSensor  ? d.sensordata
                               : source.kind == Output::Kind::kForce ? d.actuator_force
                                                                     : d.ctrl;
    for (int c = 0; c < source.size; ++c) raw_[o][c][row] = from[source.address + c];
    if (axes_[o].empty()) continue;
    const int s = source.sensor;
    double axes[9];
    mju_copy(axes, FrameOf(d, m_.sensor_objtype[s], m_.sensor_objid[s]).axes, 9);
    if (m_.sensor_refid[s] >= 0) {
      const double* const reference = FrameOf(d, m_.sensor_reftype[s], m_.sensor_refid[s]).axes;
      double absolute[9];
      mju_copy(absolute, axes, 9);
      mju_mulMatTMat(axes, reference, absolute, 3, 3, 3);
    }
    for (int i = 0; i < 9; ++i) axes_[o][i][row] = axes[i];
  }
}

void Recorder::Release(Trace& trace) {
  trace.raw = std::move(raw_);
  trace.axes = std::move(axes_);
}

bool Diverged(const mjModel& m, const mjData& d) {
  for (const int kind : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC, mjWARN_BADCTRL}) {
    if (d.warning[kind].number > 0) return true;
  }
  return !std::all_of(d.qpos, d.qpos + m.nq, [](double q) { return std::isfinite(q); });
}

}  // namespace continuum
