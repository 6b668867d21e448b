#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "identification/diagnosis/verdict.h"
#include "sim/io/rounded.h"

// The verdict by cross-validation.
namespace continuum {
namespace {

constexpr double kRounding = 1e-9;  // of counts that are compared with shares

std::size_t FoldsBetter(const std::vector<double>& gains) {
  return std::count_if(gains.begin(), gains.end(), [](double gain) { return gain > 0; });
}

bool EnoughFolds(std::size_t better, std::size_t all, const Criteria& criteria) {
  return static_cast<double>(better) >=
         criteria.folds_better * static_cast<double>(all) - kRounding;
}

bool HasOneSize(const std::vector<double>& amplitude, const Criteria& criteria) {
  const double middle = Median(amplitude);
  return std::all_of(amplitude.begin(), amplitude.end(), [&](double a) {
    return std::abs(a - middle) <= criteria.amplitude_spread * std::abs(middle) && middle != 0;
  });
}

// What the best random force but the luckiest few removes of the error.
double OfPlacebos(std::vector<double> gains, const Criteria& criteria) {
  if (gains.empty()) return 0;
  std::sort(gains.begin(), gains.end());
  const double last = static_cast<double>(gains.size() - 1);
  return gains[static_cast<std::size_t>(std::min(1.0, +criteria.placebo_share) * last)];
}

bool Holds(const std::vector<std::size_t>& set, std::size_t i) {
  return std::find(set.begin(), set.end(), i) != set.end();
}

// Candidates in the order of their gains, and what the folds say of them.
class FoldJudge {
 public:
  FoldJudge(const std::vector<FoldRecord>& candidates, const ErrorLevel& error,
            const Criteria& criteria)
      : candidates_(candidates), error_(error), criteria_(criteria), order_(candidates.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(), [&](auto a, auto b) { return Gain(a) > Gain(b); });
    for (const std::size_t i : order_) {
      if (Failures(candidates[i], criteria).empty()) passing_.push_back(i);
    }
  }

  Verdict Run() const {
    if (error_.over_noise > 0 && error_.over_noise < criteria_.at_noise) {
      return Verdict::Adequate(
          fmt::format("the model's error is {:.2f} times the noise", error_.over_noise));
    }
    Verdict verdict = passing_.empty() ? WithoutAName() : Name();
    if (verdict.kind == Verdict::Kind::kAdequate || order_.empty()) return verdict;
    const std::size_t leading = passing_.empty() ? order_.front() : verdict.named.front();
    if (!passing_.empty() && !IsMain(leading)) verdict = NotMain(leading);
    if (!(Gain(leading) > 0)) return verdict;
    verdict.leading = leading, verdict.leading_share = Share(leading);
    return verdict;
  }

 private:
  double Gain(std::size_t i) const { return Median(Gains(candidates_[i])); }

  double Squares(std::size_t i) const { return SquaresOf(Gain(i)); }
  static double SquaresOf(double gain) { return 1 - (1 - gain) * (1 - gain); }

  // Of the squares that the best of all forces takes off, or this candidate where that is more.
  double Share(std::size_t i) const {
    return std::clamp(Squares(i) / SquaresOf(std::max(error_.ceiling_gain, Gain(i))), 0.0, 1.0);
  }

  // Of the squares above the noise, which repeated trials tell: a model would repeat the rest.
  double OfExplainable(std::size_t i) const {
    return Squares(i) / (1 - 1 / (error_.over_noise * error_.over_noise));
  }
  bool IsMain(std::size_t i) const {
    return !error_.by_replicates || OfExplainable(i) >= criteria_.fold_share;
  }
  Verdict NotMain(std::size_t i) const {
    return {Verdict::Kind::kUnexplained,
            {},
            fmt::format("{} passes all rules, but takes only {} of the squares above the noise on "
                        "logs left out",
                        candidates_[i].name, Percent(OfExplainable(i)))};
  }

