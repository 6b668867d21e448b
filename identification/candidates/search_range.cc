#include "identification/candidates/search_range.h"

#include <algorithm>
#include <cmath>

#include "identification/candidates/parameter_size.h"

namespace continuum {

Parameter CandidateParameter(const Param& p, Place place, const Sizes& sizes,
                             const std::string& target, const std::string& attribute,
                             Change::Operation operation) {
  const auto [size, reach, typical] = SizeOf(p, place, sizes);
  Parameter out;
  out.name = p.name;
  out.target = target;
  out.attribute = attribute;
  out.operation = operation;
  out.has_initial = true;
  out.where = "candidate";
  const bool nuisance = std::isnan(p.null);
  if (std::isinf(p.null)) {  // a frequency, absent when it is large; at least two steps long
    out.upper = 0.5 / sizes.step;
    out.lower = std::max(p.lower, 0.02 * size), out.initial = std::min(size, 0.5 * out.upper);
    return out;
  }
  out.upper = std::min(p.upper, (nuisance ? 100 : reach) * size);
  out.lower = nuisance ? std::max(p.lower, 1e-3 * size) : std::max(p.lower, -reach * size);
  out.initial = nuisance ? 0.3 * size : p.null + typical * size;
  if (p.null == 1) out.lower = 0.1, out.upper = 10, out.initial = 1.02;  // a factor
  out.initial = std::clamp(out.initial, out.lower, out.upper);
  return out;
}

std::vector<std::vector<double>> SearchStarts(const std::vector<Parameter>& extra,
                                              const std::vector<double>& null) {
  std::vector<double> first;
  for (const Parameter& p : extra) first.push_back(p.initial);
  std::vector<std::vector<double>> starts{first};
  const auto add = [&](std::size_t i, double value) {
    starts.push_back(first);
    starts.back()[i] = value;
  };
  for (std::size_t i = 0; i < extra.size(); ++i) {
    const double other = 2 * null[i] - first[i];
    const bool both_ways = std::isfinite(other) && other >= extra[i].lower;
    if (both_ways && extra[i].target.starts_with("actuator:")) add(i, other);
    if (!std::isnan(null[i])) continue;
    for (const double factor : {0.2, 5.0})
      add(i, std::clamp(factor * first[i], extra[i].lower, extra[i].upper));
  }
  return starts;
}

bool Widen(std::vector<Parameter>& extra, const std::vector<double>& null,
           const std::vector<Param>& law, std::span<const double> values) {
  constexpr double kTimes = 10, kEdge = 1e-6;
  const auto shapes = [](double v) { return !std::isfinite(v); };
  if (std::any_of(null.begin(), null.end(), shapes)) return false;
  bool any = false;
  for (std::size_t i = 0; i < extra.size(); ++i) {
    Parameter& p = extra[i];
    const auto known =
        std::find_if(law.begin(), law.end(), [&](const Param& one) { return one.name == p.name; });
    if (known == law.end() || null[i] == 1) continue;  // no factor beyond ten
    const auto widen = [&](double& end, double most) {
      const double range = end - null[i];
      if (end == most || range == 0 || std::abs(values[i] - end) > kEdge * std::abs(range)) return;
      const double wider = null[i] + kTimes * range;
      end = range > 0 ? std::min(most, wider) : std::max(most, wider);
      any = true;
    };
    widen(p.upper, known->upper);
    widen(p.lower, known->lower);
  }
  return any;
}

}  // namespace continuum
