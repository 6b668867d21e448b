#pragma once

#include <optional>

#include "identification/diagnosis/result.h"

namespace continuum {

/// What an extension takes off the error on the validate logs.
struct Gain {
  double removed = 0;  ///< 1 − RMS ratio
  /// (MSE0 − MSE1)/(MSE0 − noise MSE); none where the error before is not above the noise.
  std::optional<double> explainable = {};
};
/// after: pooled errors with the extension.
Gain GainOf(const Diagnosis& diagnosis, const TwoErrors& after);

/// How far the two best candidates are apart: in likelihood, or the mean paired difference of their
/// fold errors over its standard error.
double Separation(const Diagnosis& diagnosis);

/// How much a candidate achieves: the share of the explainable sum of squares that its fit explains
/// where the data are noise-limited, else the median share of the error removed over the folds.
double Share(const Diagnosis& diagnosis, const CandidateResult& candidate);

/// Whether the error after the extension is far above the noise.
bool ModelLimited(const Diagnosis& diagnosis, const TwoErrors& after);

/// Whether nothing that was tried, forces without a name among it, does better than the model.
bool NothingHelps(const Diagnosis& diagnosis);

/// Share of the reducible error (down to the ceiling) that was removed on the validate logs.
double ShareReached(const Diagnosis& diagnosis, const TwoErrors& after);

/// Share of the folds in which a candidate is the best one.
double FoldsWon(const Diagnosis& diagnosis, const CandidateResult& candidate);

}  // namespace continuum
