#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "sim/experiment/experiment.h"

namespace continuum {

/// Something worth knowing about a log before anything is fitted to it.
struct Finding {
  /// kInfo describes, kWarning is a likely defect, kError makes a result worthless.
  enum class Severity { kInfo, kWarning, kError };

  std::string log;      ///< label; empty: the whole experiment
  std::string channel;  ///< column; empty: the whole log
  std::string what;     ///< kind in snake_case: "gap", "stale", "unit_suspect", …
  std::string text;     ///< one plain sentence with numbers and units
  std::string summary;  ///< text without the list of further places at its end
  double begin = 0;     ///< [s] where it is; the whole log when it is everywhere
  double end = 0;       ///< [s]
  Severity severity = Severity::kInfo;
};

/// Collects findings of one log.
class Findings {
 public:
  using Severity = Finding::Severity;
  explicit Findings(const Log* log) : log_(log) {}

  void Add(Severity severity, const std::string& channel, const std::string& what,
           const std::string& text);
  /// places: the end of the text, a list of further places.
  void Add(Severity severity, const std::string& channel, const std::string& what,
           const std::string& summary, double begin, double end, const std::string& places = "");
  /// Whether something was said of a channel that is more than information; of one kind, if given.
  bool Has(const std::string& channel, const std::string& what = "") const;
  std::vector<Finding> Take() { return std::move(findings_); }

 private:
  const Log* log_;
  std::vector<Finding> findings_;
};

/// "0.0123 rad"; the unit "1" is left out.
std::string Amount(double value, const std::string& unit);

/// The second and third of `count` places as a list, and how many more there are: ", … and 4
/// more".
template <class Place, class Text>
std::string FurtherPlaces(const std::vector<Place>& places, std::size_t count, const Text& text) {
  std::string list;
  for (std::size_t i = 1; i < std::min<std::size_t>(places.size(), 3); ++i)
    list += ", " + text(places[i]);
  return count > 3 ? list + " and " + std::to_string(count - 3) + " more" : list;
}

/// A time of the log with its unit, to a millisecond where the clock counts from long ago.
std::string Clock(double time);

}  // namespace continuum
