#pragma once

#include <string>
#include <vector>

#include "identification/diagnosis/extension.h"
#include "identification/diagnosis/result.h"

namespace continuum {

/// Whether two numbers that are a little off are all that was found: no cause has a name, as others
/// may do the same.
bool OnlyCorrections(const Diagnosis& diagnosis);

/// The verdict as the first line of a page: "Cause: payload at body tip".
std::string HeadlineOf(const Diagnosis& diagnosis);
/// "to first order it explains too little", or for what there was no time.
std::string WhyNotFitted(const Dismissed& candidate);

/// "**log**, channel at 1.9-2.1 s: the simulation is 0.02 m too high."
std::string DeviationInWords(const Deviation& deviation);

/// How sure a diagnosis is of what it says.
enum class Certainty { kSure, kLikely, kCannotSay };

/// "sure", "likely" or "cannot say".
std::string InWords(Certainty certainty);

/// Of the cause, or for an adequate model of that there is none.
///
/// Sure: noise is all that the named cause leaves, and no other candidate comes near. Likely: it is
/// the best by far, but more than noise is left, the noise is not known, or its place or its exact
/// law is open. Cannot say: several candidates do as well, or none does.
Certainty CertaintyOf(const Diagnosis& diagnosis);

/// Why it is not surer, or why it is sure; one or two sentences without statistics.
std::string WhyInWords(const Diagnosis& diagnosis);

/// How the noise is known, and what was done for it.
std::string NoiseSourceInWords(const Noise& noise);

/// "payload at body tip", "payload at body tip and dahl at joint q", "a at x or b at y"; empty
/// where nothing is named.
std::string CausesInWords(const Diagnosis& diagnosis);

/// "84 % of the held-out error is removed (95 %: 75 … 85 %)"; of one that rises: "the held-out
/// error rises by 3 % (95 %: …)"; without an extension why there is none.
std::string GainInWords(const Diagnosis& diagnosis, const ExtensionRun& run);

/// "the error rises without trial a: 0.1 → 0.2 std" for each group of logs on which the extension
/// is worse when it is fitted to the others.
std::vector<std::string> WorseFoldsInWords(const Diagnosis& diagnosis);

/// What is wrong with the model after the extension: how much, and where most.
std::string RemainsInWords(const Diagnosis& diagnosis, const ExtensionRun& run);

/// What the owner of the logs can do next, most useful first.
std::vector<std::string> NextStepsInWords(const Experiment& experiment, const Diagnosis& diagnosis,
                                          const ExtensionRun& run);

}  // namespace continuum
