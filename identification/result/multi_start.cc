#include "identification/result/multi_start.h"

#include <algorithm>

#include <fmt/format.h>

namespace continuum {

std::size_t MultiStart::Reached(double share) const {
  return static_cast<std::size_t>(std::count_if(starts.begin(), starts.end(), [&](const Start& s) {
    return s.cost <= best.cost * (1 + share);
  }));
}

std::string MultiStart::InWords() const {
  return fmt::format("{} of {} starts end within 0.1 % of the best cost", Reached(), starts.size());
}

}  // namespace continuum
