#pragma once

#include <string>
#include <utility>
#include <vector>

namespace continuum {

/// One plugin instance to be added to a model.
struct EffectInstance {
  std::string effect, name;
  std::vector<std::pair<std::string, std::string>> config;
};

}  // namespace continuum
