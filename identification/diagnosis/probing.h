#pragma once

#include <optional>
#include <vector>

#include "identification/diagnosis/result.h"

namespace continuum {

/// The fit without a candidate, as a problem with these steps simulates it.
struct ProbeBase {
  const Problem::Vector& x;
  const std::vector<Problem::Vector>& residuals;  ///< [log]
};

/// Whether its time step decides what it does: to the engine a delay that is shorter than a step is
/// a whole one, and a gear may swing as fast as steps can follow.
bool NeedsOwnStep(const Problem& problem);

/// A problem goes on in a coarse step, of which rows are multiples as far as they are evenly
/// spaced: what an effect changes shows in it as well, at less than half the cost, and at a tenth
/// where the residuals r at x are nearly the same in so coarse a step. Returns those of the train
/// logs in it; nothing, and the step stays, where rows are no farther apart, the problem needs its
/// own step, or diverges in a coarse one.
std::optional<std::vector<Problem::Vector>> StepCoarsely(Problem& problem, const Problem::Vector& x,
                                                         const std::vector<Problem::Vector>& r);

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

/// The share of the plain squares over the logs in use, not in units of the noise, that the
/// amplitudes of a candidate take in its first shape, to first order.
double PlainShare(const Hypothesis& h, const Problem& problem, const ProbeBase& base,
                  const std::vector<bool>& use);

/// Where to begin a candidate's fit: a start of its own, with sizes from its probe. What does
/// nothing without the others begins at excess times its start, as first order says little of it.
Problem::Vector StartFrom(const Hypothesis& h, const Fitted& null, const Probe& probe,
                          const Explained& explained, double excess = 1,
                          const Criteria& criteria = {});

/// Parameters that are known, and then those of a candidate.
Problem::Vector Append(const Problem::Vector& known, const std::vector<double>& own);

}  // namespace continuum