  Verdict WithoutAName() const {
    if (error_.over_scatter > criteria_.scatter_limit) {
      return {Verdict::Kind::kUnexplained,
              {},
              fmt::format("no candidate passes all rules, and the model's error is {:.0f} times "
                          "what the measurement scatters from row to row",
                          error_.over_scatter)};
    }
    if (error_.over_noise == 0 && error_.ceiling_gain < criteria_.median_gain) {
      return Verdict::Adequate(
          fmt::format("no candidate and no smooth force removes {:.0f} % of the error, and "
                      "without replicates the noise is not known",
                      100 * criteria_.median_gain));
    }
    return {Verdict::Kind::kUnexplained, {}, "no candidate passes all rules"};
  }

  Verdict Name() const {
    const double margin = std::max<double>(
        criteria_.fold_margin, OfPlacebos(candidates_[passing_.front()].placebo_gains, criteria_));
    const std::size_t best = Plainest(margin);
    Verdict verdict{Verdict::Kind::kNamed, {best}};
    verdict.complete =
        candidates_[best].over_noise > 0 && candidates_[best].over_noise < criteria_.near_noise;
    for (const std::size_t i : order_) {
      if (i == best || !IsRival(i, best, margin)) continue;
      (AreKin(i, best) ? verdict.siblings : verdict.named).push_back(i);
    }
    if (verdict.named.size() > 1) {
      verdict.kind = Verdict::Kind::kAmbiguous;
      verdict.reason =
          fmt::format("the folds do not distinguish {} candidates", verdict.named.size());
    } else {
      verdict.reason = "it passes all rules and is clearly better than every other candidate";
    }
    return verdict;
  }

  bool AreKin(std::size_t a, std::size_t b) const {
    return candidates_[a].kin.Of(candidates_[b].kin);
  }
  bool IsPlainer(std::size_t a, std::size_t b) const {
    return Holds(candidates_[b].contains, a) || candidates_[a].kin.PlainerThan(candidates_[b].kin);
  }

  // Only as deep as the folds allow: the plainest of those that the better one contains or is of
  // one family with, unless it is clearly worse.
  std::size_t Plainest(double margin) const {
    const std::size_t first = passing_.front();
    std::size_t best = first;
    for (const std::size_t i : passing_) {
      const bool most = AreKin(i, first) && Squares(i) >= criteria_.family_share * Squares(first);
      if (IsPlainer(i, best) &&
          (most || !ClearlyBetter(candidates_[first], candidates_[i], margin, criteria_)))
        best = i;
    }
    return best;
  }

  // One that contains the best says no more. Of another family it is behind where the best of the
  // named one's is clearly better.
  bool IsRival(std::size_t i, std::size_t best, double margin) const {
    const std::size_t first = passing_.front();
    const std::size_t judge = AreKin(i, best) || !AreKin(first, best) ? best : first;
    return Gain(i) >= criteria_.rival_gain * Gain(best) &&
           !ClearlyBetter(candidates_[judge], candidates_[i], margin, criteria_) &&
           !Holds(candidates_[i].contains, best);
  }

  const std::vector<FoldRecord>& candidates_;
  const ErrorLevel& error_;
  const Criteria& criteria_;
  std::vector<std::size_t> order_, passing_;
};

}  // namespace

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

std::vector<double> Gains(const FoldRecord& record) {
  std::vector<double> gains;
  for (std::size_t f = 0; f < record.after.size(); ++f) {
    gains.push_back(record.before[f] > 0 ? 1 - record.after[f] / record.before[f] : 0);
  }
  return gains;
}

double Beaten(const FoldRecord& candidate, const std::vector<double>& placebo_gains) {
  const double own = Median(Gains(candidate));
  return static_cast<double>(std::count_if(placebo_gains.begin(), placebo_gains.end(),
                                           [own](double placebo) { return placebo < own; }));
}

