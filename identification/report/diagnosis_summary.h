#pragma once

#include <string>

#include "identification/diagnosis/extension.h"
#include "identification/diagnosis/result.h"

namespace continuum {

/// A diagnosis for the terminal, in about fifteen lines.
std::string Summary(const Experiment& experiment, const Diagnosis& diagnosis,
                    const ExtensionRun& run);

/// What the fallback reaches: "no cause, but a smooth force at ..."; the diagnosis must have one.
std::string FallbackInWords(const Diagnosis& diagnosis);

/// By how much runs under different conditions differ, and with the candidate that does best there;
/// empty where no trial was run under two.
std::string ContrastInWords(const Diagnosis& diagnosis);

}  // namespace continuum
