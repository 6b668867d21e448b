#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "binding/config.h"
#include "sim/check/against_model.h"
#include "sim/model/inertia_limits.h"

namespace continuum {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;  // rad: what a hinge rarely needs more than
constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::string_view kJoint = "joint:";

// Whether an attribute is an angle on every joint that a target names.
bool IsAngle(const ModelSpec& system, const Parameter& p) {
  const std::string name = p.attribute.substr(0, p.attribute.find('['));
  if (!p.target.starts_with(kJoint) || (name != "ref" && name != "springref" && name != "range"))
    return false;
  const mjModel& m = system.model();
  bool turns = false;
  for (int j = 0; j < m.njnt; ++j) {
    const char* const joint = mj_id2name(&m, mjOBJ_JOINT, j);
    if (!joint || !AnyGlobMatches(std::string_view(p.target).substr(kJoint.size()), joint))
      continue;
    turns = m.jnt_type[j] == mjJNT_HINGE;
    if (!turns) return false;
  }
  return turns;
}

// MJCF writes angles in degrees unless its <compiler> says otherwise; parameters never do.
void CheckAngles(const ModelSpec& system, const Parameter& p, Findings& out) {
  if (p.operation == Change::Operation::kScale || !IsAngle(system, p)) return;
  double most = p.has_initial ? p.initial : 0;
  for (const double bound : {p.lower, p.upper}) {
    if (std::abs(bound) > std::abs(most)) most = bound;
  }
  if (std::abs(most) <= kTurn) return;
  out.Add(
      Finding::Severity::kWarning, "", "unit_suspect",
      fmt::format("parameter '{}' ({} {}) is in rad, also where the MJCF has degrees: {:.4g} rad "
                  "are {:.4g} degrees; are these degrees? {:.4g} degrees are {:.4g} rad",
                  p.name, p.target, p.attribute, most, most * kDegrees, most, most / kDegrees));
}

// Beyond its limits a fit of one inertia alone cannot go.
void CheckInertia(const Parameter& p, const InertiaLimits& limits, Findings& out) {
  const bool above = p.upper > limits.most() && limits.HoldAbove();
  const bool below = p.lower < limits.least() && limits.HoldBelow();
  if (!above && !below) return;
  out.Add(Finding::Severity::kInfo, "", "inertia_limit",
          fmt::format("parameter '{}' ({} {}) can only be between {:.4g} and {:.4g} kg*m^2, the "
                      "difference and the sum of the body's other two: a fit stops there; free "
                      "these too, or a scale of the body's mass",
                      p.name, p.target, p.attribute, limits.least(), limits.most()));
}

}  // namespace

void CheckParameterRanges(const Experiment& e, const ModelSpec& system, Findings& out) {
  std::vector<Change> changes;
  for (const Parameter& p : e.parameters)
    changes.push_back({p.target, p.attribute, 0, p.operation});
  for (std::size_t i = 0; i < e.parameters.size(); ++i) {
    const Parameter& p = e.parameters[i];
    if (p.frozen) continue;
    CheckAngles(system, p, out);
    if (const auto limits = InertiaLimits::Of(system, changes, i)) CheckInertia(p, *limits, out);
  }
}

}  // namespace continuum
