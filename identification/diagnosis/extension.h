#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "identification/diagnosis/deviations.h"
#include "identification/diagnosis/result.h"
#include "identification/result/extended_model.h"
#include "sim/check/check.h"

namespace continuum {

/// Files of a diagnosis that its parts name.
inline constexpr char kExtendedModel[] = "extended.xml", kExtendedExperiment[] = "extended.yaml";
inline constexpr char kFallbackModel[] = "fallback.xml", kFallbackExperiment[] = "fallback.yaml";
inline constexpr char kNextInputs[] = "next_experiment.csv";

/// The extended model of a diagnosis as files, and what running them gives.
struct ExtensionRun {
  ExtendedModel extended;
  std::string model_before;               ///< MJCF of the model before, as beside the extended one
  std::optional<ExtendedModel> fallback;  ///< none where the diagnosis has none
  std::string next_inputs;                ///< CSV of the next experiment; empty: there is none
  /// Whether the extended files hold a cause: never one that raises the held-out error.
  bool offered = false;
  /// Where it is not: the share of the held-out error that the cause takes off at a quarter of the
  /// model's time step; none where it does not there either.
  std::optional<double> removed_finely = {};
  TwoErrors after;                    ///< of the extended files, simulated as the model steps
  std::vector<Trace> before_traces;   ///< [log]
  std::vector<Trace> after_traces;    ///< [log] of the extended files; empty: not simulated
  std::vector<Deviation> deviations;  ///< of the model before
  std::vector<Finding> findings;      ///< of the log check
  std::vector<MissingPart> missing;   ///< parts of this that could not be made
};

/// Writes extended.xml and extended.yaml of a diagnosis into a folder, which must exist, and runs
/// them from there, so that the errors are those of the files. Where these are larger on the logs
/// held out than those of the model before, the files hold that model with its fitted parameters. A
/// part that fails costs only itself: without that run `after` holds the errors of the fit. Throws
/// Error when the folder cannot be written.
ExtensionRun MeasureExtension(const Experiment& experiment, const Diagnosis& diagnosis,
                              const std::filesystem::path& folder);

}  // namespace continuum
