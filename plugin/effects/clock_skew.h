#pragma once

#include "effects/effect.h"

namespace continuum {

/// A clock of the log that runs slow or fast.   y_meas(t) = y((1 + skew) t),  skew [1]: a second of
/// the log is 1 + skew seconds of the model, for all channels. More than 5 % is another unit.
struct ClockSkew {
  static constexpr std::string_view kName = "clock_skew", kSource = "doebelin2003",
                                    kSummary = "a clock of the log that runs slow or fast";
  static constexpr std::array kPlaces{Place::kSensor};
  static constexpr std::array kParams{Param{"skew", "1", -0.05, 0.05, 0, 0}};

  template <class T, class Signal>
  static T Eval(const Signal& y, double t, const Vec<T, 1>& p) {
    return y((1.0 + p[0]) * t);
  }
};

}  // namespace continuum
