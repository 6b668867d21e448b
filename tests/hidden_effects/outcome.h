#pragma once

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
  std::vector<std::string> effects, named, partner;
  bool listed = true;
  double factor = 1;
  bool right = false;   ///< the truth is in the set
  bool unique = false;  ///< one name
  double truth = 0, value = 0, low = 0, high = 0;
  std::map<std::string, double> stated;  ///< probability of every effect
  double seconds = 0;
  double closest = 0;  ///< how far the closest other effect is, λ
  struct Followed {
    bool right, unique;
  };
  std::optional<Followed> followed = {};  ///< after the proposed experiment

  bool HasSize() const { return right && value != 0; }
  bool Covered() const { return low <= truth && truth <= high; }
};

nlohmann::json LineOf(const Case& c, const Answer& a);
/// Of the lines of a file; lines of cases that failed are left out.
std::vector<Outcome> OutcomesOf(const std::vector<nlohmann::json>& lines);

}  // namespace continuum::hidden
