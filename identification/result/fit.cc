#include "identification/result/fit.h"

namespace continuum {

double Fit::LastGain() const {
  constexpr std::size_t kRecent = 3;
  for (std::size_t k = trace.size(), n = 0; k-- > 1 && n < kRecent; ++n)
    if (trace[k - 1] > trace[k]) return trace[k - 1] - trace[k];
  return 0;
}

}  // namespace continuum
