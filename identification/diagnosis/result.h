#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "identification/candidates/hypothesis.h"
#include "identification/candidates/typical_sizes.h"
#include "identification/diagnosis/screening.h"
#include "identification/diagnosis/verdict.h"
#include "identification/inverse_dynamics/missing_force.h"
#include "identification/result/fit.h"
#include "identification/result/folds.h"
#include "identification/result/free_parameter.h"
#include "identification/result/missing_parts.h"
#include "identification/result/noise.h"
#include "identification/result/uncertainty.h"
#include "sim/io/progress.h"

namespace continuum {

/// What a diagnosis does, in this order. It passes over what a case does not need.
enum class DiagnosisStage {
  kNullFit,
  kScreen,
  kFits,
  kOtherCandidates,  ///< at other places, and effects that nobody asked for
  kSecondCause,
  kJudgement,  ///< folds, ceiling, random forces, sensitivities of what is named
  kGain,
  kFallback,
  kNextExperiment,
  kFiles
};

/// That a stage goes on: step `done` of `of`, on what.
Progress ProgressOf(DiagnosisStage stage, const std::string& at = "", std::size_t done = 0,
                    std::size_t of = 0);

/// How long a diagnosis may take on two idle cores: ten seconds, a minute, or as long as it needs.
enum class Effort { kQuick, kNormal, kThorough };

struct DiagnosisOptions {
  std::vector<std::string> candidates = {};  ///< names; empty: those of the experiment
  int placebos = 20;                         ///< random forces to compare with
  int iterations = 15;                       ///< of each fit
  std::uint64_t seed = 1;                    ///< of everything random
  Effort effort = Effort::kThorough;
  double time_share = 1;  ///< of the time of this effort
  ProgressCallback progress = {};
  Criteria criteria = {};  ///< others than the defaults: for tests

  /// Reports what comes next, after `done` steps of `of`. Throws Error (kJob) when the user has
  /// asked to stop.
  void Say(DiagnosisStage stage, const std::string& at = "", std::size_t done = 0,
           std::size_t of = 0) const;
  /// The same options for work whose reports are part of this stage.
  DiagnosisOptions Inside(DiagnosisStage stage, const std::string& at, std::size_t done = 0,
                          std::size_t of = 0) const;
};

/// 95 % interval of the share of the held-out error that an extension removes.
struct GainInterval {
  double low = 0, high = 0;
};

struct TwoErrors {
  double train = 0, validate = 0;  ///< pooled RMS
};

/// Whitened squares that were simulated, with nothing free but what the time step adds.
struct SimulatedSquares {
  double here = 0;   ///< where the fit ended
  double there = 0;  ///< where first order has its least; infinite where that diverges
};

/// What is known of a model next to its fit. It is expensive, so that only those fits have it that
/// may matter to the verdict.
struct Sensitivities {
  std::vector<Problem::Matrix> jacobian;  ///< [train log] of the residuals; after folds [log]
  std::vector<Problem::Matrix> step;      ///< [train log] Problem::StepEffects
  Uncertainty uncertainty;
  double freedom = 0;  ///< what noise alone would make Fitted::cost; 0 where it is not known
  SimulatedSquares simulated = {};  ///< where the noise is known
};

/// A model after its fit.
struct Fitted {
  Fit fit;
  std::vector<Problem::Vector> residuals;  ///< [log] at the optimum
  TwoErrors error;
  double cost = 0;  ///< whitened sum of squares; to first order once sensitivities are known
  std::optional<Sensitivities> sensitivities = {};
  FoldScores folds = {};  ///< empty where it was not cross-validated

