#include "identification/candidates/hypothesis.h"

#include <algorithm>
#include <cmath>

#include "sim/experiment/measurement_model.h"

namespace continuum {

std::vector<std::size_t> Hypothesis::Amplitudes() const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < null.size(); ++i) {
    if (!std::isnan(null[i])) out.push_back(i);
  }
  return out;
}

std::size_t Hypothesis::Main(std::span<const double> values) const {
  std::size_t main = 0;
  double largest = -1;
  for (const std::size_t i : Amplitudes()) {
    const double size = std::abs(values[i] - null[i]) /
                        std::max(std::abs(extra[i].lower), std::abs(extra[i].upper));
    if (size > largest) main = i, largest = size;
  }
  return main;
}

double Hypothesis::AtShare(std::size_t i, double value, double share) const {
  if (!std::isinf(null[i])) return null[i] + share * (value - null[i]);
  return share > 0 ? value / share : extra[i].upper;
}

std::vector<std::size_t> Hypothesis::StartsOfShape(bool first) const {
  std::vector<std::size_t> out;
  for (std::size_t s = 0; s < starts.size(); ++s) {
    bool same = true;
    for (std::size_t i = 0; i < null.size(); ++i)
      same = same && (!std::isnan(null[i]) || starts[s][i] == starts.front()[i]);
    if (same == first) out.push_back(s);
  }
  return out;
}

bool Hypothesis::OnlyMeasured() const {
  return !extra.empty() && std::all_of(extra.begin(), extra.end(), [](const Parameter& p) {
    return IsMeasurement(p.target, p.attribute);
  });
}

std::vector<Parameter> Hypothesis::Free() const {
  std::vector<Parameter> all = given;
  all.insert(all.end(), extra.begin(), extra.end());
  return all;
}

}  // namespace continuum
