#include "sim/check/checked_log.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "sim/check/series_statistics.h"
#include "sim/io/units.h"

namespace continuum {
namespace {

CheckedColumn Column(const std::string& name, const std::string& unit, double factor,
                     const Log& log, const std::vector<double>& si) {
  CheckedColumn c;
  c.name = name;
  c.unit = unit;
  for (std::size_t k = 0; k < si.size(); ++k) {
    if (!std::isfinite(si[k])) {
      ++c.missing;
      continue;
    }
    c.time.push_back(log.time[k]);
    c.value.push_back(si[k] / factor);
    c.row.push_back(k);
  }
  c.quantum = QuantumOf(c.value);
  return c;
}

// Turns a quaternion's channels to one sign, so that q and −q are no jump.
void Unflip(const Experiment& e, std::vector<std::vector<double>>& measured) {
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    if (!e.outputs[e.channels[c].output].quaternion() || e.channels[c].component != 0) continue;
    for (std::size_t k = 1; k < measured[c].size(); ++k) {
      double dot = 0;
      for (std::size_t i = c; i < c + 4; ++i) dot += measured[i][k] * measured[i][k - 1];
      for (std::size_t i = c; dot < 0 && i < c + 4; ++i) measured[i][k] = -measured[i][k];
    }
  }
}

void MarkDisturbed(CheckedLog& checked) {
  const Log& log = *checked.log;
  checked.disturbed.assign(log.rows(), false);
  const auto mark = [&](std::size_t row) {
    for (std::size_t k = row; k < std::min(row + 3, log.rows()); ++k) checked.disturbed[k] = true;
  };
  for (std::size_t k = 1; k < log.rows(); ++k) {
    if (log.time[k] - log.time[k - 1] > 2 * checked.period) mark(k);
    for (const auto& on : log.enable) {
      if (!on.empty() && on[k] != on[k - 1]) mark(k);
    }
  }
  for (const auto& input : log.input) {
    const double large = 0.2 * RangeOf(input);
    for (std::size_t k = 1; k < input.size(); ++k) {
      if (std::abs(input[k] - input[k - 1]) > large) mark(k);
    }
  }
}

CheckedLog CheckedLogOf(const Experiment& e, const Log& log) {
  const double period = Median(Differences(log.time));
  CheckedLog checked{&e, &log, {}, period, period, {}};
  std::set<std::string> seen;  // a column may drive several actuators
  for (std::size_t i = 0; i < e.inputs.size(); ++i) {
    const Input& in = e.inputs[i];
    if (in.column.empty() || !seen.insert(in.column).second) continue;
    checked.columns.push_back(
        Column(in.column, in.unit, UnitFactor(in.unit, ""), log, log.input[i]));
    checked.columns.back().input = true;
  }
  auto measured = log.measured;
  Unflip(e, measured);
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const auto& channel = e.channels[c];
    checked.columns.push_back(Column(channel.name, channel.unit, channel.factor, log, measured[c]));
    const Output& output = e.outputs[channel.output];
    checked.columns.back().smooth = output.kind == Output::Kind::kSensor;
    checked.columns.back().sensor = output.source.substr(0, output.source.find('['));
  }
  MarkDisturbed(checked);
  return checked;
}

void SharePeriods(std::vector<CheckedLog>& logs) {
  std::vector<double> periods;
  for (const CheckedLog& log : logs) periods.push_back(log.period);
  for (CheckedLog& log : logs) log.usual_period = Median(periods);
}

// The sensor is the same in all logs: where one log does not show its steps, the others do.
void ShareQuanta(std::vector<CheckedLog>& logs) {
  for (std::size_t c = 0; c < logs.front().columns.size(); ++c) {
    std::vector<double> known;
    for (const CheckedLog& log : logs) {
      if (log.columns[c].quantum > 0) known.push_back(log.columns[c].quantum);
    }
    if (2 * known.size() < logs.size()) continue;
    for (CheckedLog& log : logs) {
      if (log.columns[c].quantum == 0) log.columns[c].quantum = Median(known);
    }
  }
}

// A sensor is as noisy in one direction as in the others: where one hardly moves, they tell.
void ShareBends(std::vector<CheckedLog>& logs) {
  std::map<std::pair<std::string, std::string>, std::vector<double>> bends;
  for (const CheckedLog& log : logs) {
    for (const CheckedColumn& c : log.columns) {
      if (c.smooth) bends[{c.sensor, c.unit}].push_back(BendOf(c.value));
    }
  }
  for (CheckedLog& log : logs) {
    for (CheckedColumn& c : log.columns) {
      if (c.smooth) c.bend = Median(bends[{c.sensor, c.unit}]);
    }
  }
}

}  // namespace

bool CheckedColumn::constant() const {
  return !(RangeOf(value) > 1e-12 * std::abs(value.empty() ? 0 : value.front()));
}

std::vector<CheckedLog> PrepareLogs(const Experiment& e) {
  std::vector<CheckedLog> logs;
  for (const Log& log : e.logs) logs.push_back(CheckedLogOf(e, log));
  if (!logs.empty()) ShareQuanta(logs);
  SharePeriods(logs);
  ShareBends(logs);
  return logs;
}

}  // namespace continuum
