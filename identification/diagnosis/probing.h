#pragma once

#include "identification/diagnosis/result.h"

namespace continuum {

/// The fit without a candidate, as a problem with these steps simulates it.
struct ProbeBase {
  Problem::Vector x;
  std::vector<Problem::Vector> residuals;  ///< [log]
};

/// Whether its time step decides what it does: to the engine a delay that is shorter than a step is
/// a whole one.
bool NeedsOwnStep(const Problem& problem);

/// A step [s] that is coarse, and rows of the train logs are multiples of it, as far as they are
/// evenly spaced: what an effect changes shows in it as well, at less than half the cost. The
/// problem's own where rows are no farther apart.
double CoarseStep(const Problem& problem);

/// Directions in which a candidate moves the residuals, one probe or two for each of some of its
/// starts.
///
/// Each amplitude is simulated by itself beside the fit without the candidate; where it does far
/// more than is to be explained it is probed at a share of its start, where it does far less once
/// more at a multiple. residual: of the fit without it; calibrated: in units of the noise. Throws
/// Error when the simulation diverges at a start.
std::vector<Probe> ProbesOf(const Hypothesis& h, const Problem& problem, const ProbeBase& base,
                            const ProjectedResidual& residual, bool calibrated,
                            const std::vector<std::size_t>& starts, const Criteria& criteria = {});

/// Where to begin a candidate's fit: a start of its own, with sizes from its probe. What does
/// nothing without the others begins at excess times its start, as first order says little of it.
Problem::Vector StartFrom(const Hypothesis& h, const Fitted& null, const Probe& probe,
                          const Explained& explained, double excess = 1,
                          const Criteria& criteria = {});

/// Parameters that are known, and then those of a candidate.
Problem::Vector Append(const Problem::Vector& known, const std::vector<double>& own);

}  // namespace continuum
