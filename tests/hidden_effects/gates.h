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

/// What the small suite asks of a diagnosis. Gates that find reject whatever does not depend on the
/// logs (gates_test.cc): a set of everything holds the truth and says nothing.
struct Gate {
  std::string name;
  bool finds;  ///< whether something is hidden that has to be found
  std::vector<Case> cases;
  bool (*holds)(const std::vector<Asked>& asked);
  bool is_long = false;  ///< another is like it: left to `scripts/test long`
};

/// The small suite; `continuum_hidden_effects` asks hundreds of cases.
const std::vector<Gate>& Gates();

}  // namespace continuum::hidden
