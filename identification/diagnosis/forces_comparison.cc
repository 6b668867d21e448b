#include "identification/diagnosis/forces_comparison.h"

#include "identification/diagnosis/search_bytes.h"
#include "sim/numerics/shared_loop.h"

namespace continuum {

void CompareByForces(const EquationErrors& forces, std::vector<CandidateResult>& candidates) {
  const auto look = [&](std::size_t, std::size_t i) {
    candidates[i].by_equation = forces.Of(candidates[i]);
  };
  ShareOut(candidates.size(), look,
           [&](auto& archive, std::size_t i) { archive(candidates[i].by_equation); });
}

}  // namespace continuum
