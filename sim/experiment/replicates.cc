#include "sim/experiment/replicates.h"

#include <algorithm>
#include <cmath>

namespace continuum {
namespace {

constexpr double kDuration = 0.1, kInput = 0.05;  // shares by which they may differ

bool IsOneTrial(const Log& a, const Log& b) {
  return a.trial == b.trial && a.condition == b.condition && a.rows() > 1 && b.rows() > 1;
}

double Duration(const Log& log) { return log.time.back() - log.time.front(); }

// The row that holds at a time after the first one.
std::size_t RowAt(const Log& log, double after) {
  const auto next =
      std::upper_bound(log.time.begin(), log.time.end(), log.time.front() + after + 1e-9);
  return next == log.time.begin() ? 0 : next - log.time.begin() - 1;
}

// How far a value is from those of an input about a row: a step may come a row or two later.
double Distance(double u, const std::vector<double>& input, std::size_t row) {
  constexpr std::ptrdiff_t kLate = 2;  // rows
  const auto at = input.begin() + static_cast<std::ptrdiff_t>(row);
  const auto begin = at - std::min(kLate, at - input.begin()),
             end = at + std::min(kLate + 1, input.end() - at);
  const auto [low, high] = std::minmax_element(begin, end);
  return std::max({0.0, u - *high, *low - u});
}

// By the squares of what an input of b differs by, and of what that of a moves.
bool InputIsNear(const Log& a, const Log& b, std::size_t input) {
  double mean = 0, difference = 0, motion = 0;
  const auto rows = static_cast<double>(a.rows());
  for (const double u : a.input[input]) mean += u / rows;
  for (std::size_t k = 0; k < a.rows(); ++k) {
    const double u = a.input[input][k];
    const double off = Distance(u, b.input[input], RowAt(b, a.time[k] - a.time.front()));
    difference += off * off, motion += (u - mean) * (u - mean);
  }
  return difference <= kInput * kInput * motion;
}

}  // namespace

bool AreReplicates(const Log& a, const Log& b) {
  if (a.trial != b.trial || a.condition != b.condition || a.rows() != b.rows()) return false;
  for (std::size_t k = 0; k < a.rows(); ++k) {
    if (std::abs((a.time[k] - a.time[0]) - (b.time[k] - b.time[0])) > 1e-6) return false;
  }
  return a.input == b.input;
}

bool AreNearReplicates(const Log& a, const Log& b) {
  if (AreReplicates(a, b)) return true;
  if (!IsOneTrial(a, b) || a.input.size() != b.input.size()) return false;
  if (std::abs(Duration(a) - Duration(b)) > kDuration * Duration(a)) return false;
  for (std::size_t i = 0; i < a.input.size(); ++i) {
    if (!InputIsNear(a, b, i)) return false;
  }
  return true;
}

}  // namespace continuum
