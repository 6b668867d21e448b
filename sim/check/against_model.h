#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "sim/check/findings.h"
#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/trace.h"

namespace continuum {

/// Measured and simulated numbers of one channel in the rows where both exist, in SI.
struct Compared {
  std::size_t channel;
  std::string name, unit;
  std::vector<double> measured, simulated;
  std::vector<std::size_t> row;
};

/// The channels with at least 20 such rows; no quaternions.
std::vector<Compared> Compare(const Experiment& e, const Log& log, const Trace& trace);

/// Standard deviation of a − b: the error without its offset.
double Misfit(const std::vector<double>& a, const std::vector<double>& b);

/// Rows in which an input leaves the range of its actuator, where the model clamps it, and inputs
/// that are on a limit in many rows.
void CheckRanges(const Experiment& e, const Log& log, const mjModel& m, Findings& out);

/// Finds columns that are shifted in time against the pose. Where a log measures the joints and
/// sensors that joints determine, the kinematics of the model suffice: no force is needed. Nothing
/// is judged with a registration. Returns the columns that were judged.
std::set<std::string> CheckPose(const Experiment& e, const Log& log, const ModelSpec& system,
                                Findings& out);

/// Parameters that change no output of any log. What many or long logs would make too slow is not
/// judged, nor are logs of poses at rest.
void CheckParameterEffects(const Experiment& e, const ModelSpec& system, Findings& out);

/// Bounds that a parameter cannot mean: angles of hinges in degrees, and a principal inertia beyond
/// what the body's other two allow.
void CheckParameterRanges(const Experiment& e, const ModelSpec& system, Findings& out);

/// Looks for mistakes in the inputs of logs that the model does not explain: a wrong sign or unit
/// (of one input, or of all of one dimension), or two inputs swapped. Each is simulated in a window
/// of bounded length where its input moves most, so that long logs cost no more than short ones.
class InputMistakes {
 public:
  InputMistakes(const Experiment& e, const ModelSpec& system) : experiment_(e), system_(system) {}

  /// trace: the whole log as simulated.
  void Run(const Log& whole, const Trace& trace, Findings& out);

 private:
  /// A window of a log and how far the model is off in it.
  struct Window {
    Log log;
    double plain;
  };
  Window WindowOf(const Log& whole, const Trace& trace, std::size_t input) const;
  std::size_t End(const Log& whole, std::size_t first) const;
  double ErrorOf(const Log& log);
  double RelativeError(const Log& log, const Trace& trace) const;
  std::vector<std::vector<std::size_t>> InputsOfOneDimension() const;
  void TryMistakes(Window& window, const std::vector<std::size_t>& inputs, Findings& out);
  void TrySwap(Window& window, std::size_t i, std::size_t j, Findings& out);
  void ReportIfExplained(const Window& window, const std::string& column, const char* what,
                         const std::string& text, Findings& out);

  const Experiment& experiment_;
  const ModelSpec& system_;
  int budget_ = 90;  ///< simulations over all logs
};

}  // namespace continuum