std::vector<std::string> Failures(const FoldRecord& record, const Criteria& criteria) {
  if (record.no_time) return {"there was no time for its folds"};
  if (record.behind) {
    return {fmt::format("its fit lowers the error by less than {:.0f} % of what the best one does",
                        100 * criteria.rival_gain)};
  }
  if (record.after.empty()) {
    return {fmt::format("its fit lowers the error by less than {:.0f} % where it was fitted",
                        100 * criteria.fit_gain)};
  }
  std::vector<std::string> failures;
  const auto gains = Gains(record);
  const std::size_t better = FoldsBetter(gains);
  if (static_cast<double>(gains.size()) < criteria.least_folds) {
    failures.push_back(criteria.least_folds == 2
                           ? "fewer than two folds"
                           : fmt::format("fewer than {:g} folds", +criteria.least_folds));
  }
  if (!EnoughFolds(better, gains.size(), criteria)) {
    failures.push_back(fmt::format("the error falls in only {} of {} folds", better, gains.size()));
  }
  if (!(Median(gains) >= criteria.median_gain)) {
    failures.push_back(fmt::format("the error falls by {} in the median, {:.0f} % are asked for",
                                   Percent(Median(gains), 1), 100 * criteria.median_gain));
  }
  if (!HasOneSize(record.amplitude, criteria)) {
    failures.push_back(fmt::format("its size varies over the folds by more than {:.0f} %",
                                   100 * criteria.amplitude_spread));
  }
  const double beaten = Beaten(record, record.placebo_gains);
  if (beaten < criteria.placebo_share * static_cast<double>(record.placebo_gains.size())) {
    failures.push_back(fmt::format("it beats only {:.0f} of {} random smooth forces", beaten,
                                   record.placebo_gains.size()));
  }
  return failures;
}

namespace {

bool Helps(const FoldRecord& record, double least, const Criteria& criteria) {
  const auto gains = Gains(record);
  return Median(gains) >= least && EnoughFolds(FoldsBetter(gains), gains.size(), criteria);
}

}  // namespace

bool HelpsOnFolds(const FoldRecord& record, const Criteria& criteria) {
  return Helps(record, criteria.median_gain, criteria);
}

namespace {

// What takes main_share of the squares takes half of the error.
double LeastGain(double possible, const Criteria& criteria) {
  const double half = 1 - std::sqrt(1 - criteria.main_share);
  return std::min<double>(criteria.median_gain, half * possible);
}

}  // namespace

bool HoldsOnFolds(const FoldRecord& record, double possible, const Criteria& criteria) {
  return Helps(record, LeastGain(possible, criteria), criteria);
}

bool HoldsOnValidateLogs(double before, double after, double floor, const Criteria& criteria) {
  const double possible = std::max(0.0, 1 - floor / before);
  return after <= (1 - LeastGain(possible, criteria) / 2) * before;
}

bool ClearlyBetter(const FoldRecord& a, const FoldRecord& b, double margin,
                   const Criteria& criteria) {
  const std::size_t n = a.after.size();
  if (n < 2) return false;  // no spread
  double mean = 0, squares = 0;
  std::size_t wins = 0;
  std::vector<double> removed;     // of b's error
  std::vector<double> difference;  // in units of the fold's error, so that no fold dominates
  for (std::size_t f = 0; f < n; ++f) {
    removed.push_back(1 - a.after[f] / std::max(1e-300, b.after[f]));
    difference.push_back((b.after[f] - a.after[f]) / std::max(1e-300, a.before[f]));
    mean += difference.back() / static_cast<double>(n);
    wins += difference.back() > 0;
  }
  for (const double d : difference) squares += (d - mean) * (d - mean);
  const double error = std::sqrt(squares / static_cast<double>(n - 1) / static_cast<double>(n));
  return mean > error && EnoughFolds(wins, n, criteria) && Median(removed) > margin;
}

Verdict JudgeFolds(const std::vector<FoldRecord>& candidates, const ErrorLevel& error,
                   const Criteria& criteria) {
  return FoldJudge(candidates, error, criteria).Run();
}

}  // namespace continuum
