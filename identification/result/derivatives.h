#pragma once

#include <string>
#include <vector>

namespace continuum {

/// How the derivative of a log's residuals by one parameter is made.
struct Derivative {
  enum class Way {
    kClosedForm,   ///< all parameters in one simulation
    kSingleSteps,  ///< stepped path: beside it MuJoCo takes every step with a moved model
    kSingleRates,  ///< smooth path: beside it a moved model is evaluated at every state
    kMeasurement,  ///< the motion stays, only what is measured of it changes
    kDifferences,  ///< the whole log is simulated once more, or twice
  };
  Way way = Way::kClosedForm;
  std::string why = {};  ///< why not in closed form; empty: it is

  bool operator==(const Derivative&) const = default;
};

/// How all derivatives of a fit are made.
struct Derivatives {
  std::string path;                           ///< "stepped, by sensitivities of MuJoCo's own steps"
  std::vector<std::string> parameters;        ///< names
  std::vector<std::string> logs;              ///< labels of the logs of the fit
  std::vector<std::vector<Derivative>> made;  ///< [parameter][log]
};

}  // namespace continuum
