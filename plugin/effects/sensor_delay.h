#pragma once

#include "effects/effect.h"

namespace continuum {

/// A sensor that reports late.   y_meas(t) = y(t − delay),  delay [s].
struct SensorDelay {
  static constexpr std::string_view kName = "sensor_delay", kSource = "doebelin2003",
                                    kSummary = "a sensor that reports late";
  static constexpr Kinship kKin{kLateness};
  static constexpr std::array kPlaces{Place::kSensor};
  static constexpr std::array kParams{Param{"delay", "s", 0, 1, 0.01, 0}};

  template <class T, class Signal>
  static T Eval(const Signal& y, double t, const Vec<T, 1>& p) {
    return y(t - p[0]);
  }
};

}  // namespace continuum
