#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/core.h>

#include "error.h"
#include "sim/check/against_model.h"
#include "sim/check/check.h"
#include "sim/check/series_statistics.h"
#include "sim/experiment/measurement_model.h"
#include "sim/experiment/registration.h"
#include "sim/io/interrupt.h"
#include "sim/io/units.h"
#include "sim/simulation/registration_fit.h"
#include "sim/simulation/simulate.h"
#include "sim/simulation/trace_measurement.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

using Severity = Finding::Severity;
using Values = std::vector<double>;

const char* UnitMistake(double ratio) {
  const auto near = [&](double factor) { return ratio > factor / 1.5 && ratio < factor * 1.5; };
  if (near(1000)) return "millimetres for metres, or thousandths of another unit";
  if (near(1e-3)) return "metres for millimetres, or thousands of another unit";
  if (near(57.29578)) return "degrees for radians";
  if (near(1 / 57.29578)) return "radians for degrees";
  return nullptr;
}

void CheckScale(const Compared& p, Findings& out) {
  const double correlation = Correlation(p.simulated, p.measured);
  const double simulated = Deviation(p.simulated), measured = Deviation(p.measured);
  if (std::abs(correlation) < 0.7) return;
  if (correlation < 0) {
    out.Add(
        Severity::kWarning, p.name, "sign_suspect",
        fmt::format("runs against the simulation (correlation {:.2f}): wrong sign of this column "
                    "or of an input?",
                    correlation));
  }
  if (const char* mistake = UnitMistake(measured / simulated)) {
    out.Add(Severity::kWarning, p.name, "unit_suspect",
            fmt::format("is {:.3g} times as large as simulated: {}? (this column or an input)",
                        measured / simulated, mistake));
  }
}

std::optional<Lag> Shift(const Compared& p) {
  if (Deviation(p.simulated) < 0.05 * Deviation(p.measured)) return std::nullopt;  // it rests
  const auto reach = std::min<std::ptrdiff_t>(50, static_cast<std::ptrdiff_t>(p.row.size()) / 8);
  const auto lag = LagOf(p.simulated, p.measured, -reach, reach, Sign::kAsWithoutLag);
  if (!lag || std::abs(lag->correlation) < 0.7) return std::nullopt;
  if (std::abs(lag->rows) < std::max(0.7, 4 * lag->sd)) return std::nullopt;
  // The shift has to explain most of what is left; a wrong damping does not shift that cleanly.
  const double before = 1 - lag->at_zero * lag->at_zero;
  const double after = 1 - lag->correlation * lag->correlation;
  return after < 0.5 * before ? lag : std::nullopt;
}

// judged: columns whose place in time the kinematics know.
void CheckShifts(const std::vector<Compared>& pairs, double period,
                 const std::set<std::string>& judged, Findings& out) {
  std::vector<std::pair<const Compared*, Lag>> shifted;
  for (const Compared& p : pairs) {
    if (const auto lag = Shift(p)) shifted.push_back({&p, *lag});
  }
  const auto say = [&](const Lag& lag) {
    const double seconds = period * std::abs(lag.rows);
    return fmt::format(
        "{} the simulation by {} ({:.1f} rows)", lag.rows > 0 ? "late against" : "ahead of",
        seconds < 1 ? Amount(1e3 * seconds, "ms") : Amount(seconds, "s"), std::abs(lag.rows));
  };
  const bool together = shifted.size() > 1 && shifted.size() == pairs.size() &&
                        std::all_of(shifted.begin(), shifted.end(), [&](const auto& s) {
                          return std::abs(s.second.rows - shifted.front().second.rows) < 0.5;
                        });
  if (together) {
    out.Add(
        Severity::kWarning, "", "clock_shift",
        fmt::format("all outputs are {}: inputs and outputs are on different clocks, or an input "
                    "acts with a dead time",
                    say(shifted.front().second)));
    return;
  }
  for (const auto& [p, lag] : shifted) {
    if (out.Has(p->name, "lag")) continue;
    const bool cleared = judged.contains(p->name);
    out.Add(
        cleared ? Severity::kInfo : Severity::kWarning, p->name, "lag",
        fmt::format("is {}: {}", say(lag),
                    cleared ? "the model lacks a delay, as the column goes with the other outputs"
                            : "the column is shifted, or the model lacks a delay"));
  }
}

