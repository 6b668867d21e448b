#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "models/annelida/planar_chain.h"

namespace continuum {

/// How a trial of the chain written out is measured: rows at 100 Hz, normal noise, the same numbers
/// with every standard library.
struct Recorded {
  std::string trial;
  int rows = 0;
  /// Of cables 1 and 3 [N] at a time [s]; held from row to row.
  std::function<std::array<double, 2>(double time)> tension;
  double angle_noise = 3e-3, tip_noise = 5e-4, rate_noise = 0;  ///< [rad], [m], [rad/s]
  bool rates = false;                                           ///< record these too
  double step = 2e-5;                                           ///< [s]
};

inline constexpr double kRecordPeriod = 0.01;  ///< [s]

/// The motion of one trial as CSVs with other noise for each seed. Columns: time [s], cable1 ..
/// cable4 [N], bend1_y .. bend5_y [rad], rate1 .. rate5 [rad/s] (with rates), tip_x, tip_z [m].
/// Throws Error when a joint reaches its stop.
std::vector<std::string> Record(const PlanarChain& chain, double stop, const Recorded& recorded,
                                const std::vector<std::uint64_t>& seeds);

}  // namespace continuum
