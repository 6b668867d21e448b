#pragma once

#include <optional>

#include "identification/diagnosis/candidate_fitter.h"

namespace continuum {

/// The law of such a force with the first terms of the sum below, as a candidate. Each parameter is
/// bounded by Criteria::fallback_size of the typical torque.
WrittenLaw FallbackLaw(std::size_t terms, const Sizes& sizes, const Criteria& criteria = {});

/// A force without a cause, to simulate with where no candidate explains the error.
///
/// Smooth in angle and speed, without memory, on all joints alike or on one,
///
///   τ_j = p₁ + p₂ x + p₃ w  + p₄ x² + p₅ x w + p₆ w²  + p₇ x³ + p₈ w³,
///   x = tanh(q_j/q₀),  w = tanh(v_j/v₀),  |p_k| ≤ Criteria::fallback_size of the typical torque,
///
/// to first, second or third order, with q₀, v₀ the joints' typical range and speed. The folds say
/// where and to which order. It is a `formula` in the MJCF. Empty where it does not help on the
/// folds as a named cause must.
std::optional<CandidateResult> FindFallback(const CandidateFitter& fitter,
                                            const Diagnosis& diagnosis,
                                            const DiagnosisOptions& options);

}  // namespace continuum
