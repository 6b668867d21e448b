#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "hidden_effects/suite.h"

namespace continuum::hidden {

/// One case of the suite and what became of it, as its line of the suite's file says.
struct Outcome {
  std::string name, noise, verdict;
  std::string robot, suite, spoilt;  ///< suite: robots, background, spoilt or outside
  std::vector<std::string> effects, named, partner;
  bool listed = true;
  double factor = 1;
  bool right = false;    ///< the truth is in the set
  bool unique = false;   ///< one name
  bool exact = false;    ///< right by the very name, not by one of its family
  bool sibling = false;  ///< it holds what is declared to look the same
  double truth = 0, value = 0, low = 0, high = 0;
  double by_numbers = 0;  ///< standard deviation of value, if lengths and masses are off
  std::map<std::string, double> stated;  ///< probability of every effect
  double seconds = 0, cpu = 0;
  double p = 1;                          ///< to first order
  double removed = 0;                    ///< of the error on logs left out
  std::optional<double> explained = {};  ///< of what is explainable of it, where that is known
  std::string screened, leading;         ///< best to first order; closest where nothing is named
  std::optional<bool> complete = {};     ///< whether what is left looks like noise
  double closest = 0;                    ///< how far the closest other effect is, λ
  struct Followed {
    bool right, unique;
  };
  std::optional<Followed> followed = {};  ///< after the proposed experiment

  bool HasSize() const { return right && value != 0; }
  bool Covered() const { return low <= truth && truth <= high; }
  /// Of the interval and twice that deviation together.
  bool CoveredIfNumbersAreOff() const {
    const double half = truth > value ? high - value : value - low;
    return Covered() || std::abs(truth - value) <= std::hypot(half, 2 * by_numbers);
  }
};

nlohmann::json LineOf(const Case& c, const Answer& a);
/// Of the lines of a file. Cases without an answer have the verdict "no answer".
std::vector<Outcome> OutcomesOf(const std::vector<nlohmann::json>& lines);

}  // namespace continuum::hidden
