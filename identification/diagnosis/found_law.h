#pragma once

#include <optional>
#include <string>

#include "identification/diagnosis/candidate_fitter.h"

namespace continuum {

/// Whether a law that nobody listed is looked for: every candidate leaves more than noise of an
/// error that is plainly more, or none explains a small one. unlisted: error of the best effect
/// that is not one of them; infinite where none was tried.
bool WantsALaw(const Diagnosis& diagnosis, double unlisted);
/// Whether a law is worth a comparison: it takes the main share, which no candidate does, and half
/// of what the best one leaves; or it leaves nothing but noise, or a tenth. Else what a candidate
/// leaves may be anything small, and a law bends to that.
bool IsBetterLaw(const Diagnosis& diagnosis, const CandidateResult& law, double unlisted);

/// What a search for a law that nobody listed ends with.
struct FoundLaw {
  std::optional<CandidateResult> law;  ///< fitted; none: nothing, or an effect of the catalog
  std::string effect;  ///< "coulomb at joint hinge": not listed, and explains as much
};

/// Of the formulas that the missing force suggests (law_search.h) the one that simulates best: the
/// plainest of those that come near it and whose sizes the data are sure of. None where not every
/// joint is measured, or chance does as well; nor, where no effect that is not listed was fitted
/// (unlisted: WantsALaw), where one of these explains as much of the missing force. At its place
/// stands the formula with its numbers: "joint hinge: force = 0.018*sin(9*q)".
FoundLaw FindLaw(const CandidateFitter& fitter, const Diagnosis& diagnosis,
                 const DiagnosisOptions& options, double unlisted);

/// Where a diagnosis has chosen such a law.
std::optional<LawPicture> PictureOfLaw(const Experiment& experiment, const Diagnosis& diagnosis);

/// Makes it one of the candidates, which logs left out then judge; in place of a pair of causes.
void TakeLaw(CandidateResult law, Diagnosis& diagnosis);

}  // namespace continuum
