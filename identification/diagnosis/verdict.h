#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "identification/diagnosis/criteria.h"

namespace continuum {

/// What a diagnosis concludes.
struct Verdict {
  enum class Kind {
    kAdequate,    ///< the model needs no further cause
    kNamed,       ///< one cause
    kAmbiguous,   ///< several causes that the data do not distinguish
    kUnexplained  ///< something is missing that no candidate explains
  };
  Kind kind = Kind::kUnexplained;
  std::vector<std::size_t> named = {};     ///< candidates: one when named, more when ambiguous
  std::string reason = {};                 ///< one sentence
  std::vector<std::size_t> unlisted = {};  ///< candidates nobody asked for that do as well
  bool open = false;  ///< unexplained, as there was no time to see whether anything is missing
  bool taken_back = false;        ///< unexplained, as the best fails on logs left out
  std::string explained_by = {};  ///< unexplained, but by this one that nobody asked for
  /// Candidates of the named one's family, or that contain it, that do as well, or better by less
  /// than a richer law has to earn.
  std::vector<std::size_t> siblings = {};
  /// Candidates that do as well as the named one, but are of no plausible size.
  std::vector<std::size_t> far_off = {};
  bool complete = false;                    ///< what the verdict leaves looks like noise
  std::optional<std::size_t> leading = {};  ///< the candidate that comes closest; none: none helps
  double leading_share = 0;                 ///< what it takes of what can be explained [squares]
  /// Ambiguous between numbers of the model that are hardly off: any other one may be off as well.
  bool numbers = false;
  /// Adequate, as lengths and masses that are off by at most this share of themselves do what
  /// shows; 0: nothing shows.
  double numbers_off = 0;

  /// That nothing is left to explain.
  static Verdict Adequate(std::string reason);

  /// "adequate", "named", "ambiguous" or "unexplained".
  std::string word() const;
};

/// The family of one cause, or of several that act together, and how much more than its plainest
/// law it says.
struct Kin {
  std::string family = {};  ///< empty: none
  int depth = 0;

  bool Of(const Kin& other) const { return !family.empty() && family == other.family; }
  /// Whether it is a plainer law of the other one's family.
  bool PlainerThan(const Kin& other) const { return Of(other) && depth < other.depth; }
};
Kin KinOf(std::string_view effect);
/// Its family, or the effect itself where it has none.
std::string FamilyOf(std::string_view effect);
/// Of two causes that act together, in any order.
Kin KinOf(std::string_view effect, std::string_view other);

/// One candidate's cross-validation, and that of random forces with as many parameters.
struct FoldRecord {
  std::string name = {};
  /// Error on the logs left out [fold], without and with the candidate; after: empty when it was
  /// not worth the folds.
  std::vector<double> before = {}, after = {};
  bool no_time = false;                    ///< for its folds
  bool behind = false;                     ///< its fit takes too little beside the best one's
  std::vector<double> amplitude = {};      ///< [fold] its size, in its main parameter, from absence
  std::vector<double> placebo_gains = {};  ///< [random force] median gain over the folds
  double over_noise = 0;                   ///< error of its fit over the noise; 0: noise not known
  std::vector<std::size_t> contains = {};  ///< candidates that it can imitate whatever they do
  Kin kin = {};
};

/// 1 − after/before [fold].
std::vector<double> Gains(const FoldRecord& record);
/// The middle value, or the mean of the two middle ones; 0 of none.
double Median(std::vector<double> values);

/// How many random forces a candidate beats in its median gain.
double Beaten(const FoldRecord& candidate, const std::vector<double>& placebo_gains);

/// The rules that a candidate fails, one sentence each; empty when it may be named.
std::vector<std::string> Failures(const FoldRecord& record, const Criteria& criteria = {});

/// Whether the error falls in enough folds, and by enough in the median.
bool HelpsOnFolds(const FoldRecord& record, const Criteria& criteria = {});

/// The same of a cause that leaves more than noise. possible: the share of the error that noise
/// leaves open; where that is small half of it is enough.
bool HoldsOnFolds(const FoldRecord& record, double possible, const Criteria& criteria = {});
/// Whether the pooled error of the validate logs falls by half of what the folds are asked for in
/// the median. floor: what noise and step make.
bool HoldsOnValidateLogs(double before, double after, double floor, const Criteria& criteria = {});

/// Whether a is better than b in paired folds: by more than one standard error of the mean
/// difference, in enough of them, and by more than a margin [share of b's error] in the median.
bool ClearlyBetter(const FoldRecord& a, const FoldRecord& b, double margin = 0,
                   const Criteria& criteria = {});

/// What is known of the model's error beside the folds.
struct ErrorLevel {
  double over_noise = 0;    ///< of the present model; 0: noise not known
  double ceiling_gain = 0;  ///< median share of the error that any smooth force removes
  double over_scatter = 0;  ///< over the scatter from row to row, where no noise is known better,
                            ///< of the logs of the fit or of those left out
  bool by_replicates = false;  ///< whether repeated trials say so
};

/// The verdict by cross-validation.
Verdict JudgeFolds(const std::vector<FoldRecord>& candidates, const ErrorLevel& error,
                   const Criteria& criteria = {});

/// Tests of the residual of a fitted model against directions that belong to no candidate.
struct LackOfFit {
  double force = 1;      ///< p-value of smooth forces of angle, speed and load
  double channel = 1;    ///< p-value of constants and shifts in time of the channels
  bool of_step = false;  ///< significant, but explained by the time-discretisation error

