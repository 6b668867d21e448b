#include "identification/diagnosis/gain_interval.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/numerics/portable_random.h"

namespace continuum {
namespace {

using SquaresPair = std::pair<double, double>;  // before and after

// Of each held-out trial, replicates together. Where they are too few to say how the gain varies,
// of the folds.
std::vector<SquaresPair> HeldOutSquares(const Problem& null, const Diagnosis& d,
                                        const CandidateResult& chosen) {
  constexpr std::size_t kEnough = 3;
  const auto& logs = null.experiment().logs;
  std::map<std::string, SquaresPair> trials;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    if (logs[l].train) continue;
    std::vector<bool> one(logs.size(), false);
    one[l] = true;
    const auto sum = [&](const Fitted& f) {
      return std::pow(null.PooledRms(f.residuals, one), 2) * static_cast<double>(logs[l].rows());
    };
    auto& [before, after] = trials[logs[l].trial];
    before += sum(d.before), after += sum(chosen.fitted);
  }
  std::vector<SquaresPair> squares;
  for (const auto& [name, pair] : trials) squares.push_back(pair);
  const auto &before = d.before.folds.error, &after = chosen.fitted.folds.error;
  if (squares.size() >= kEnough || after.size() <= squares.size() || before.size() != after.size())
    return squares;
  squares.clear();
  for (std::size_t f = 0; f < after.size(); ++f)
    squares.emplace_back(before[f] * before[f], after[f] * after[f]);
  return squares;
}

}  // namespace

// Trials left out in turn may all gain less than the validate logs do, or more.
GainInterval BootstrapGain(const Problem& null, const Diagnosis& d, std::uint64_t seed) {
  constexpr int kDraws = 2000;
  if (!d.chosen()) return {};
  const auto squares = HeldOutSquares(null, d, *d.chosen());
  if (squares.empty()) return {};
  Random64 rng(seed);
  std::vector<double> gains;
  for (int k = 0; k < kDraws; ++k) {
    double before = 0, after = 0;
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const auto& s = squares[rng.Bits() % squares.size()];
      before += s.first, after += s.second;
    }
    gains.push_back(before > 0 ? 1 - std::sqrt(after / before) : 0);
  }
  std::sort(gains.begin(), gains.end());
  GainInterval interval{gains[gains.size() * 25 / 1000], gains[gains.size() * 975 / 1000]};
  const double before = d.before.error.validate, after = d.chosen()->fitted.error.validate;
  if (!(before > 0)) return interval;
  return {std::min(interval.low, 1 - after / before), std::max(interval.high, 1 - after / before)};
}

}  // namespace continuum
