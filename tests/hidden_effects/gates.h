#pragma once

#include <string>
#include <vector>

#include "hidden_effects/suite.h"

namespace continuum::hidden {

/// A case, and what a diagnosis made of it.
struct Asked {
  Case c;
  Answer a;
};

/// When a gate is asked.
enum class Runs {
  kAlways,             ///< quick enough for sanitizers
  kWithoutSanitizers,  ///< without them in every run
  kInLongRuns,         ///< another is like it: in `scripts/test long` alone
};

/// What the small suite asks of a diagnosis. Gates that find reject whatever does not depend on the
/// logs (gates_test.cc): a set of everything holds the truth and says nothing.
struct Gate {
  std::string name;
  bool finds;  ///< whether something is hidden that has to be found
  std::vector<Case> cases;
  bool (*holds)(const std::vector<Asked>& asked);
  Runs runs = Runs::kWithoutSanitizers;
};

/// The small suite; `continuum_hidden_effects` asks hundreds of cases.
const std::vector<Gate>& Gates();

}  // namespace continuum::hidden
