#pragma once

#include <string>
#include <vector>

namespace continuum {

/// One candidate's record over the folds, and what random forces with as many parameters reached.
struct FoldRecord {
  std::string name;
  /// Error left out, per fold, without and with the candidate; after: empty for a hopeless one.
  std::vector<double> before, after;
  std::vector<double> amplitude;           ///< of its main parameter, per fold
  std::vector<double> placebo_gains;       ///< median gain of each placebo
  double remaining = 0;                    ///< error of its fit over the noise; 0: noise not known
  std::vector<std::size_t> contains = {};  ///< candidates that it can imitate whatever they do
};

/// The rules of a name on model-limited data.
struct Rules {
  double folds_better = 0.8;      ///< share of folds in which the error must fall, or be less
  double median_gain = 0.10;      ///< and by how much in the median
  double fit_gain = 0.05;         ///< and where it was fitted, to be worth the folds
  double amplitude_spread = 0.3;  ///< over the folds, about its median, with one sign
  double placebo_share = 0.95;    ///< of placebos that it must beat
  /// Of a rival's error a better one must remove at least this in the median, and what that share
  /// of the placebos removes of the error without any: what else is wrong favours one or the other.
  double apart = 0.05;
  double noise_reached = 1.25;  ///< error over noise up to which nothing is left to explain
  double noise_limited = 3;     ///< above it the data are model-limited: something always is left
  /// Remaining error over the scatter from row to row, where the noise is not known better.
  double over_scatter = 0;
  double too_much = 10;  ///< times that scatter: plainly no noise
};

/// 1 − after/before per fold, and its median.
std::vector<double> Gains(const FoldRecord& record);
double Median(std::vector<double> values);

/// How many placebos a candidate beats.
double Beaten(const FoldRecord& candidate, const std::vector<double>& placebo_gains);

/// Which rules a candidate fails, in words; empty when it may be named.
std::vector<std::string> Failures(const FoldRecord& record, const Rules& rules = {});

/// Whether a is better than b in paired folds: by more than one standard error of the mean
/// difference, in four of five of them, and by more than a margin in the median.
bool ClearlyBetter(const FoldRecord& a, const FoldRecord& b, double margin = 0);

/// One candidate where noise is all that its fit leaves.
struct LikelihoodRecord {
  std::string name;
  std::size_t parameters = 0;
  double likelihood = 0;                   ///< twice the logarithm gained over the model without it
  std::vector<std::size_t> contains = {};  ///< candidates that it can imitate whatever they do
  double step = 0;     ///< how much of its misfit is put down to the time step, in the same unit
  bool listed = true;  ///< whether it was asked for: only then it can be named
};

struct LikelihoodRules {
  double level = 0.045;  ///< family-wise, of any name at all
  double lack = 0.002;   ///< below it something is left that no name covers; each of two tests
  double apart = 5;      ///< likelihood by which a rival must fall behind
  double deeper = 2.8;   ///< score by which a law must beat one that it contains (99 %)
  /// Share of what is put down to the time step that its first order may miss: names that are
  /// closer are not told apart.
  double step = 0.005;
  double parameter = 3.84;  ///< what another parameter must gain (95 % of chi-squared)
  bool excused = false;     ///< what is left is no more than the time step adds: no sign of a cause
};

struct Verdict {
  std::string text;                        ///< adequate | named | ambiguous | unexplained
  std::vector<std::size_t> named;          ///< one when named, two or more when ambiguous
  std::string reason;                      ///< one sentence
  std::vector<std::size_t> unlisted = {};  ///< that nobody asked for, and that do as well
};

/// What the folds allow one to say. noise_over: remaining error of the present model over the
/// noise, 0 when the noise is unknown; ceiling_gain: median share of the error that any smooth
/// force removed on left-out folds.
Verdict Judge(const std::vector<FoldRecord>& candidates, double noise_over, double ceiling_gain,
              const Rules& rules = {});

/// What the likelihoods allow one to say. lack: p-value of what the best listed candidate (or,
/// without a significant one, the present model) leaves; p: family-wise, of the best. A name that
/// one that is not listed clearly outdoes is none; one that does as well is told beside it.
Verdict JudgeLikelihoods(const std::vector<LikelihoodRecord>& candidates, double lack, double p,
                         const LikelihoodRules& rules = {});

/// What a model leaves whose remainder noise alone would exceed with this probability (from the
/// level rules.lack on), as in "it leaves nothing but noise".
std::string LeftInWords(double lack, const LikelihoodRules& rules = {});

/// Likelihood less what its parameters gain from noise alone.
double ScoreOf(const LikelihoodRecord& record, const LikelihoodRules& rules = {});

/// Posterior probabilities of the candidates by Schwarz-like scores, equal before.
std::vector<double> ProbabilitiesOf(const std::vector<LikelihoodRecord>& candidates,
                                    const LikelihoodRules& rules = {});

}  // namespace continuum
