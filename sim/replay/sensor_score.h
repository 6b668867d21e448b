#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sim/replay/replay.h"

namespace continuum {

/// How far the outputs of one sensor or actuator are off together: the distance of a position, the
/// angle of a turn, the absolute error of a single number.
struct SensorScore {
  std::string source;     ///< name of the sensor or actuator
  std::string quantity;   ///< of an actuator: "force" or "control"
  std::string use;        ///< "train" or "validate"; empty: both
  std::string condition;  ///< empty: all
  std::string unit;
  std::size_t rows = 0;  ///< in which everything was measured
  double rms = 0;        ///< [unit]
  double mean = 0;       ///< [unit]
  double relative = 0;   ///< rms over that of what was measured; 0 for a turn
};

/// Of every sensor or actuator whose outputs have one unit, over the logs of each use and, where
/// there are several, of each condition.
std::vector<SensorScore> ScoreSensors(const Experiment& experiment,
                                      const std::vector<Replayed>& logs);

/// A list of objects with the members of SensorScore.
nlohmann::json ToJson(const std::vector<SensorScore>& scores);

}  // namespace continuum
