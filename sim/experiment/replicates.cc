#include "sim/experiment/replicates.h"

#include <cmath>

namespace continuum {

bool AreReplicates(const Log& a, const Log& b) {
  if (a.trial != b.trial || a.condition != b.condition || a.rows() != b.rows()) return false;
  for (std::size_t k = 0; k < a.rows(); ++k) {
    if (std::abs((a.time[k] - a.time[0]) - (b.time[k] - b.time[0])) > 1e-6) return false;
  }
  return a.input == b.input;
}

}  // namespace continuum