  bool complete() const { return sensitivities.has_value(); }
  /// The root of its squares over those of noise; infinite where these are not known.
  double over_noise() const {
    return complete() ? std::sqrt(cost / sensitivities->freedom)
                      : std::numeric_limits<double>::infinity();
  }
};

/// How a candidate explains the missing force (identification/diagnosis/equation_error.h).
struct ByEquation {
  double share = 0;                   ///< of its squares
  std::vector<double> before, after;  ///< [train log] norm of its residual without and with it
};

/// A candidate that was not fitted.
struct Dismissed {
  enum class Why { kExplainsTooLittle, kNoTimeForALook, kNoTimeForAFit, kOthersInVain };
  std::string effect, variant, where;
  double explained = 0, p = 1;  ///< to first order
  Why why = Why::kExplainsTooLittle;
};

/// A candidate, and all that was found of it.
struct CandidateResult {
  Hypothesis hypothesis;
  std::vector<Probe> probes = {};  ///< one for each start: directions from the fit without it
  Problem::Vector start = {};      ///< of its fit, when the screen found one
  std::vector<Problem::Vector> other_starts = {};  ///< that the screen finds as good
  /// What it explains of the missing force at measured states, over what the best one does; 0 where
  /// that is too little.
  double force_promise = 0;
  std::size_t force_start = 0;  ///< start of the shape in which it does
  /// The share of the plain squares that an effect of the sensors alone takes; 0 where that is less
  /// than the main share. To whitening that knows offsets of the noise a constant hardly counts.
  double error_promise = 0;
  /// One that changes the outputs alike, to first order: its place in the order of the fits.
  std::optional<std::size_t> like = {};
  bool was_fitted = false;
  Dismissed::Why why_not = Dismissed::Why::kExplainsTooLittle;  ///< where it was not fitted
  Fitted fitted = {};                                           ///< empty where it was not fitted
  std::optional<Fitted> at_quarter_step = {};  ///< where first order in the step does not hold
  std::optional<Problem::Vector> at_quarter_x = {};  ///< where such a fit ended, better or not
  std::optional<bool> falls_with_step = {};          ///< CandidateSearch::FallsWithStep, once asked
  FoldRecord record = {};
  std::optional<ByEquation> by_equation = {};  ///< none where it does nothing to the missing force
  std::vector<std::string> failures = {};      ///< rules that it fails, one sentence each
  std::string error = "";                      ///< why it could not be tried; empty: it could
  bool listed = true;      ///< else it was looked at because it might outdo those that are
  double explained = 0;    ///< of the whitened sum of squares, to first order from the null fit
  double p = 1;            ///< family-wise, of explained
  double likelihood = 0;   ///< twice the logarithm of the likelihood gained by its fit
  double probability = 0;  ///< among all candidates, each as likely before; noise-limited only
  /// How well the data distinguish it from the leading candidate [squares]: what it cannot imitate
  /// of what that one's fit simulates; to first order from the null fit where one has no fit.
  double lambda = 0;
  std::optional<double> contrast = {};  ///< ConditionContrast; none without such pairs of logs

  /// Where the values of hypothesis.extra begin in fitted.fit.x.
  Eigen::Index first_extra() const {
    return fitted.fit.x.size() - static_cast<Eigen::Index>(hypothesis.extra.size());
  }
};

/// A cause that acts together with the one that the candidates are compared for.
struct Partner {
  /// Which of both only corrects a number of the model that is a little off: the other is the
  /// cause. Where both do, other numbers that are off may do the same, as lengths.
  enum class Correction { kNone, kThis, kOther, kBoth };

  Hypothesis hypothesis;
  std::vector<std::string> equivalent = {};  ///< effects that the data do not distinguish from it
  std::vector<std::string> relatives = {};   ///< the same, of its own family
  /// Effects that could stand for the other one, beside those that the verdict names.
  std::vector<std::string> instead = {};
  bool main =
      true;  ///< by itself it takes more of the error than the other one, or that one corrects
  Correction correction = Correction::kNone;

