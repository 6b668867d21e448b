#pragma once

#include <string>
#include <vector>

namespace continuum {

/// Parameters that can change together with little effect on what is measured.
struct Confounding {
  std::vector<std::string> names;
  /// How much farther they can move together than one of them alone; infinite: without any effect.
  double freedom;
  std::string text;  ///< "mass and gain trade off: … only mass/gain is determined"
};

}  // namespace continuum
