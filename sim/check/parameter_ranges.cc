#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "binding/config.h"
#include "error.h"
#include "sim/check/against_model.h"

namespace continuum {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;  // rad: what a hinge rarely needs more than
constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::string_view kJoint = "joint:";
constexpr double kBeyond = 1e-3;  // of a limit

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

bool Compiles(const ModelSpec& system, const Parameter& p, double value) {
  const Change change{p.target, p.attribute, value, Change::Operation::kSet};
  try {
    system.Build({&change, 1});
    return true;
  } catch (const Error&) {
    return false;
  }
}

// |I_j − I_k| ≤ I_i ≤ I_j + I_k holds of every body: beyond it a fit of I_i alone cannot go.
void CheckInertia(const Experiment& e, const ModelSpec& system, const Parameter& p, Findings& out) {
  const std::array<std::string, 3> axes{"inertia[0]", "inertia[1]", "inertia[2]"};
  const auto axis =
      static_cast<std::size_t>(std::find(axes.begin(), axes.end(), p.attribute) - axes.begin());
  const auto shares_body = [&](const Parameter& other) {
    return &other != &p && other.target == p.target &&
           other.attribute.find("inertia") != std::string::npos;
  };
  if (axis == axes.size() || p.operation != Change::Operation::kSet ||
      std::any_of(e.parameters.begin(), e.parameters.end(), shares_body) ||
      system.Named(p.target).size() != 1)
    return;
  const double a = system.Value(p.target, axes[(axis + 1) % 3]),
               b = system.Value(p.target, axes[(axis + 2) % 3]);
  const double least = std::abs(a - b), most = a + b;
  const bool above = p.upper > most && !Compiles(system, p, most * (1 + kBeyond));
  const bool below = p.lower < least && !Compiles(system, p, least * (1 - kBeyond));
  if (!above && !below) return;
  out.Add(Finding::Severity::kInfo, "", "inertia_limit",
          fmt::format("parameter '{}' ({} {}) can only be between {:.4g} and {:.4g} kg*m^2, the "
                      "difference and the sum of the body's other two: a fit stops there; free "
                      "these too, or a scale of the body's mass",
                      p.name, p.target, p.attribute, least, most));
}

}  // namespace

void CheckParameterRanges(const Experiment& e, const ModelSpec& system, Findings& out) {
  for (const Parameter& p : e.parameters) {
    if (p.frozen) continue;
    CheckAngles(system, p, out);
    CheckInertia(e, system, p, out);
  }
}

}  // namespace continuum
