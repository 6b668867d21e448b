#pragma once

#include "identification/diagnosis/result.h"
#include "sim/page/page.h"

namespace continuum {

/// Adds bars of how much of the missing force each candidate explains, without a simulation;
/// nothing where none does.
void AddSecondView(Page& page, const Diagnosis& diagnosis);

/// Adds a table of what each candidate's fit gains, and how sure that is.
void AddLikelihoodTable(Page& page, const Diagnosis& diagnosis);

/// Adds a table of the errors on the logs left out; nothing where there are no folds.
void AddFoldTable(Page& page, const Diagnosis& diagnosis);

}  // namespace continuum
