#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "identification/candidates/hypothesis.h"
#include "identification/candidates/typical_sizes.h"
#include "identification/diagnosis/screening.h"
#include "identification/diagnosis/verdict.h"
#include "identification/fit/cross_validation.h"
#include "identification/statistics/noise_model.h"
#include "identification/statistics/uncertainty.h"

namespace continuum {

struct DiagnosisOptions {
  std::vector<std::string> candidates;  ///< names; empty: those of the experiment
  int placebos = 20;
  int iterations = 15;
  std::uint64_t seed = 1;
  std::function<void(const std::string&)> progress = {};

  /// Tells what comes next. Throws Error (kJob) when the user has asked to stop.
  void Say(const std::string& text) const;
};

struct TwoErrors {
  double train = 0, validate = 0;  ///< pooled RMS
};

/// A model after its fit, with its record over the folds.
struct Fitted {
  Fit fit;
  std::vector<Problem::Vector> residuals;  ///< [log] at the optimum
  std::vector<Problem::Matrix> jacobian;   ///< [train log], after folds [log]
  std::vector<Problem::Matrix> step = {};  ///< [train log] what the time step leaves open
  Uncertainty uncertainty;
  TwoErrors error;
  FoldScores folds;       ///< empty where the noise alone decides
  double cost = 0;        ///< whitened sum of squares to first order, where the noise is known
  double freedom = 0;     ///< what noise alone would make it
  bool complete = false;  ///< else only x, residuals, error and the plain cost are known
};

/// How a candidate explains the missing force (identification/diagnosis/equation_error.h).
struct ByEquation {
  double share = 0;                   ///< of its squares
  std::vector<double> before, after;  ///< [train log] norm of what is left of it
};

struct CandidateResult {
  Hypothesis hypothesis;
  std::vector<Probe> probes = {};  ///< one for each start: directions from the fit without it
  Problem::Vector start = {};      ///< of its fit, when the screen found one
  std::vector<Problem::Vector> rivals = {};  ///< starts that the screen finds as good
  bool fits = false;                         ///< whether it was fitted
  Fitted fitted = {};
  std::optional<Fitted> finer = {};  ///< at a quarter of the step, where its effect is of no order
  FoldRecord record = {};
  std::optional<ByEquation> by_equation = {};  ///< none where it cannot be seen there
  std::vector<std::string> failures = {};
  std::string error = "";  ///< why it could not be tried, else empty
  bool listed = true;      ///< else it was looked at because it might outdo those that are
  double explained = 0;    ///< of the whitened sum of squares, to first order from the null fit
  double p = 1;            ///< family-wise, of explained
  double likelihood = 0;   ///< twice the logarithm of the likelihood gained by its fit
  double probability = 0;  ///< among all candidates, each as likely before; noise-limited only
  /// How well the data tell the leading candidate from this one: what this one cannot imitate of
  /// what that explains, in units of twice the log-likelihood, to first order.
  double apart = 0;

  /// Where the values of hypothesis.extra begin in fitted.fit.x.
  Eigen::Index own() const {
    return fitted.fit.x.size() - static_cast<Eigen::Index>(hypothesis.extra.size());
  }
  Problem ProblemOf(const Experiment& experiment) const {
    return Problem(experiment, hypothesis.system, hypothesis.Free());
  }
};

/// A cause that acts together with the one that the candidates are compared for.
struct Partner {
  Hypothesis hypothesis;
  std::vector<std::string> equivalent;  ///< effects that the data do not tell from it
};

/// Two causes that were fitted together, and what both gain in twice the log-likelihood.
struct PairTried {
  std::string first, second;
  double likelihood;
};

/// A candidate that the first-order screen left behind without a fit.
struct Dismissed {
  std::string effect, variant, where;
  double explained = 0, p = 1;
};

/// Whether anything but noise is left in a fitted model, by directions that belong to no candidate.
struct LackOfFit {
  double force = 1;    ///< p-value of smooth forces of angle, speed and load
  double channel = 1;  ///< of constants and shifts in time of the channels
  double smallest() const { return std::min(force, channel); }
};

/// What to measure next to tell the models of an ambiguous set apart.
struct NextExperiment {
  std::string input;            ///< in words; empty: none is needed
  double separation = 0;        ///< expected; see ProposeNext
  std::optional<Log> log = {};  ///< its inputs and what it sets; none where nothing parts them
};

struct Diagnosis {
  Diagnosis(const Experiment& experiment, const ModelSpec& null) : pool(experiment), system(null) {}

  Pool pool;
  ModelSpec system;  ///< the model before
  Noise noise;
  Sizes sizes;
  std::vector<Fold> folds;
  Fitted before;
  std::vector<CandidateResult> candidates;  ///< best first
  std::vector<CandidateResult> unlisted;    ///< that nobody asked for, and that matter
  std::optional<Partner> partner;           ///< of all candidates: their systems have it
  std::vector<PairTried> pairs;             ///< where no single candidate was enough; best first
  std::vector<Dismissed> dismissed;
  bool noise_limited = false;  ///< the best model leaves noise: likelihoods judge, else folds
  LackOfFit lack;              ///< of the model that is left standing
  std::vector<std::string> skipped;
  Verdict verdict;  ///< indices into candidates, and into unlisted
  /// The best that anything reached on the folds, forces without a name among it; empty where the
  /// data are noise-limited.
  FoldScores ceiling;
  TwoErrors ceiling_error;  ///< of the same; the noise where that is all that is left
  std::string ceiling_by;   ///< what reached it, in words
  std::optional<CandidateResult>
      fallback;  ///< where nothing explains it (identification/diagnosis/fallback_force.h)
  NextExperiment next;
  double gain_low = 0, gain_high = 0;  ///< 95 % interval, over held-out trials or the folds
  double seconds = 0;

  /// The model to extend to, if any: the one that is named, or the best of an ambiguous set.
  const CandidateResult* chosen() const {
    return verdict.named.empty() ? nullptr : &candidates[verdict.named.front()];
  }
  const TwoErrors& after() const { return chosen() ? chosen()->fitted.error : before.error; }
};

/// Fits the model, tries every candidate, and judges: by likelihood where noise is all that the
/// best one leaves (then also two causes together), else by leaving out one group of logs at a
/// time, beside random forces. Throws Error for experiments that cannot be diagnosed.
Diagnosis Diagnose(const Experiment& experiment, const ModelSpec& system,
                   const DiagnosisOptions& options = {});

}  // namespace continuum
