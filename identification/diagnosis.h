#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "identification/folds.h"
#include "identification/hypothesis.h"
#include "identification/noise.h"
#include "identification/verdict.h"

namespace continuum {

struct DiagnosisOptions {
  std::vector<std::string> candidates;  ///< names; empty: those of the experiment
  int placebos = 20;
  int iterations = 15;
  std::uint64_t seed = 1;
  std::function<void(const std::string&)> progress = {};
};

struct TwoErrors {
  double train = 0, validate = 0;  ///< pooled RMS
};

/// A model after its fit, with its record over the folds.
struct Fitted {
  Fit fit;
  std::vector<Problem::Vector> residuals;  ///< [log] at the optimum
  std::vector<Problem::Matrix> jacobian;   ///< [log]
  Uncertainty uncertainty;
  TwoErrors error;
  FoldScores folds;
};

struct CandidateResult {
  Hypothesis hypothesis;
  Fitted fitted;
  FoldRecord record;
  std::vector<std::string> failures;
  std::string error;  ///< why it could not be tried, else empty
};

struct Diagnosis {
  Diagnosis(const Experiment& experiment, const System& null) : pool(experiment), system(null) {}

  Pool pool;
  System system;  ///< the model before
  Noise noise;
  Sizes sizes;
  std::vector<Fold> folds;
  Fitted before;
  std::vector<CandidateResult> candidates;  ///< best median gain first
  std::vector<std::string> skipped;
  Verdict verdict;     ///< indices into candidates
  FoldScores ceiling;  ///< what a smooth force without a name reaches
  TwoErrors ceiling_error;
  double gain_low = 0, gain_high = 0;  ///< 95 % interval of the held-out error removed
  double seconds = 0;

  /// The model to extend to, if any: the one that is named, or the best of an ambiguous set.
  const CandidateResult* chosen() const {
    return verdict.named.empty() ? nullptr : &candidates[verdict.named.front()];
  }
  const TwoErrors& after() const { return chosen() ? chosen()->fitted.error : before.error; }
};

/// Fits the model, tries every candidate by leaving out one group of logs at a time, compares them
/// with random forces, and judges. Throws Error for experiments that cannot be diagnosed.
Diagnosis Diagnose(const Experiment& experiment, const System& system,
                   const DiagnosisOptions& options = {});

}  // namespace continuum
