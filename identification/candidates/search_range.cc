#include "identification/candidates/search_range.h"

#include <algorithm>
#include <cmath>

#include "identification/candidates/nuisance_grid.h"
#include "identification/candidates/parameter_size.h"

namespace continuum {

namespace {

bool IsFactor(const Param& p) { return p.null == 1 && p.unit == "1"; }

// Values of a parameter that are worth a start of their own. A law of the experiment says where its
// parameter begins, not what the logs can show of it.
std::vector<double> ValuesToTry(const Parameter& p, const std::vector<Param>& law, Place place,
                                const Sizes& sizes) {
  const bool edit = p.attribute.starts_with("effect:");  // by the effect, not an attribute of it
  const std::string name = edit ? p.attribute.substr(p.attribute.find('.') + 1) : p.attribute;
  const auto card =
      std::find_if(law.begin(), law.end(), [&](const Param& one) { return one.name == name; });
  if (card == law.end() || !p.unit.empty()) return {0.2 * p.initial, 5 * p.initial};
  return GridOf(*card, place, sizes).values;
}

Parameter Named(const Param& p, const std::string& target, const std::string& attribute,
                Change::Operation operation) {
  Parameter out;
  out.name = p.name;
  out.target = target;
  out.attribute = attribute;
  out.operation = operation;
  out.has_initial = true;
  out.where = "candidate";
  return out;
}

// How large, and where the search begins.
void SetRange(const Param& p, const ParameterSize& s, Parameter& out) {
  out.lower = std::max(p.lower, -s.reach * s.size);
  out.upper = std::min(p.upper, s.reach * s.size);
  out.initial = p.null + s.typical * s.size;
  if (IsFactor(p)) out.lower = 0.1, out.upper = 10, out.initial = 1.02;
  out.initial = std::clamp(out.initial, out.lower, out.upper);
}

}  // namespace

Parameter CandidateParameter(const Param& p, Place place, const Sizes& sizes,
                             const std::string& target, const std::string& attribute,
                             Change::Operation operation) {
  const ParameterSize s = SizeOf(p, place, sizes);
  Parameter out = Named(p, target, attribute, operation);
  if (std::isinf(p.null) && p.unit != "rad/s") {  // a limit, absent when it is large
    out.upper = s.reach * s.size;
    out.lower = std::max(p.lower, 1e-3 * s.size);
    out.initial = 0.5 * s.size;
  } else if (std::isinf(p.null)) {  // a frequency; at least two steps long
    out.upper = 0.5 / sizes.step;
    out.lower = std::max(p.lower, 0.02 * s.size);
    out.initial = std::min(s.size, 0.5 * out.upper);
  } else if (std::isnan(p.null)) {
    const NuisanceGrid grid = GridOf(p, place, sizes);
    out.upper = std::min(p.upper, std::max(100 * s.size, 3 * grid.values.back()));
    out.lower = std::max(p.lower, 1e-3 * s.size);
    out.initial = std::clamp(grid.start, out.lower, out.upper);
  } else {
    SetRange(p, s, out);
  }
  return out;
}

Parameter CableParameter(const Param& p, const Sizes& sizes, const std::string& target) {
  Parameter out = Named(p, target, std::string(p.name), Change::Operation::kSet);
  SetRange(p, SizeAlongCable(p, sizes), out);
  return out;
}

std::vector<std::vector<double>> SearchStarts(const Hypothesis& h, const std::vector<Param>& law,
                                              const Sizes& sizes) {
  std::vector<double> first;
  for (const Parameter& p : h.extra) first.push_back(p.initial);
  std::vector<std::vector<double>> starts{first};
  const auto alike = [&](std::size_t a, std::size_t b) {
    return h.extra[a].attribute == h.extra[b].attribute;
  };
  const auto add = [&](std::size_t i, double value) {
    std::vector<double> start = first;
    for (std::size_t k = i; k < start.size() && alike(i, k); ++k)
      start[k] = std::clamp(value, h.extra[k].lower, h.extra[k].upper);
    if (std::find(starts.begin(), starts.end(), start) == starts.end())
      starts.push_back(std::move(start));
  };
  for (std::size_t i = 0; i < h.extra.size(); ++i) {
    if (i > 0 && alike(i - 1, i)) continue;  // under another condition
    const double other = 2 * h.null[i] - first[i];
    const bool both_ways = std::isfinite(other) && other >= h.extra[i].lower;
    if (both_ways && h.extra[i].target.starts_with("actuator:")) add(i, other);
    if (std::isfinite(h.null[i])) continue;
    for (const double value : ValuesToTry(h.extra[i], law, h.place, sizes)) add(i, value);
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
