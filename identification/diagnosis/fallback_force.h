#pragma once

#include <optional>

#include "identification/diagnosis/candidate_fitter.h"

namespace continuum {

/// Where no candidate explains what is left, a force that does without being a cause: smooth in
/// angle and speed, without memory, on all joints alike or on one,
///
///   τ_j = p₁ + p₂ x + p₃ w  + p₄ x² + p₅ x w + p₆ w²  + p₇ x³ + p₈ w³,
///   x = tanh(q_j/q₀),  w = tanh(v_j/v₀),  |p_k| ≤ a fifth of the typical torque,
///
/// to first, second or third order, with q₀, v₀ the joints' typical range and speed. The folds say
/// where and to which order. It is a model to simulate with where the logs went, a `formula` in the
/// MJCF. Empty where it does not take a tenth off the error in the median of the folds, and
/// something in four of five.
std::optional<CandidateResult> FindFallback(const CandidateFitter& trials,
                                            const Diagnosis& diagnosis,
                                            const DiagnosisOptions& options);

}  // namespace continuum
