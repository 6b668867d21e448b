#pragma once

#include "identification/diagnosis/result.h"

namespace continuum {

/// Finds what a model lacks that measured logs show.
///
/// Fits the model, tries every candidate, and judges: by likelihood where noise is the whole
/// residual of the best one (then also two causes together), else by leaving out one group of logs
/// at a time, beside random forces. What the effort has no time for is left out, and said; so is
/// all that is left once the user asks to end (GracefulEnd). Throws Error for experiments that
/// cannot be diagnosed.
Diagnosis Diagnose(const Experiment& experiment, const ModelSpec& system,
                   const DiagnosisOptions& options = {});

}  // namespace continuum
