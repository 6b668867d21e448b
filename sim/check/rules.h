#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "sim/check/check.h"

namespace continuum {

/// A column of a log as `check` looks at it: in its unit, rows without a number left out.
struct CheckedColumn {
  std::string name, unit;
  bool input = false;
  bool smooth = false;  ///< a sensor, which physics keeps from jumping
  std::vector<double> time, value;
  std::vector<std::size_t> row;  ///< of the log
  std::size_t missing = 0;
  double quantum = 0;
  std::string sensor;  ///< of which it is one direction
  double bend = 0;     ///< BendOf the sensor, of all its directions in all logs

  bool constant() const;
};

/// A log with its columns, inputs first (those without a column are left out).
struct CheckedLog {
  const Experiment* experiment;
  const Log* log;
  std::vector<CheckedColumn> columns;
  double period;                ///< median interval [s]
  double usual_period;          ///< the median of that over all logs [s]
  std::vector<bool> disturbed;  ///< [row] a gap or a step of an input just before
};
CheckedLog Prepare(const Experiment& e, const Log& log);

/// Collects findings of one log.
class Findings {
 public:
  using Severity = Finding::Severity;
  explicit Findings(const Log* log) : log_(log) {}

  void Add(Severity severity, const std::string& channel, const std::string& what,
           const std::string& text);
  /// places: the end of the text, a list of further places.
  void Add(Severity severity, const std::string& channel, const std::string& what,
           const std::string& gist, double begin, double end, const std::string& places = "");
  /// Whether something was said of a channel that is more than information; of one kind, if given.
  bool Has(const std::string& channel, const std::string& what = "") const;
  std::vector<Finding> Take() { return std::move(findings_); }

 private:
  const Log* log_;
  std::vector<Finding> findings_;
};

void CheckClock(const CheckedLog& log, Findings& out);
void CheckColumns(const CheckedLog& log, Findings& out);
/// A column that is flat at its largest or smallest value.
void CheckSaturation(const CheckedColumn& column, Findings& out);
void CheckExcitation(const CheckedLog& log, Findings& out);
/// Copied columns, quaternions, velocities against positions, inputs against outputs.
void CheckPairs(const CheckedLog& log, Findings& out);
/// Replicates, split, what cannot be determined.
void CheckPlan(const Experiment& e, Findings& out);

/// "0.0123 rad"; the unit "1" is left out.
std::string Amount(double value, const std::string& unit);

/// The second and third of count places, and how many more there are: ", … and 4 more".
template <class Place, class Text>
std::string Further(const std::vector<Place>& places, std::size_t count, const Text& text) {
  std::string list;
  for (std::size_t i = 1; i < std::min<std::size_t>(places.size(), 3); ++i)
    list += ", " + text(places[i]);
  return count > 3 ? list + " and " + std::to_string(count - 3) + " more" : list;
}

/// A time of the log with its unit, to a millisecond where the clock counts from long ago.
std::string Clock(double time);

}  // namespace continuum
