#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "identification/result/derivatives.h"
#include "identification/result/identify_result.h"
#include "sim/experiment/experiment.h"
#include "sim/io/progress.h"
#include "sim/model/model_spec.h"

namespace continuum {

struct IdentifyOptions {
  FitMethod method = FitMethod::kLevenbergMarquardt;
  std::optional<Path> path = {};  ///< none: smooth where it can go and gains by it
  int iterations = 0;             ///< at most; 0: as the method has it
  int starts = 1;                 ///< Levenberg-Marquardt: fits, all but the first from random ones
  std::uint64_t seed = 1;         ///< of random starts and of the particle swarm
  std::filesystem::path from = {};  ///< fit.json to start from; empty: the experiment's start
  double differences =
      0;                  ///< stepped path: slopes over this share of a parameter's scale; 0: usual
  double cutoff = 0;      ///< of the inverse model's low-pass [Hz]; 0: usual
  bool all_logs = false;  ///< fit the validate logs too
  bool for_step = false;  ///< after a fit on the smooth path, one at the model's own step
  bool segments = true;   ///< fit long logs in segments first
  std::filesystem::path folder = {};  ///< where fitted.xml and fitted.yaml will stand

  /// Called once, when the job is accepted and before it begins, with how logs are simulated.
  std::function<void(const std::string& how)> accepted = {};
  /// Called after each step of the work.
  ProgressCallback progress = {};
};

/// Fits the parameters of an experiment to its train logs, and computes all that is stated of them:
/// intervals, trade-offs, every log simulated with the fitted values, the error at the model's own
/// step, prediction errors, and the fitted model as files.
///
/// Only the fit itself must succeed: a later part that fails is named in the result. Once the user
/// has asked to stop, the result holds the best fit so far. Throws Error (kInput) for options and
/// experiments that cannot be fitted, and (kJob) when the simulation diverges at the start.
IdentifyResult Identify(const Experiment& experiment, const ModelSpec& system,
                        const IdentifyOptions& options = {});

/// How the derivatives of such a fit are made at its start, parameter by parameter, with the reason
/// of each that is not in closed form. Simulates the logs of the fit once or twice, as what acts on
/// their way counts. Throws Error as Identify does, and (kInput) for methods without derivatives.
Derivatives DerivativesOf(const Experiment& experiment, const ModelSpec& system,
                          const IdentifyOptions& options = {});

/// Throws Error as Identify would for parameters that no fit could have, were it to see all logs.
void CheckParameters(const Experiment& experiment, const ModelSpec& system);

}  // namespace continuum
