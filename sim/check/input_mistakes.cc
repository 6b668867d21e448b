#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/core.h>

#include "error.h"
#include "sim/check/against_model.h"
#include "sim/check/series_statistics.h"
#include "sim/experiment/measurement_model.h"
#include "sim/io/interrupt.h"
#include "sim/io/units.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

using Severity = Finding::Severity;
using Values = std::vector<double>;

constexpr std::size_t kRows = 2000;  // of a window at most
constexpr double kSteps = 10'000;    // time steps of a window at most
constexpr double kStepsOfRow = 200;  // about what a quasi-static row takes
constexpr std::size_t kLeastRows = 40;

struct Mistake {
  double factor;     // that mends it
  const char* unit;  // which the numbers should have; null: any
  const char *what, *text;
};
constexpr Mistake kMistakes[]{
    {-1, nullptr, "sign_suspect", "has the wrong sign"},
    {1e-3, nullptr, "unit_suspect", "is in thousandths of its unit (millimetres for metres)"},
    {1e3, nullptr, "unit_suspect", "is in thousands of its unit (metres for millimetres)"},
    {1 / 57.29578, "rad", "unit_suspect", "is in degrees and not in radians"},
    {57.29578, "rad", "unit_suspect", "is in radians and not in degrees"},
    {1e5, "Pa", "unit_suspect", "is in bar and not in pascal"},
    {1e-5, "Pa", "unit_suspect", "is in pascal and not in bar"},
    {6894.757, "Pa", "unit_suspect", "is in psi and not in pascal"},
    {9.80665, "N", "unit_suspect", "is in kilogram-force and not in newton"}};

Log Cut(const Log& whole, std::size_t first, std::size_t last) {
  const auto cut = [&](auto& column) {
    if (column.empty()) return;
    column.erase(column.begin() + static_cast<std::ptrdiff_t>(last), column.end());
    column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(first));
  };
  Log log = whole;
  cut(log.time);
  for (auto* columns : {&log.input, &log.measured}) {
    for (auto& column : *columns) cut(column);
  }
  for (auto& on : log.enable) cut(on);
  return log;
}

Trace Cut(const Trace& whole, std::size_t first, std::size_t last) {
  Trace trace;
  for (const auto& channel : whole.channel) {
    trace.channel.emplace_back(channel.begin() + static_cast<std::ptrdiff_t>(first),
                               channel.begin() + static_cast<std::ptrdiff_t>(last));
  }
  return trace;
}

}  // namespace

// The row after the last of a window that begins at a row.
std::size_t InputMistakes::End(const Log& whole, std::size_t first) const {
  const double h = system_.model().opt.timestep;
  const std::size_t least = std::min(whole.rows(), first + kLeastRows);
  std::size_t end = first;
  while (end < whole.rows() && end < first + kRows) {
    const double steps = experiment_.quasi_static ? kStepsOfRow * static_cast<double>(end - first)
                                                  : (whole.time[end] - whole.time[first]) / h;
    if (steps > kSteps && end >= least) break;
    ++end;
  }
  return end;
}

// A machine that starts at rest is only known at the beginning: the window then grows until the
// input has moved.
InputMistakes::Window InputMistakes::WindowOf(const Log& whole, const Trace& trace,
                                              std::size_t input) const {
  const Values& u = whole.input[input];
  const auto range = [&](std::size_t first, std::size_t last) {
    const auto begin = u.begin() + static_cast<std::ptrdiff_t>(first);
    const auto [low, high] =
        std::minmax_element(begin, u.begin() + static_cast<std::ptrdiff_t>(last));
    return *high - *low;
  };
  std::size_t first = 0, last = End(whole, 0);
  if (experiment_.start == Experiment::Start::kRest) {
    const double enough = 0.5 * RangeOf(u);
    while (last < std::min(whole.rows(), kRows) && range(0, last) < enough) ++last;
  } else {
    for (std::size_t begin = last / 2, end = last; end < whole.rows();
         begin = begin + (end - begin + 1) / 2) {
      end = End(whole, begin);
      if (range(begin, end) > 1.1 * range(first, last)) first = begin, last = end;
    }
  }
  Window window{Cut(whole, first, last), 0};
  window.plain = RelativeError(window.log, Cut(trace, first, last));
  return window;
}

