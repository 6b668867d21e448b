#pragma once

#include <limits>
#include <string>
#include <vector>

#include "identification/result/fit.h"
#include "identification/statistics/whitening.h"
#include "sim/io/progress.h"

namespace continuum {

/// A condition that two segments of one log meet: the last rows of one are the first of the other,
/// and what is simulated there should be equal.
struct ContinuityCondition {
  std::size_t before, after;
  Eigen::Index rows;
};

struct FitOptions {
  int iterations = 30;
  double tolerance = 1e-5;  ///< relative decrease of the cost at which it ends
  /// Robust loss: residuals beyond this size (in residual units) count linearly; 0: least squares.
  ///   ρ(r) = s² (√(1 + (r/s)²) − 1)   (soft L1)
  double soft = 0;
  /// Parameters without an effect on any output stay where they start; else they are refused.
  bool idle = false;
  /// Of the residuals, when their noise is known; none: as they are.
  const Whitening* whitening = nullptr;
  std::vector<ContinuityCondition> continuity = {};
  double continuity_weight = 1;  ///< of a difference of residuals there, against the residuals
  /// Give up when even four more steps as good as the last would leave the cost above this.
  double hopeless = std::numeric_limits<double>::infinity();
  int patience = 1;  ///< steps in a row that must look so
  /// By MinimizeBySecants: enough to compare models, at a fraction of the simulations.
  bool rough = false;
  /// Of a rough fit: slopes near its start, if they have columns. Those at its end, if it knows
  /// them: of the loss, in the parameters' sizes.
  Problem::Matrix* slopes = nullptr;
  /// ProcessorSeconds at which to end with what has been reached.
  double until = std::numeric_limits<double>::infinity();
  /// Called after each iteration, with cost and evaluations so far.
  ProgressCallback progress = {};
};

/// Throws Error (kJob; file of the log, time, parameter) when the simulation of a log in use
/// diverges at x: r has no number there. when: in words, "at the start of the fit".
void RequireFinite(const Problem& problem, const Problem::Vector& x,
                   const std::vector<Problem::Vector>& r, const std::vector<bool>& use,
                   const std::string& when);

/// PooledRms of residuals; under a robust loss without outliers, which count as three standard
/// deviations (estimated from the median).
double TypicalRms(const Problem& problem, std::vector<Problem::Vector> residuals,
                  const std::vector<bool>& use);

/// Whether the residuals at x are far more than the measurement noise, where that is known.
bool IsFarOverNoise(const Problem& problem, const Problem::Vector& x, const std::vector<bool>& use);

/// Whether residuals r at x are more than 1.5 times what measurement noise, where sigma or
/// replicates tell it, and the model's own time step make.
bool IsMoreThanNoise(const Problem& problem, const Problem::Vector& x,
                     const std::vector<Problem::Vector>& r, const std::vector<bool>& use);

/// Whitened residuals of the logs in use as the loss counts them: half their squares are the cost.
Problem::Vector LossResiduals(const Problem& problem, const Problem::Vector& x,
                              const std::vector<bool>& use, const FitOptions& options);

/// ½ Σ ρ(r) of whitened residuals, what a fit lowers but for continuity; infinite where it
/// diverges.
double CostAt(const Problem& problem, const Problem::Vector& x, const std::vector<bool>& use,
              const FitOptions& options);

/// Bounded Levenberg-Marquardt (Ceres) over the logs in use, from x. Divergence of the simulation
/// is a rejected step. Throws Error when a parameter has no effect on any output at the start, or
/// the start itself diverges.
Fit FitParameters(const Problem& problem, const Problem::Vector& x, const std::vector<bool>& use,
                  const FitOptions& options = {});

/// Gauss-Newton from x, where the residuals are r, with a fixed Jacobian (per log, at some nearby
/// x): each iteration is one simulation of the logs in use, steps that do not lower the cost are
/// halved. For refits close to a known optimum. Returns the refitted x; never worse than the start
/// on the logs in use.
Problem::Vector RefitByChords(const Problem& problem, const Problem::Vector& x,
                              std::vector<Problem::Vector> r, const std::vector<Problem::Matrix>& J,
                              const std::vector<bool>& use, int iterations = 3);

/// Where the trials of the logs in use begin (identification/problem/start_parameters.h), each
/// fitted to its own log while all else stays: a log that no fit has seen begins somewhere too.
/// Returns x with them.
Problem::Vector FitStarts(const Problem& problem, const Problem::Vector& x,
                          const std::vector<bool>& use);

}  // namespace continuum
