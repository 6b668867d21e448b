#include "identification/result/fit.h"

namespace continuum {

double Fit::LastGain() const {
  for (std::size_t k = trace.size(); k-- > 1;)
    if (trace[k - 1] > trace[k]) return trace[k - 1] - trace[k];
  return 0;
}

}  // namespace continuum
