#include <algorithm>
#include <map>
#include <vector>

#include <fmt/core.h>

#include "sim/check/rules.h"
#include "sim/experiment/replicates.h"
#include "sim/io/units.h"

namespace continuum {
namespace {

using Severity = Finding::Severity;

struct Trial {
  std::size_t logs = 0, train = 0;
};

// Logs that differ a little from their first in clock or input.
void SayNearReplicates(const std::vector<const Log*>& logs, Findings& out) {
  const Log& first = *logs.front();
  for (const Log* const log : logs) {
    if (AreReplicates(first, *log) || !AreNearReplicates(first, *log)) continue;
    out.Add(Severity::kInfo, "", "trial",
            fmt::format("logs '{}' and '{}' of trial '{}' differ a little in clock or input: for "
                        "the noise they are brought onto the rows of the first",
                        first.label, log->label, first.trial));
  }
}

// A trial whose name stands for two motions; returns how many were recorded more than once.
std::size_t CheckReplicates(const Experiment& e, Findings& out) {
  std::map<std::pair<std::string, std::string>, std::vector<const Log*>> recorded;
  for (const Log& log : e.logs) recorded[{log.trial, log.condition}].push_back(&log);
  std::size_t replicated = 0;
  for (const auto& [name, logs] : recorded) {
    const Log& first = *logs.front();
    const auto other = std::find_if(
        logs.begin(), logs.end(), [&](const Log* log) { return !AreNearReplicates(first, *log); });
    replicated += logs.size() > 1 && other == logs.end();
    SayNearReplicates(logs, out);
    if (other == logs.end()) continue;
    out.Add(Severity::kWarning, "", "trial",
            fmt::format("logs '{}' and '{}' have one trial name, '{}', but other times or inputs: "
                        "they are no replicates, and noise is not known from them",
                        first.label, (*other)->label, name.first));
  }
  return replicated;
}

void CheckTrials(const Experiment& e, Findings& out) {
  std::map<std::string, Trial> trials;
  std::size_t train = 0;
  for (const Log& log : e.logs) {
    ++trials[log.trial].logs;
    trials[log.trial].train += log.train;
    train += log.train;
  }
  const std::size_t replicated = CheckReplicates(e, out);
  for (const auto& [name, trial] : trials) {
    if (trial.train > 0 && trial.train < trial.logs) {
      out.Add(Severity::kWarning, "", "split",
              fmt::format("trial '{}' is in both train and validate: its replicates are no test of "
                          "what was fitted to it",
                          name));
    }
  }
  const std::size_t validate = e.logs.size() - train;
  out.Add(
      Severity::kInfo, "", "split",
      fmt::format("{} log{} of {} trial{}: {} train, {} validate{}", e.logs.size(),
                  e.logs.size() == 1 ? "" : "s", trials.size(), trials.size() == 1 ? "" : "s",
                  train, validate,
                  validate ? "" : "; without validate logs a gain on unseen data cannot be given"));
  if (train == 0) {
    out.Add(Severity::kWarning, "", "split", "no log is marked train: there is nothing to fit");
  }
  out.Add(Severity::kInfo, "", "replicates",
          replicated ? fmt::format("{} trial{} recorded more than once: noise comes from the "
                                   "differences between replicates",
                                   replicated, replicated == 1 ? " was" : "s were")
                     : "no trial was recorded twice: without replicates \"unexplained\" cannot be "
                       "concluded");
}

void CheckOverlap(const Experiment& e, Findings& out) {
  for (std::size_t i = 0; i < e.logs.size(); ++i) {
    for (std::size_t j = i + 1; j < e.logs.size(); ++j) {
      const Log &a = e.logs[i], &b = e.logs[j];
      if (a.measured == b.measured && a.input == b.input) {
        out.Add(Severity::kWarning, "", "duplicate_log",
                fmt::format("logs '{}' and '{}' hold the same numbers: a copy is no replicate",
                            a.label, b.label));
      } else if (!a.file.empty() && a.file == b.file && a.train != b.train &&
                 a.time.front() <= b.time.back() && b.time.front() <= a.time.back()) {
        out.Add(Severity::kWarning, "", "split",
                fmt::format("the windows of '{}' (train and validate) and '{}' overlap", a.label,
                            b.label));
      }
    }
  }
}

// Of position, speed or acceleration: free of mass. Steps are those of a motor.
bool IsKinematic(const std::string& text) {
  const Unit unit = ParseUnit(text, "");
  const bool steps = text.starts_with("step");
  return unit.dimension[1] == 0 && unit.dimension[3] == 0 && (!unit.any || steps);
}

void CheckInvariance(const Experiment& e, Findings& out) {
  if (e.inputs.empty()) return;
  const bool displaced = std::all_of(e.inputs.begin(), e.inputs.end(), [](const Input& in) {
    return in.column.empty() || IsKinematic(in.unit);
  });
  const bool moved = std::all_of(e.outputs.begin(), e.outputs.end(), [](const Output& out) {
    return out.kind == Output::Kind::kSensor && (out.quaternion() || IsKinematic(out.unit));
  });
  const bool weighed = std::any_of(e.logs.begin(), e.logs.end(), [](const Log& log) {
    return std::any_of(log.set.begin(), log.set.end(),
                       [](const Change& s) { return s.attribute == "mass"; });
  });
  if (!displaced || !moved || weighed) return;
  out.Add(
      Severity::kInfo, "", "invariance",
      "inputs are displacement and outputs position: only ratios of mass, stiffness and friction "
      "are determined; a known mass or a force sensor would fix the scale");
}

// "kg cm" of a servo's data sheet is a mass times a length: a tenth of the torque that is meant.
void CheckForcesInMasses(const Experiment& e, Findings& out) {
  for (const Input& in : e.inputs) {
    if (in.column.empty()) continue;
    const Unit unit = ParseUnit(in.unit, in.where);
    const bool mass = unit.Is({0, 1, 0, 0}), moment = unit.Is({1, 1, 0, 0});
    if (!mass && !moment) continue;
    out.Add(
        Severity::kWarning, in.column, "unit_suspect",
        fmt::format("'{}' is a mass{}; a {} is meant? Write kgf, gf, lbf or ozf in place of kg, "
                    "g, lb or oz",
                    in.unit, moment ? " times a length" : "", moment ? "torque" : "force"));
  }
}

}  // namespace

void CheckPlan(const Experiment& e, Findings& out) {
  CheckTrials(e, out);
  CheckOverlap(e, out);
  CheckInvariance(e, out);
  CheckForcesInMasses(e, out);
}

}  // namespace continuum
