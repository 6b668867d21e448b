#pragma once

#include <string>
#include <vector>

#include "models/annelida/annelida.h"

namespace continuum {

/// One recorded trial of the demo: a file name and its CSV.
struct DemoLog {
  std::string file, csv;
};

/// Noise of the demo's sensors, and what its model does not know.
struct DemoTruth {
  double angle_noise = 3e-3, tip_noise = 5e-4;  ///< standard deviations [rad], [m]
  double payload = 0.06;                        ///< at the tip [kg]
  double step = 2e-5;                           ///< [s]
};

/// Four trials, each recorded twice with other noise: steps of cables 1 and 3, 100 Hz, 3 s, by the
/// chain written out (no MuJoCo). Columns: time [s], cable1 .. cable4 [N], bend1_y .. bend5_y
/// [rad], tip_x, tip_z [m]. The same numbers in every run. Throws Error when a joint would reach
/// its stop.
std::vector<DemoLog> RecordDemo(const AnnelidaParameters& p, const DemoTruth& truth = {});

}  // namespace continuum