  double smallest() const { return std::min(force, channel); }
  bool significant(const Criteria& criteria = {}) const {
    return smallest() < criteria.lack_of_fit;
  }
};

/// One candidate where noise is the whole residual of its fit.
struct LikelihoodRecord {
  std::string name = {};
  std::size_t parameters = 0;
  double likelihood = 0;                   ///< twice the logarithm gained over the model without it
  std::vector<std::size_t> contains = {};  ///< candidates that it can imitate whatever they do
  double step = 0;     ///< how much of its misfit is put down to the time step, in the same unit
  bool listed = true;  ///< whether it was asked for: only then it can be named
  Kin kin = {};
  double error_share =
      1;                ///< of the squared error above noise and step that it takes, in plain rows
  double held_out = 0;  ///< error of the logs left out with it, no less than noise and time step
                        ///< make; 0: there are none
  bool corrects =
      false;             ///< it only changes numbers of the model, by a few per cent (OnlyCorrects)
  bool far_off = false;  ///< its size is not plausible (IsFarOff)
};

/// The model without a candidate, by the same measure: whitened squares, and how many of them noise
/// alone would make.
struct BaseSquares {
  double squares = 0, freedom = 0;
  double floor = 0;  ///< of an error in plain rows: what noise and time step make
};

/// Likelihood less what its parameters gain from noise alone. scale: of that noise's squares.
double ScoreOf(const LikelihoodRecord& record, const Criteria& criteria = {}, double scale = 1);

/// What a candidate takes of the squares that noise does not explain, 0 to 1: of the whitened ones,
/// or of those of the plain error where that is less.
double ShareOf(const LikelihoodRecord& record, const BaseSquares& base);

/// Posterior probabilities of the candidates, each as likely before: exp(score/2), normalised.
std::vector<double> ProbabilitiesOf(const std::vector<LikelihoodRecord>& candidates,
                                    const Criteria& criteria = {});

/// The verdict by likelihood. lack: of the best listed candidate or, without a significant one, of
/// the present model; p: family-wise, of the best. A name that an unlisted candidate of another
/// family clearly outdoes is none; one that does as well stands beside it.
///
/// One scale for all data: with c the squares that the best model leaves and ν those of noise, a
/// rival of another family is behind when it leaves more by
///
///   max(rival_margin · max(1, c/ν), left_share · (c − ν), structure_share · e),
///
/// e what it explains. Where only noise is left (c = ν) that is the calibrated test, but for large
/// effects, of which structure_least · e tells nobody apart. Where more is left the best one is
/// named if it takes the main share of what noise does not explain.
Verdict JudgeLikelihoods(const std::vector<LikelihoodRecord>& candidates, const LackOfFit& lack,
                         double p, const BaseSquares& base, const Criteria& criteria = {});

/// Where those explain no main share: names of candidates, best first, that take all of the plain
/// error but what a second cause of its own might. Where the noise drifts or is the same over a
/// log, squares weigh fast motion more than the error does.
std::optional<Verdict> NameByError(const std::vector<LikelihoodRecord>& candidates,
                                   const Criteria& criteria = {});

/// What a residual shows that is not significant: "nothing but noise".
std::string ResidualInWords(const LackOfFit& lack, const Criteria& criteria = {});

}  // namespace continuum
