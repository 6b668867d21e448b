#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "identification/diagnosis/deviations.h"
#include "identification/diagnosis/diagnosis.h"
#include "sim/check/check.h"

namespace continuum {

/// Files of the fallback, where there is one.
inline constexpr char kFallbackModel[] = "fallback.xml", kFallbackExperiment[] = "fallback.yaml";
/// The inputs of the next experiment, where one would part the candidates.
inline constexpr char kNextInputs[] = "next_experiment.csv";
/// What the fallback reaches: "no cause, but ...".
std::string FallbackInWords(const Diagnosis& d);

/// How far runs under different conditions are apart before, and with the candidate that does best
/// there; empty where no trial was run under two.
std::string BetweenInWords(const Experiment& experiment, const Diagnosis& d);

/// What the files of a diagnosis need beyond it.
struct DiagnosisFiles {
  TwoErrors after;  ///< of extended.xml with extended.yaml, as written
  std::vector<Trace> before_traces, after_traces;
  std::vector<Deviation> wrong;
  std::vector<Finding> findings;
  std::string difference;  ///< of the MJCF
};

/// Writes extended.xml, extended.yaml, simulated/*.csv, diagnosis.json and report.html, after
/// having run the two extended files to measure error.after. Returns what was found on the way.
DiagnosisFiles WriteDiagnosis(const Experiment& experiment, const Diagnosis& diagnosis,
                              const std::filesystem::path& folder);

/// The channels of an experiment, in its order; by them diagnoses of the same robot are known.
std::vector<std::string> ChannelNames(const Experiment& experiment);

nlohmann::json DiagnosisJson(const Experiment& experiment, const Diagnosis& diagnosis,
                             const DiagnosisFiles& told);
void WriteDiagnosisReport(const Experiment& experiment, const Diagnosis& diagnosis,
                          const DiagnosisFiles& told, const std::filesystem::path& file);

/// The same story in about fifteen lines.
std::string Summary(const Experiment& experiment, const Diagnosis& diagnosis,
                    const DiagnosisFiles& told);

/// Shared wording.
struct Gain {
  double removed = 0;      ///< 1 − RMS ratio on the validate logs
  double explainable = 0;  ///< (MSE0 − MSE1)/(MSE0 − noise MSE)
};
Gain GainOf(const Diagnosis& diagnosis, const TwoErrors& after);
/// What parts the two best candidates: their likelihoods, or the mean paired difference of their
/// fold errors over its standard error.
double Separation(const Diagnosis& diagnosis);
/// How much a candidate achieves: the share of the explainable sum of squares that its fit explains
/// where noise is all that is left, else the median share of the error removed over the folds.
double Share(const Diagnosis& diagnosis, const CandidateResult& candidate);
bool ModelLimited(const Diagnosis& diagnosis, const TwoErrors& after);
/// Whether nothing that was tried, forces without a name among it, does better than the model.
bool NothingHelps(const Diagnosis& diagnosis);
/// Share of the reducible error (down to the ceiling) that was removed on the validate logs.
double ShareReached(const Diagnosis& diagnosis, const TwoErrors& after);

}  // namespace continuum