// Which simulated channel of the same unit each column resembles best.
void CheckSwaps(const std::vector<Compared>& pairs, Findings& out) {
  std::vector<std::size_t> like(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    like[i] = i;
    double best = 0.3 * Misfit(pairs[i].measured, pairs[i].simulated);
    for (std::size_t j = 0; j < pairs.size(); ++j) {
      if (j == i || pairs[j].unit != pairs[i].unit || pairs[j].row != pairs[i].row) continue;
      const double misfit = Misfit(pairs[i].measured, pairs[j].simulated);
      if (misfit < best && misfit < 0.5 * Deviation(pairs[i].measured)) best = misfit, like[i] = j;
    }
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::size_t j = like[i];
    if (j == i) continue;
    const bool mutual = like[j] == i;
    if (mutual && j < i) continue;
    out.Add(Severity::kWarning, pairs[i].name, "swapped",
            mutual
                ? fmt::format("columns '{}' and '{}' look swapped: each follows what is simulated "
                              "for the other",
                              pairs[i].name, pairs[j].name)
                : fmt::format("follows what is simulated for '{}'", pairs[j].name));
  }
}

// Of the channel in this unit that moves most.
double LargestDeviation(const std::vector<Compared>& pairs, const std::string& unit) {
  double largest = 0;
  for (const Compared& p : pairs) {
    if (p.unit == unit) largest = std::max(largest, Deviation(p.measured));
  }
  return largest;
}

// A column that nothing above explains, and the simulation neither.
void CheckUnlike(const Compared& p, double largest, Findings& out) {
  const double measured = Deviation(p.measured), simulated = Deviation(p.simulated);
  if (measured < std::max(4 * NoiseOf(p.measured), 0.2 * largest) || out.Has(p.name)) return;
  if (Misfit(p.measured, p.simulated) < 0.95 * measured) return;
  const double correlation = Correlation(p.simulated, p.measured);
  if (simulated > 0.05 * measured && std::abs(correlation) > 0.3) return;
  const double unit = UnitFactor(p.unit, "");
  out.Add(Severity::kWarning, p.name, "unlike",
          simulated > 0.05 * measured
              ? fmt::format("does not follow the simulation (correlation {:.2f}): is it another "
                            "quantity, or the model far off?",
                            correlation)
              : fmt::format("moves by {} rms where the simulation moves by {}: does what drives it "
                            "reach the model, and in its unit?",
                            Amount(measured / unit, p.unit), Amount(simulated / unit, p.unit)));
}

// A constant difference while nothing moves.
void CheckRest(const Compared& p, const Log& log, Findings& out) {
  constexpr std::size_t kStill = 10;  // rows
  const double range = RangeOf(p.measured), noise = NoiseOf(p.measured);
  const double simulated_range = RangeOf(p.simulated);
  Values differences;
  std::size_t first = 0, last = 0;
  for (std::size_t k = kStill; k < p.row.size(); ++k) {
    const bool held = std::all_of(log.input.begin(), log.input.end(), [&](const Values& u) {
      return u[p.row[k]] == u[p.row[k - kStill]];
    });
    if (!held || std::abs(p.simulated[k] - p.simulated[k - kStill]) > 1e-3 * simulated_range)
      continue;
    if (std::abs(p.measured[k] - p.measured[k - kStill]) > 6 * noise + 2e-3 * range) continue;
    if (differences.empty()) first = p.row[k];
    last = p.row[k];
    differences.push_back(p.measured[k] - p.simulated[k]);
  }
  if (differences.size() < 20) return;
  const double offset = Median(differences);
  const double spread = Quantile(differences, 0.9) - Quantile(differences, 0.1);
  if (std::abs(offset) < std::max(0.03 * range, 4 * noise) || spread > std::abs(offset) + 4 * noise)
    return;
  out.Add(
      Severity::kWarning, p.name, "offset_at_rest",
      fmt::format("differs from the simulation by {} at rest, {:.2g} % of its range: a "
                  "bias, or a static load that the model lacks",
                  Amount(offset / UnitFactor(p.unit, ""), p.unit), 100 * std::abs(offset) / range),
      log.time[first], log.time[last]);
}

