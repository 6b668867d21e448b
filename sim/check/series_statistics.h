#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace continuum {

/// Robust statistics of sampled columns, for `check`. Values in any unit; rows are those with a
/// number.

/// The q-quantile (0 to 1) without interpolation; 0 when empty.
double Quantile(std::vector<double> values, double q);
inline double Median(std::vector<double> values) { return Quantile(std::move(values), 0.5); }
/// Differences from row to row.
std::vector<double> Differences(const std::vector<double>& x);
/// Standard deviation of white noise on a smooth signal: from the median of |second differences|.
double NoiseOf(const std::vector<double>& x);
double RangeOf(const std::vector<double>& x);
/// Different values, counted up to a limit.
std::size_t DistinctValues(const std::vector<double>& x, std::size_t limit);

/// Step of the grid that the values lie on; 0 when they lie on none that matters (fewer than 8
/// levels were visited, or the range has more than 20 000).
double QuantumOf(const std::vector<double>& x);

/// How often a column brings a new value while it moves.
struct Refresh {
  std::vector<bool> repeated;   ///< [row] repeats the one before although the signal moves
  std::size_t moving = 0;       ///< rows in motion
  std::size_t repeats = 0;      ///< of them
  std::size_t frozen = 0;       ///< rows of stretches too long for a refresh, after which it leaps
  double interval = 1;          ///< mean number of rows between new values
  double spread = 0;            ///< standard deviation of that number
  std::size_t longest = 1;      ///< most rows with one value
  std::size_t longest_row = 0;  ///< where they begin

  double share() const {
    return moving ? static_cast<double>(repeats) / static_cast<double>(moving) : 0;
  }
};
/// command: a column that somebody set, for which holding a level is no defect.
Refresh RefreshOf(const std::vector<double>& x, double quantum, bool command);

/// A stretch of rows.
struct Stretch {
  std::size_t begin, end;  ///< rows, end exclusive
  std::size_t size() const { return end - begin; }
};
/// Stretches with one value.
std::vector<Stretch> RunsOf(const std::vector<double>& x);

/// A stretch with one value that begins a column or ends it, of a sensor that is noisy elsewhere:
/// the longer one of more than 30 rows; nullopt where the steps of the sensor hide its noise, or
/// where it comes to the same value elsewhere (clipping).
std::optional<Stretch> FrozenEnd(const std::vector<double>& x, double quantum);

/// A row that stands away from its neighbours.
struct Jump {
  std::size_t row;
  double size;
};
/// How far a row usually is from the middle of its neighbours: the median.
double BendOf(const std::vector<double>& x);
/// Rows that leave and return at once, far beyond the usual bend. command: a column that may hold
/// levels.
std::vector<Jump> SpikesOf(const std::vector<double>& x, double quantum, double usual_bend,
                           bool command);
/// Isolated steps of a signal that is smooth before and after, far beyond the usual bend. skip:
/// rows that may jump for a good reason.
std::vector<Jump> StepsOf(const std::vector<double>& x, double quantum, double usual_bend,
                          const std::vector<bool>& skip);

/// Where b repeats a: b(k) ≈ slope · a(k − rows).
struct Lag {
  double rows = 0;         ///< with the fraction from a parabola through the peak
  double correlation = 0;  ///< at the peak
  double at_zero = 0;      ///< without a lag
  double slope = 0;        ///< std of b over std of a, with the sign of the correlation
  double sd = 0;           ///< standard deviation of rows, for noise that lasts about ten rows
};
enum class Sign { kAny, kAsWithoutLag };
/// Looks from least to most rows for the largest |correlation|; nullopt when either is constant or
/// the peak lies at the border.
std::optional<Lag> LagOf(const std::vector<double>& a, const std::vector<double>& b,
                         std::ptrdiff_t least, std::ptrdiff_t most, Sign sign);
/// Correlation of a(k − lag) with b(k); 0 when either is constant.
double Correlation(const std::vector<double>& a, const std::vector<double>& b,
                   std::ptrdiff_t lag = 0);
/// Root of the mean of (x − mean)².
double Deviation(const std::vector<double>& x);

}  // namespace continuum
