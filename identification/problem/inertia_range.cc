#include "identification/problem/inertia_range.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "error.h"

namespace continuum {
namespace {

std::string Principal(std::size_t i) { return fmt::format("inertia[{}]", i); }

// Which of the three a parameter sets alone, or 3.
std::size_t Axis(const FreeParameter& p) {
  std::size_t i = 0;
  while (i < 3 && p.change.attribute != Principal(i)) ++i;
  return p.change.operation == Change::Operation::kSet ? i : 3;
}

bool Compiles(const ModelSpec& system, Change change, double value) {
  change.value = value;
  try {
    system.Build({&change, 1});
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

void KeepToInertias(const ModelSpec& system, std::vector<FreeParameter>& parameters) {
  constexpr double kInside = 1e-9, kBeyond = 1e-3;  // of the limit
  for (FreeParameter& p : parameters) {
    const std::size_t i = Axis(p), j = (i + 1) % 3, k = (i + 2) % 3;
    const auto shares_body = [&](const FreeParameter& other) {
      return &other != &p && other.change.target == p.change.target &&
             other.change.attribute.find("inertia") != std::string::npos;
    };
    if (i == 3 || std::any_of(parameters.begin(), parameters.end(), shares_body) ||
        system.Named(p.change.target).size() != 1)
      continue;
    const double a = system.Value(p.change.target, Principal(j)),
                 b = system.Value(p.change.target, Principal(k));
    const double most = (a + b) * (1 - kInside), least = std::abs(a - b) * (1 + kInside);
    if (p.upper > most && !Compiles(system, p.change, (a + b) * (1 + kBeyond))) {
      p.upper = most;
      p.why_upper = fmt::format("{} is at most {} + {} = {:.6g}: free these too", Principal(i),
                                Principal(j), Principal(k), a + b);
    }
    if (p.lower < least && !Compiles(system, p.change, std::abs(a - b) * (1 - kBeyond))) {
      p.lower = least;
      p.why_lower = fmt::format("{} is at least |{} − {}| = {:.6g}: free these too", Principal(i),
                                Principal(j), Principal(k), std::abs(a - b));
    }
  }
}

}  // namespace continuum