void CheckSimulated(const Experiment& e, const Log& log, const Trace& trace,
                    const std::set<std::string>& judged, Findings& out) {
  const std::vector<Compared> pairs = Compare(e, log, trace);
  for (const Compared& p : pairs) {
    CheckScale(p, out);
    CheckRest(p, log, out);
  }
  if (!e.quasi_static) CheckShifts(pairs, Median(Differences(log.time)), judged, out);
  CheckSwaps(pairs, out);
  for (const Compared& p : pairs) CheckUnlike(p, LargestDeviation(pairs, p.unit), out);
}

// What the registration leaves open must not look like swapped or shifted columns.
void RegisterTraces(const ModelSpec& system, Experiment& e, std::vector<Trace>& traces,
                    std::vector<Finding>& all) {
  if (!e.registration.estimates()) return;
  const Wiring wiring(e, system.model());
  try {
    e.registration = Registered(e, wiring, system.model(), traces);
  } catch (const Error& error) {
    Findings found(nullptr);
    found.Add(Severity::kError, "", "registration", error.what());
    for (Finding& f : found.Take()) all.push_back(std::move(f));
    return;
  }
  for (std::size_t l = 0; l < traces.size(); ++l) {
    if (!traces[l].raw.empty()) MeasureTrace(e, wiring, e.logs[l], traces[l]);
  }
}

}  // namespace

std::vector<Compared> Compare(const Experiment& e, const Log& log, const Trace& trace) {
  std::vector<Compared> all;
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    if (e.outputs[e.channels[c].output].quaternion()) continue;
    Compared p{c, e.channels[c].name, e.channels[c].unit, {}, {}, {}};
    for (std::size_t k = 0; k < log.rows(); ++k) {
      if (!std::isfinite(log.measured[c][k]) || !std::isfinite(trace.channel[c][k])) continue;
      p.measured.push_back(log.measured[c][k]);
      p.simulated.push_back(trace.channel[c][k]);
      p.row.push_back(k);
    }
    if (p.row.size() >= 20) all.push_back(std::move(p));
  }
  return all;
}

double Misfit(const Values& a, const Values& b) {
  Values difference(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) difference[k] = a[k] - b[k];
  return Deviation(difference);
}

std::vector<Finding> CheckAgainstModel(const Experiment& read, const ModelSpec& system) {
  Experiment e = read;
  std::vector<Finding> all;
  std::vector<Trace> traces;
  for (const Log& log : e.logs) {
    Findings found(&log);
    ModelAndData machine = system.Build(SettingsOfModel(log));
    traces.emplace_back();
    try {
      traces.back() = Simulate(machine, e, log, {}, Hooks::Stoppable());
      const Trace& trace = traces.back();
      if (trace.diverged) {
        found.Add(Severity::kWarning, "", "diverged",
                  trace.why.empty()
                      ? fmt::format("the simulation diverges at t = {}", Clock(trace.diverged_at))
                      : trace.why,
                  trace.diverged_at, trace.diverged_at);
      }
    } catch (const Error& error) {
      if (error.kind() == Error::Kind::kInput || StopRequested()) throw;
      found.Add(Severity::kWarning, "", "simulation", error.what());
      traces.back().diverged = true;
    }
    for (Finding& f : found.Take()) all.push_back(std::move(f));
  }
  RegisterTraces(system, e, traces, all);
  InputMistakes trials(e, system);
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    if (traces[l].channel.empty()) continue;
    Findings found(&e.logs[l]);
    CheckRanges(e, e.logs[l], system.model(), found);
    const std::set<std::string> judged = CheckPose(e, e.logs[l], system, found);
    CheckSimulated(e, e.logs[l], traces[l], judged, found);
    trials.Run(e.logs[l], traces[l], found);
    for (Finding& f : found.Take()) all.push_back(std::move(f));
  }
  Findings parameters(nullptr);
  CheckParameterEffects(e, system, parameters);
  CheckParameterRanges(e, system, parameters);
  for (Finding& f : parameters.Take()) all.push_back(std::move(f));
  return all;
}

}  // namespace continuum
