#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "sim/check/rules.h"
#include "sim/check/series_statistics.h"
#include "sim/io/units.h"

namespace continuum {
namespace {

using Severity = Finding::Severity;
using Values = std::vector<double>;

constexpr std::size_t kLeast = 10;  // rows at a stop
constexpr double kMoves = 0.1;      // of its range, by which the command moves meanwhile
constexpr double kFarther = 3;      // times the distance between them of nine rows in ten
constexpr double kFlat = 1e-3;      // of the range, or three steps of the sensor, or its noise

// Stretches at one end of what a joint reaches, while its command goes on beyond.
struct Stop {
  std::size_t times = 0, rows = 0, first_row = 0, last_row = 0;
  double beyond = 0;  // at most
};

double Largest(const Values& x) { return *std::max_element(x.begin(), x.end()); }

Values Distances(const Values& a, const Values& b) {
  Values d;
  for (std::size_t k = 0; k < a.size(); ++k) d.push_back(std::abs(a[k] - b[k]));
  return d;
}

// y and u with their upward ends alike; quantum: of y.
Stop StopAtTop(const Values& y, const Values& u, double quantum) {
  const double top = Largest(y);
  const double flat = std::max({3 * quantum, 4 * NoiseOf(y), kFlat * RangeOf(y)});
  const double far = std::max(kFarther * Quantile(Distances(u, y), 0.9), kMoves * RangeOf(y));
  Stop stop;
  for (std::size_t k = 0; k < y.size(); ++k) {
    const std::size_t begin = k;
    while (k < y.size() && top - y[k] <= flat) ++k;
    if (k - begin < kLeast) continue;
    const auto [least, most] = std::minmax_element(u.begin() + begin, u.begin() + k);
    if (*most - top < far || *most - *least < kMoves * RangeOf(u)) continue;
    if (stop.times++ == 0) stop.first_row = begin;
    stop.rows += k - begin, stop.last_row = k - 1;
    stop.beyond = std::max(stop.beyond, *most - top);
  }
  return stop;
}

Values Negative(Values x) {
  for (double& value : x) value = -value;
  return x;
}

}  // namespace

// A joint that stands on a stop is not at one exact value: the stop gives, and its sensor has
// steps. What tells it from friction is how far the command goes on.
void CheckStop(const CheckedColumn& output, const CheckedColumn& command, Findings& out) {
  if (output.row != command.row || output.constant() || command.constant()) return;
  const double factor = UnitFactor(command.unit, "") / UnitFactor(output.unit, "");
  Values u = command.value;
  for (double& value : u) value *= factor;
  if (Correlation(u, output.value) < 0.8) return;
  for (const bool upper : {false, true}) {
    const Values& y = output.value;
    const Stop stop = upper ? StopAtTop(y, u, output.quantum)
                            : StopAtTop(Negative(y), Negative(u), output.quantum);
    if (stop.times == 0) continue;
    out.Add(
        Severity::kWarning, output.name, "stop",
        fmt::format("stands at its {} value {} ({} time{}, {} rows) while input '{}' goes up to {} "
                    "beyond it: a stop or a contact that the model may lack",
                    upper ? "largest" : "smallest", Amount(y[stop.first_row], output.unit),
                    stop.times, stop.times == 1 ? "" : "s", stop.rows, command.name,
                    Amount(stop.beyond, output.unit)),
        output.time[stop.first_row], output.time[stop.last_row]);
  }
}

}  // namespace continuum
