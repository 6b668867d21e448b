#pragma once

#include <optional>
#include <string>

#include "identification/diagnosis/candidate_fitter.h"
#include "identification/diagnosis/equation_error.h"

namespace continuum {

/// Whether a law that nobody listed is looked for: every candidate leaves more than noise of an
/// error that is plainly more, or none explains a small one. unlisted: error of the best effect
/// that is not one of them; infinite where none was tried.
bool WantsALaw(const Diagnosis& diagnosis, double unlisted);

/// What a search for a law that nobody listed ends with.
struct FoundLaw {
  std::optional<CandidateResult> law;  ///< fitted, worth a comparison by folds
  /// In words: an effect that is not listed, and explains as much of the missing force.
  std::string would_take = {};
};

/// Of the formulas that the missing force suggests (law_search.h) the one that simulates best: the
/// plainest of those that come near it and whose sizes the data are sure of. None where not every
/// joint is measured, or chance does as well; nor, where no effect that is not listed was fitted
/// (unlisted: WantsALaw), where one of these explains as much of the missing force. At its place
/// stands the formula with its numbers: "joint hinge: force = 0.018*sin(9*q)". It takes the main
/// share, which no candidate does, and half of the best one's squares; or else all but noise, or
/// nine tenths. view: of the train logs, at the fit without any.
FoundLaw FindLaw(const CandidateFitter& fitter, const EquationErrors& view,
                 const Diagnosis& diagnosis, const DiagnosisOptions& options, double unlisted);

/// Where a diagnosis has chosen such a law.
std::optional<LawPicture> PictureOfLaw(const Experiment& experiment, const Diagnosis& diagnosis);

/// Makes it one of the candidates, which logs left out then judge; in place of a pair of causes.
void TakeLaw(CandidateResult law, Diagnosis& diagnosis);

}  // namespace continuum
