#pragma once

#include <string>

namespace continuum {

/// A fitted model as files: its MJCF, and the experiment that belongs to it.
struct ExtendedModel {
  std::string xml, yaml;
};

}  // namespace continuum
