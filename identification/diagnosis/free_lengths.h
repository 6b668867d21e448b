#pragma once

#include "identification/diagnosis/result.h"

namespace continuum {

/// Diagnose; and where that ends without a name, and no noise tells how far lengths may reach that
/// are a little off (lengths_and_masses.h), once more with the length of each link free, within
/// lengths_off of itself. A swing that is half a per cent too slow is out of phase after ten
/// periods, and hides what takes its energy.
///
/// If that is the better answer, a name or that nothing is missing with far less error left, the
/// lengths become parameters of the experiment. Not where a fit would have more than a few of them.
Diagnosis DiagnoseWithLengths(Experiment& experiment, const ModelSpec& system,
                              const DiagnosisOptions& options = {});

/// The length of a link, as a factor, within what it may be off.
Parameter FreeLength(const Hypothesis& link_length, const Criteria& criteria);
/// Whether an error is so much less than another one that free lengths are the better answer.
bool IsFarLess(double with_lengths, double as_given, const Criteria& criteria);

}  // namespace continuum
