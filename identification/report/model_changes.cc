#include "identification/report/model_changes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "effects/pt2.h"
#include "error.h"
#include "sim/experiment/measurement_model.h"
#include "sim/io/rounded.h"

namespace continuum {
namespace {

constexpr int kDigits = 3;  // at least
constexpr std::string_view kLinkLength = "effect:link_length.scale";

std::string Value(double value, int digits = kDigits) { return Significant(value, digits); }

// As many as show two digits of an interval's width: 3.0021e+05, not 3e+05 … 3e+05.
int DigitsOf(const Uncertainty& u, double value, Eigen::Index at) {
  constexpr int kMost = 8;
  if (u.lower.size() <= at) return kDigits;
  const double width = u.upper[at] - u.lower[at];
  if (!(width > 0) || !std::isfinite(width) || value == 0) return kDigits;
  const double digits = std::floor(std::log10(std::abs(value))) - std::floor(std::log10(width)) + 2;
  return static_cast<int>(std::clamp<double>(digits, kDigits, kMost));
}

// " N m/rad"; nothing for a pure number.
std::string Unit(std::string unit) {
  if (unit.empty() || unit == "1") return "";
  std::replace(unit.begin(), unit.end(), '*', ' ');
  return " " + unit;
}

// "joint bend*" of "joint:bend*".
std::string Place(std::string target) {
  const auto colon = target.find(':');
  if (colon != target.npos) target[colon] = ' ';
  return target;
}

std::string Interval(const Uncertainty& u, Eigen::Index at, int digits) {
  if (u.lower.size() <= at || !std::isfinite(u.upper[at] - u.lower[at])) return "";
  return fmt::format("95 %: {} … {}", Value(u.lower[at], digits), Value(u.upper[at], digits));
}

// What a fit at a step of zero would give, where the interval of the noise alone leaves that out.
std::string AtFineStep(const Uncertainty& u, double value, Eigen::Index at, int digits) {
  if (u.step.size() <= at || !(std::abs(u.step[at]) > u.standard_error[at])) return "";
  return fmt::format("{} at a time step of zero", Value(value + u.step[at], digits));
}

// What numbers of the model may add, where the interval of the noise alone leaves that out.
std::string ByNumbers(const Uncertainty& u, Eigen::Index at, const std::string& unit) {
  if (u.by_numbers.size() <= at || !(2 * u.by_numbers[at] > u.upper[at] - u.lower[at])) return "";
  return fmt::format("± {}{} if lengths and masses are {:g} % off", Value(u.by_numbers[at]), unit,
                     100 * Criteria{}.link_known);
}

bool AtBound(const Fitted& f, Eigen::Index at) {
  if (!f.complete()) return false;
  const auto& bound = f.sensitivities->uncertainty.at_bound;
  return static_cast<std::size_t>(at) < bound.size() && bound[static_cast<std::size_t>(at)];
}

std::string NearerBound(double value, double lower, double upper) {
  return value - lower < upper - value ? "lower" : "upper";
}

// What a model or an experiment has before; none where it has no such value.
std::optional<double> Before(const Diagnosis& d, const FreeParameter& p) {
  if (IsMeasurement(p.change.target, p.change.attribute)) return p.initial;
  try {
    return d.system.Value(p.change.target, p.change.attribute);
  } catch (const Error&) {
    return {};
  }
}

bool IsLength(const FreeParameter& p) { return p.change.attribute == kLinkLength; }

std::string NameOf(const FreeParameter& p) {
  if (IsLength(p)) return "length of " + Place(p.change.target);
  const auto of = p.name.find('[');
  return fmt::format("{} of {}{}", p.change.attribute, Place(p.change.target),
                     of == p.name.npos ? "" : " " + p.name.substr(of));
}

// "1.238 → 1.251", "times 1.05"; empty where nothing changes.
std::string FromTo(const Diagnosis& d, const FreeParameter& p, double after) {
  const bool scales = IsLength(p) || p.change.operation == Change::Operation::kScale;
  if (scales || p.change.operation == Change::Operation::kAdd) {
    const std::string none = scales ? "1" : "0";
    return Value(after) == none ? "" : (scales ? "times " : "plus ") + Value(after);
  }
  const auto before = Before(d, p);
  if (!before) return Value(after);
  return Value(*before) == Value(after) ? "" : Value(*before) + " → " + Value(after);
}

// Whose values the extended files hold.
const Fitted& FitOf(const Diagnosis& d, const ExtensionRun& run) {
  return run.offered ? d.last() : d.before;
}

std::string FittedInWords(const Diagnosis& d, const Fitted& fitted, std::size_t i) {
  const FreeParameter& p = d.parameters_before[i];
  const auto at = static_cast<Eigen::Index>(i);
  const double after = fitted.fit.x[at];
  const std::string step = FromTo(d, p, after);
  if (step.empty()) return "";
  std::string text = NameOf(p) + ": " + step + Unit(p.unit);
  if (AtBound(fitted, at))
    text += ", **at its " + NearerBound(after, p.lower, p.upper) + " bound**";
  return text;
}

std::string AddedInWords(const Hypothesis& h, const Fitted& fitted, Eigen::Index begin) {
  return fmt::format("{} **{}** at {}: {}{}", h.OnlyMeasured() ? "measures with" : "adds", h.Name(),
                     h.where, ValuesInWords(h, fitted, begin),
                     h.replaces.empty() ? "" : "; it takes the place of " + h.replaces);
}

}  // namespace

std::string UnitOfExtra(const Hypothesis& h, std::size_t i) {
  const std::string name = h.extra[i].name.substr(0, h.extra[i].name.find('['));  // of a condition
  const auto shown = h.units.find(name);
  if (shown != h.units.end()) return shown->second;
  return h.extra[i].unit == "1" ? "" : h.extra[i].unit;
}

namespace {

// An overdamped lag of second order is two of first order, T = (ζ ± √(ζ² − 1))/ω: one where it says
// no more than that.
std::string LagsInWords(const Hypothesis& h, const Problem::Vector& x, Eigen::Index begin) {
  if (h.effect != Pt2::kName) return "";
  const double w = x[begin], zeta = x[begin + 1];
  if (!(zeta > 1)) return "";
  const double root = std::sqrt(zeta * zeta - 1), slow = (zeta + root) / w,
               fast = (zeta - root) / w;
  constexpr double kNone = 0.1;  // of the slow one
  if (fast < kNone * slow) return fmt::format("; as a first-order lag of {} s", Value(slow));
  return fmt::format("; as lags of {} and {} s one after the other", Value(slow), Value(fast));
}

}  // namespace

std::string ValuesInWords(const Hypothesis& h, const Fitted& fitted, Eigen::Index begin) {
  std::string text;
  for (std::size_t i = 0; i < h.extra.size(); ++i) {
    const Eigen::Index at = begin + static_cast<Eigen::Index>(i);
    const double value = fitted.fit.x[at];
    const double null = i < h.null.size() ? h.null[i] : 0;
    const bool from = std::isfinite(null) && null != 0;
    const Uncertainty* const u = fitted.complete() ? &fitted.sensitivities->uncertainty : nullptr;
    const int digits = u ? DigitsOf(*u, value, at) : kDigits;
    text +=
        fmt::format("{}{} {}{}{}", text.empty() ? "" : ", ", h.extra[i].name,
                    from ? Value(null) + " → " : "", Value(value, digits), Unit(UnitOfExtra(h, i)));
    std::string notes;
    const auto add = [&](const std::string& note) {
      if (!note.empty()) notes += (notes.empty() ? "" : "; ") + note;
    };
    if (u) {
      add(Interval(*u, at, digits));
      add(AtFineStep(*u, value, at, digits));
      add(ByNumbers(*u, at, Unit(UnitOfExtra(h, i))));
    }
    if (AtBound(fitted, at))
      add(fmt::format("**at its {} bound**",
                      NearerBound(value, h.extra[i].lower, h.extra[i].upper)));
    if (!notes.empty()) text += " (" + notes + ")";
  }
  return text + LagsInWords(h, fitted.fit.x, begin);
}

std::vector<std::string> ChangesInWords(const Diagnosis& d, const ExtensionRun& run) {
  std::vector<std::string> changes;
  const bool added = run.offered && d.chosen();
  if (added && d.partner)
    changes.push_back(AddedInWords(d.partner->hypothesis, d.last(), d.before.fit.x.size()));
  if (added)
    changes.push_back(AddedInWords(d.chosen()->hypothesis, d.last(), d.chosen()->first_extra()));
  for (std::string& one : FittedValuesInWords(d, run)) changes.push_back(std::move(one));
  return changes;
}

std::vector<std::string> FittedValuesInWords(const Diagnosis& d, const ExtensionRun& run) {
  std::vector<std::string> values;
  for (std::size_t i = 0; i < d.parameters_before.size(); ++i) {
    if (d.parameters_before[i].IsStart()) continue;
    std::string one = FittedInWords(d, FitOf(d, run), i);
    if (!one.empty()) values.push_back(std::move(one));
  }
  return values;
}

std::vector<std::string> AtBoundInWords(const Diagnosis& d, const ExtensionRun& run) {
  std::vector<std::string> all;
  const Fitted& fitted = FitOf(d, run);
  const auto& parameters = run.offered ? d.parameters : d.parameters_before;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const FreeParameter& p = parameters[i];
    if (p.IsStart() || at >= fitted.fit.x.size() || !AtBound(fitted, at)) continue;
    const double value = fitted.fit.x[at];
    all.push_back(fmt::format("{} = {}{}, its {} bound", p.name, Value(value), Unit(p.unit),
                              NearerBound(value, p.lower, p.upper)));
  }
  return all;
}

}  // namespace continuum
