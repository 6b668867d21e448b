#pragma once

#include "effects/effect.h"

namespace continuum {

/// A sensor whose zero wanders.   y_meas(t) = y(t) + rate t,  rate in the unit of the output per
/// second, t [s] from the beginning of the log, of which an experiment may take a window.
struct SensorDrift {
  static constexpr std::string_view kName = "sensor_drift", kSource = "doebelin2003",
                                    kSummary = "a sensor whose zero wanders";
  static constexpr std::array kPlaces{Place::kSensor};
  static constexpr std::array kParams{Signed("rate", "output/s", 0)};

  template <class T, class Signal>
  static T Eval(const Signal& y, double t, const Vec<T, 1>& p) {
    return y(t) + p[0] * t;
  }
};

}  // namespace continuum
