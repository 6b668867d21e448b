#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/core.h>

#include "sim/check/rules.h"
#include "sim/check/series_statistics.h"
#include "sim/io/units.h"

namespace continuum {
namespace {

using Severity = Finding::Severity;

// Share of the rows in which a moves and b has the very same number.
double SharedValues(const CheckedColumn& a, const CheckedColumn& b) {
  std::size_t moved = 0, same = 0;
  for (std::size_t k = 1; k < a.value.size(); ++k) {
    if (a.value[k] == a.value[k - 1]) continue;
    ++moved;
    same += a.value[k] == b.value[k];
  }
  return moved < 20 ? 0 : static_cast<double>(same) / static_cast<double>(moved);
}

void CheckCopies(const CheckedLog& log, Findings& out) {
  const auto& columns = log.columns;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (std::size_t j = i + 1; j < columns.size(); ++j) {
      if (columns[i].row != columns[j].row || columns[j].constant()) continue;
      const double share = SharedValues(columns[i], columns[j]);
      if (share < 0.9) continue;
      const bool measured = !columns[i].input && !columns[j].input;
      out.Add(
          measured ? Severity::kWarning : Severity::kInfo, columns[j].name, "copied",
          fmt::format("repeats column '{}' in {:.3g} % of its rows", columns[i].name, 100 * share));
    }
  }
}

void CheckQuaternion(const CheckedLog& log, std::size_t first, Findings& out) {
  const Log& data = *log.log;
  const std::string& name = log.experiment->channels[first].name;
  std::size_t flips = 0, off = 0, first_off = 0;
  double worst = 0;
  for (std::size_t k = 0; k < data.rows(); ++k) {
    double squares = 0, dot = 0;
    for (std::size_t c = first; c < first + 4; ++c) {
      squares += data.measured[c][k] * data.measured[c][k];
      if (k > 0) dot += data.measured[c][k] * data.measured[c][k - 1];
    }
    const double miss = std::abs(std::sqrt(squares) - 1);
    if (miss > 0.01 && off++ == 0) first_off = k;
    if (miss > worst) worst = miss;
    flips += dot < 0;
  }
  if (off > 0) {
    out.Add(
        Severity::kWarning, name, "quaternion_norm",
        fmt::format("the quaternion's length is off 1 by more than 1 % in {} of {} rows, at most "
                    "by {:.2g}: a component is corrupt",
                    off, data.rows(), worst),
        data.time[first_off], data.time.back());
  }
  if (flips > 0) {
    out.Add(Severity::kInfo, name, "quaternion_flip",
            fmt::format("the quaternion changes its sign {} time{}, which is the same orientation",
                        flips, flips == 1 ? "" : "s"));
  }
}

bool IsAngle(const std::string& unit) { return ParseUnit(unit, "").IsAngle(); }
bool IsLength(const std::string& unit) { return ParseUnit(unit, "").Is({1, 0, 0, 0}); }
bool IsTurnRate(const std::string& unit) { return ParseUnit(unit, "").Is({0, 0, -1, 0}); }
bool IsSpeed(const std::string& unit) { return ParseUnit(unit, "").Is({1, 0, -1, 0}); }

bool IsRate(const std::string& unit) { return ParseUnit(unit, "").dimension[2] == -1; }
bool IsRateOf(const std::string& rate, const std::string& position) {
  return (IsTurnRate(rate) && IsAngle(position)) || (IsSpeed(rate) && IsLength(position));
}

constexpr std::size_t kReach = 4;  // rows on either side of a secant

// Displacement over 2 kReach rows in SI: of a position by its difference, of a velocity by its
// integral, so that neither is differentiated.
std::vector<double> Travel(const CheckedColumn& c, bool rate) {
  const double factor = UnitFactor(c.unit, "");
  std::vector<double> path(c.value);
  if (rate) {
    path.assign(c.value.size(), 0);
    for (std::size_t k = 1; k < path.size(); ++k) {
      path[k] = path[k - 1] + 0.5 * (c.value[k] + c.value[k - 1]) * (c.time[k] - c.time[k - 1]);
    }
  }
  std::vector<double> travel;
  for (std::size_t k = kReach; k + kReach < path.size(); ++k) {
    travel.push_back(factor * (path[k + kReach] - path[k - kReach]));
  }
  return travel;
}

std::ptrdiff_t Reach(std::size_t rows, std::ptrdiff_t most) {
  return std::min<std::ptrdiff_t>(most, static_cast<std::ptrdiff_t>(rows) / 8);
}

void ReportVelocity(const CheckedColumn& rate, const CheckedColumn& position, const Lag& lag,
                    double period, Findings& out) {
  const double scale = std::abs(lag.slope);
  if (lag.slope < 0) {
    out.Add(Severity::kWarning, rate.name, "sign_suspect",
            fmt::format("has the sign opposite to the derivative of '{}' (correlation {:.2f})",
                        position.name, lag.correlation));
  }
  // Noise lifts either deviation: the true scale lies between scale · certain and scale / certain.
  const double certain = std::abs(lag.correlation);
  const double allowed = 0.05 + rate.quantum / Deviation(rate.value);
  const auto near = [&](double factor) { return std::abs(scale / factor - 1) < 0.1; };
  const char* reason = nullptr;
  if (near(57.29578)) reason = "degrees for radians";
  if (near(1 / 57.29578)) reason = "radians for degrees";
  if (near(1000)) reason = "millimetres for metres";
  if (near(0.001)) reason = "metres for millimetres";
  if (reason) {
    out.Add(
        Severity::kWarning, rate.name, "unit_suspect",
        fmt::format("is {:.4g} times the derivative of '{}': {}?", scale, position.name, reason));
  } else if (scale * certain > 1 + allowed || scale / certain < 1 - allowed) {
    out.Add(Severity::kWarning, rate.name, "derivative",
            fmt::format("is {:.3g} times the derivative of '{}'", scale, position.name));
  }
  if (std::abs(lag.rows) > std::max(0.7, 4 * lag.sd)) {
    out.Add(Severity::kWarning, rate.name, "lag",
            fmt::format("{} the derivative of '{}' by {:.3g} ms ({:.1f} rows)",
                        lag.rows > 0 ? "lags" : "leads", position.name,
                        1e3 * period * std::abs(lag.rows), std::abs(lag.rows)));
  }
}

void CheckVelocity(const CheckedLog& log, const CheckedColumn& rate, std::size_t rates,
                   Findings& out) {
  const std::vector<double> travel = Travel(rate, true);
  std::optional<Lag> best;
  const CheckedColumn* of = nullptr;
  std::size_t positions = 0;
  // Joints that move alike correlate alike: among them the one nearest in scale and time.
  const auto misfit = [](const Lag& lag) {
    return 50 * (1 - std::abs(lag.correlation)) + std::abs(std::log(std::abs(lag.slope))) +
           std::abs(lag.rows) / 5;
  };
  for (const CheckedColumn& position : log.columns) {
    if (position.input || !position.smooth || position.constant()) continue;
    if (position.row != rate.row || !IsRateOf(rate.unit, position.unit)) continue;
    ++positions;
    const std::ptrdiff_t reach = Reach(travel.size(), 50);
    const auto lag = LagOf(Travel(position, false), travel, -reach, reach, Sign::kAny);
    if (lag && (!best || misfit(*lag) < misfit(*best))) best = lag, of = &position;
  }
  if (best && std::abs(best->correlation) > 0.9) {
    ReportVelocity(rate, *of, *best, log.period, out);
  } else if (positions == 1 && rates == 1 && travel.size() > 100) {
    out.Add(Severity::kWarning, rate.name, "derivative",
            fmt::format("does not follow the derivative of the position (correlation {:.2f})",
                        best ? best->correlation : 0.0));
  }
}

void CheckVelocities(const CheckedLog& log, Findings& out) {
  std::vector<const CheckedColumn*> rates;
  for (const CheckedColumn& c : log.columns) {
    if (!c.input && c.smooth && IsRate(c.unit) && !c.constant()) rates.push_back(&c);
  }
  for (const CheckedColumn* rate : rates) CheckVelocity(log, *rate, rates.size(), out);
}

std::vector<double> Secants(const CheckedColumn& c) {
  std::vector<double> d;
  for (std::size_t k = kReach; k < c.value.size(); ++k)
    d.push_back(c.value[k] - c.value[k - kReach]);
  return d;
}

// Which input an output follows, and how late.
void CheckResponse(const CheckedLog& log, const CheckedColumn& output, Findings& out) {
  const CheckedColumn* cause = nullptr;
  Lag best;
  const std::vector<double> response = Secants(output);
  const std::ptrdiff_t reach = Reach(response.size(), 100);
  for (const CheckedColumn& input : log.columns) {
    if (!input.input || input.constant() || input.row != output.row) continue;
    const auto lag = LagOf(Secants(input), response, -reach, reach, Sign::kAny);
    if (lag && std::abs(lag->correlation) > std::abs(best.correlation)) best = *lag, cause = &input;
  }
  // Ahead of its input only when that is beyond doubt: in feedback and periodic motion it may seem
  // so.
  const double least = best.rows < -0.5 ? 0.95 : 0.75;
  if (!cause || std::abs(best.correlation) < least) return;
  out.Add(
      Severity::kInfo, output.name, "lag",
      fmt::format("{} input '{}' by {:.3g} ms ({:.1f} rows, correlation {:.2f}; in a periodic "
                  "motion up to whole periods)",
                  best.rows >= 0 ? "follows" : "precedes", cause->name,
                  1e3 * log.period * std::abs(best.rows), std::abs(best.rows), best.correlation));
}

// Of each input that asks for such a position.
void CheckStops(const CheckedLog& log, const CheckedColumn& output, Findings& out) {
  const Unit unit = ParseUnit(output.unit, "");
  for (const CheckedColumn& input : log.columns) {
    if (input.input && ParseUnit(input.unit, "").Is(unit.dimension)) CheckStop(output, input, out);
  }
}

}  // namespace

void CheckPairs(const CheckedLog& log, Findings& out) {
  const Experiment& e = *log.experiment;
  CheckCopies(log, out);
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    if (e.outputs[e.channels[c].output].quaternion() && e.channels[c].component == 0) {
      CheckQuaternion(log, c, out);
    }
  }
  CheckVelocities(log, out);
  for (const CheckedColumn& c : log.columns) {
    if (c.input || c.constant() || IsRate(c.unit)) continue;
    CheckResponse(log, c, out);
    CheckStops(log, c, out);
  }
}

}  // namespace continuum