  bool Corrects() const {
    return correction == Correction::kThis || correction == Correction::kBoth;
  }
  bool OtherCorrects() const {
    return correction == Correction::kOther || correction == Correction::kBoth;
  }
};

/// Two causes that were fitted together, and what both gain in twice the log-likelihood.
struct PairTried {
  std::string first, second;
  double likelihood;
};

/// The force that is missing without a law that was found, on the joint where it does most, and
/// what the law does at the same rows.
struct LawPicture {
  MissingForce missing;
  std::vector<double> law;
};

/// What the model that a verdict leaves still gets wrong.
struct Remaining {
  double over_noise = 0;   ///< its error over the noise; 0: the noise is not known
  std::string where;       ///< "q3 of log pull_2"; empty: nowhere in particular
  std::string would_take;  ///< what would take it, in words; empty: nothing that was tried
};

/// What to measure next to distinguish the models of an ambiguous set.
struct NextExperiment {
  std::string input;            ///< in words; empty: none is needed
  double separation = 0;        ///< expected; see ProposeNext
  std::optional<Log> log = {};  ///< its inputs and what it sets; none where nothing helps
};

/// What a diagnosis found without free lengths of links (free_lengths.h).
struct WithLengthsAsGiven {
  std::string verdict;  ///< in one word
  TwoErrors error;      ///< of the model that it left
};

/// What a diagnosis found.
struct Diagnosis {
  Diagnosis(const Experiment& experiment, const ModelSpec& null) : pool(experiment), system(null) {}

  Pool pool;
  ModelSpec system;   ///< the model before
  Criteria criteria;  ///< by which everything was judged
  Noise noise;
  Sizes sizes;
  std::vector<Fold> folds;
  Fitted before;
  std::vector<CandidateResult> candidates;  ///< best first
  std::vector<CandidateResult> unlisted;    ///< that nobody asked for, and that matter
  std::optional<Partner> partner;           ///< of all candidates: their systems have it
  std::vector<PairTried> pairs;             ///< where no single candidate was enough; best first
  std::vector<Dismissed> dismissed;
  bool noise_limited = false;  ///< likelihoods judged, else the folds
  Remaining remaining;         ///< of the model that the verdict leaves
  LackOfFit lack_of_fit;       ///< of the model that the verdict is about
  std::vector<std::string> skipped;
  std::vector<std::string> left_out;  ///< what there was no time for, in words
  bool interrupted = false;           ///< by the user: the best so far
  Verdict verdict;                    ///< indices into candidates, and into unlisted
  /// The best that anything reached on the folds, forces without a name among it; empty where the
  /// data are noise-limited.
  FoldScores ceiling;
  TwoErrors ceiling_error;  ///< of the same; the noise where the data are noise-limited
  std::string ceiling_by;   ///< what reached it, in words
  std::optional<CandidateResult> fallback;  ///< where nothing explains it (fallback_force.h)
  NextExperiment next;
  MissingForce missing_force;  ///< of the model before; no joint where it cannot be shown
  std::optional<LawPicture> law_picture;  ///< where a law that was found is the cause
  std::optional<double> contrast;         ///< ConditionContrast of the model before
  std::vector<FreeParameter> parameters_before, parameters;  ///< of before, and of last()
  std::vector<Change> changes;       ///< of last(), that hold for every log alike
  std::vector<MissingPart> missing;  ///< what could not be computed; the verdict stands without
  std::optional<GainInterval> gain_interval;  ///< over held-out trials or the folds; none: failed
  std::optional<WithLengthsAsGiven> lengths_as_given;  ///< where the answer is another one
  double seconds = 0;

  bool Is(Verdict::Kind kind) const { return verdict.kind == kind; }
  /// The model to extend to, if any: the one that is named, or the best of an ambiguous set.
  const CandidateResult* chosen() const {
    return verdict.named.empty() ? nullptr : &candidates[verdict.named.front()];
  }
  /// The fit of that model, or of the model before.
  const Fitted& last() const { return chosen() ? chosen()->fitted : before; }
  const TwoErrors& after() const { return last().error; }
};

}  // namespace continuum
