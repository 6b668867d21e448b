#include "sim/experiment/experiment.h"

namespace continuum {

const Candidate* Experiment::Written(std::string_view name) const {
  for (const Candidate& c : candidates) {
    if (c.law && c.law->name == name) return &c;
  }
  return nullptr;
}

}  // namespace continuum
