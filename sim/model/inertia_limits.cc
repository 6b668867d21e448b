#include "sim/model/inertia_limits.h"

#include <cmath>

#include <fmt/format.h>

#include "error.h"

namespace continuum {
namespace {

bool SharesBody(const Change& a, const Change& b) {
  return &a != &b && a.target == b.target && a.attribute.find("inertia") != std::string::npos;
}

}  // namespace

std::string InertiaLimits::Name(std::size_t axis) { return fmt::format("inertia[{}]", axis); }

std::optional<InertiaLimits> InertiaLimits::Of(const ModelSpec& system,
                                               std::span<const Change> free, std::size_t which) {
  const Change& change = free[which];
  std::size_t axis = 0;
  while (axis < 3 && change.attribute != Name(axis)) ++axis;
  if (axis == 3 || change.operation != Change::Operation::kSet) return {};
  for (const Change& other : free)
    if (SharesBody(other, change)) return {};
  if (system.Named(change.target).size() != 1) return {};
  return InertiaLimits(system, change, axis);
}

InertiaLimits::InertiaLimits(const ModelSpec& system, const Change& change, std::size_t axis)
    : system_(&system), change_(change), axis_(axis) {
  const double a = system.Value(change.target, Name((axis + 1) % 3)),
               b = system.Value(change.target, Name((axis + 2) % 3));
  least_ = std::abs(a - b), most_ = a + b;
}

bool InertiaLimits::Compiles(double value) const {
  Change change = change_;
  change.value = value;
  try {
    system_->Build({&change, 1});
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace continuum