void InputMistakes::Run(const Log& whole, const Trace& trace, Findings& out) {
  std::vector<Window> windows;
  for (std::size_t i = 0; i < experiment_.inputs.size(); ++i)
    windows.push_back(WindowOf(whole, trace, i));
  for (const auto& group : InputsOfOneDimension()) TryMistakes(windows[group.front()], group, out);
  for (std::size_t i = 0; i < windows.size(); ++i) TryMistakes(windows[i], {i}, out);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    for (std::size_t j = i + 1; j < windows.size(); ++j) TrySwap(windows[i], i, j, out);
  }
}

// Mean square over channels of misfit over deviation; infinite where the simulation failed.
double InputMistakes::RelativeError(const Log& log, const Trace& trace) const {
  double sum = 0, count = 0;
  for (const Compared& p : Compare(experiment_, log, trace)) {
    const double deviation = Deviation(p.measured);
    if (!(deviation > 0)) continue;
    sum += std::pow(Misfit(p.measured, p.simulated) / deviation, 2);
    count += 1;
  }
  return count > 0 ? sum / count : HUGE_VAL;
}

double InputMistakes::ErrorOf(const Log& log) {
  --budget_;
  ModelAndData machine = system_.Build(SettingsOfModel(log));
  Trace trace;
  try {
    trace = Simulate(machine, experiment_, log, {}, Hooks::Stoppable());
  } catch (const Error& error) {
    if (error.kind() == Error::Kind::kInput || StopRequested()) throw;
    return HUGE_VAL;
  }
  return trace.diverged ? HUGE_VAL : RelativeError(log, trace);
}

// Inputs of one dimension, which one mistake may concern together.
std::vector<std::vector<std::size_t>> InputMistakes::InputsOfOneDimension() const {
  std::map<std::array<int, 4>, std::vector<std::size_t>> of_dimension;
  for (std::size_t i = 0; i < experiment_.inputs.size(); ++i) {
    const Input& in = experiment_.inputs[i];
    if (!in.column.empty()) of_dimension[ParseUnit(in.unit, "").dimension].push_back(i);
  }
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [dimension, inputs] : of_dimension) {
    if (inputs.size() > 1) groups.push_back(std::move(inputs));
  }
  return groups;
}

void InputMistakes::TryMistakes(Window& window, const std::vector<std::size_t>& inputs,
                                Findings& out) {
  const auto moves = [&](std::size_t i) { return RangeOf(window.log.input[i]) > 0; };
  if (!(window.plain > 0.5) || std::none_of(inputs.begin(), inputs.end(), moves)) return;
  const Unit unit = ParseUnit(experiment_.inputs[inputs.front()].unit, "");
  const auto original = window.log.input;
  const bool one = inputs.size() == 1;
  const std::string column = one ? experiment_.inputs[inputs.front()].column : "";
  for (const Mistake& mistake : kMistakes) {
    if (mistake.unit && !unit.any && unit.dimension != ParseUnit(mistake.unit, "").dimension)
      continue;
    for (const std::size_t i : inputs) {
      for (double& value : window.log.input[i]) value *= mistake.factor;
    }
    const std::string which =
        one ? "this input" : "every input in " + experiment_.inputs[inputs.front()].unit;
    ReportIfExplained(window, column, mistake.what, which + " " + mistake.text, out);
    window.log.input = original;
  }
}

void InputMistakes::TrySwap(Window& window, std::size_t i, std::size_t j, Findings& out) {
  const auto &a = experiment_.inputs[i], &b = experiment_.inputs[j];
  if (a.unit != b.unit || a.column.empty() || b.column.empty()) return;
  auto& input = window.log.input;
  if (!(window.plain > 0.1) || input[i] == input[j]) return;
  std::swap(input[i], input[j]);
  ReportIfExplained(window, a.column, "swapped", "this input is swapped with '" + b.column + "'",
                    out);
  std::swap(input[i], input[j]);
}

void InputMistakes::ReportIfExplained(const Window& window, const std::string& column,
                                      const char* what, const std::string& text, Findings& out) {
  if (budget_ <= 0) return;
  const double error = ErrorOf(window.log);
  if (!(error < std::min(0.1 * window.plain, 0.25))) return;
  out.Add(Severity::kWarning, column, what,
          fmt::format("the simulation fits if {}: relative error {:.2g} instead of {:.2g}", text,
                      std::sqrt(error), std::sqrt(window.plain)));
}

}  // namespace continuum
