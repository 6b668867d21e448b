#pragma once

#include "sim/check/checked_log.h"
#include "sim/check/findings.h"
#include "sim/experiment/experiment.h"

namespace continuum {

void CheckClock(const CheckedLog& log, Findings& out);
void CheckColumns(const CheckedLog& log, Findings& out);
/// A column that is flat at its largest or smallest value.
void CheckSaturation(const CheckedColumn& column, Findings& out);
/// An angle that was kept within one turn. Returns whether it was reported.
bool CheckWrapped(const CheckedColumn& column, Findings& out);
void CheckExcitation(const CheckedLog& log, Findings& out);
/// A position that stands at one end of what it reaches while its command, of the same unit, goes
/// on.
void CheckStop(const CheckedColumn& output, const CheckedColumn& command, Findings& out);
/// Copied columns, quaternions, velocities against positions, inputs against outputs,
/// stops.
void CheckPairs(const CheckedLog& log, Findings& out);
/// Replicates, split, what cannot be determined.
void CheckPlan(const Experiment& e, Findings& out);

}  // namespace continuum
