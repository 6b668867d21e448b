#include "random_diagnoses/run_case.h"

#include <cmath>
#include <exception>
#include <set>

#include <fmt/format.h>

#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/diagnosis/extension.h"
#include "identification/diagnosis/free_lengths.h"
#include "identification/report/diagnosis_json.h"
#include "identification/report/diagnosis_output.h"
#include "random_diagnoses/random_case.h"
#include "sim/io/file.h"
#include "sim/io/json.h"
#include "sim/replay/replay.h"
#include "sim/simulation/registration_fit.h"
#include "support/child.h"
#include "support/scratch.h"

namespace continuum::random_diagnoses {
namespace {

// Numbers that are not finite, by their path.
void FindOdd(const nlohmann::json& json, const std::string& path, std::vector<std::string>& odd) {
  if (json.is_number_float() && !std::isfinite(json.get<double>()))
    odd.push_back(fmt::format("diagnosis.json: {} = {}", path, json.get<double>()));
  for (auto it = json.begin(); json.is_structured() && it != json.end(); ++it) {
    const std::string key =
        json.is_object() ? "." + it.key() : fmt::format("[{}]", it - json.begin());
    FindOdd(*it, path + key, odd);
  }
}

void FindUnknown(const nlohmann::json& json, const Experiment& e, std::vector<std::string>& odd) {
  std::set<std::string> known;
  for (const EffectInfo& effect : Catalog()) known.emplace(effect.name);
  const auto check = [&](const std::string& name) {
    if (!known.contains(name) && !e.Written(name)) odd.push_back("no effect '" + name + "'");
  };
  for (const auto& cause : json.at("causes")) {
    check(cause.at("effect").get<std::string>());
    for (const auto& other : cause.at("equivalent")) check(other.get<std::string>());
  }
}

DiagnosisOptions SmallBudget() {
  DiagnosisOptions options;
  options.iterations = 2;
  options.placebos = 1;
  return options;
}

// Fills in what does not end the process, as `continuum diagnose` goes through it.
void Diagnosed(const std::filesystem::path& file, const std::filesystem::path& out, Outcome& o) {
  const Experiment read = Experiment::Read(file);
  const ModelSpec system = ModelSpec::Load(read.model);
  CheckNames(read, system);
  Experiment e = Registered(read, system);
  const Diagnosis d = DiagnoseWithLengths(e, system, SmallBudget());
  MakeFolder(out);
  const ExtensionRun run = MeasureExtension(e, d, out);
  WriteDiagnosis(e, d, run, out);
  o.exit_code = run.extended.xml.empty() ? 1 : 0;
  o.verdict = d.verdict.word();
  if (Summary(e, d, run).empty()) o.problems.push_back("no summary");
  std::vector<MissingPart> missing;
  FindOdd(DiagnosisJson(e, d, run, missing), "", o.problems);
  const nlohmann::json json = ReadJson(out / "diagnosis.json");
  if (!json.at("causes").is_null()) FindUnknown(json, e, o.problems);
}

nlohmann::json Work(std::uint64_t seed, const std::filesystem::path& folder) {
  Outcome o;
  o.seed = seed;
  try {
    Diagnosed(WriteRandomCase(seed, folder), folder / "out", o);
  } catch (const Error& error) {
    o.exit_code = error.exit_code(), o.verdict = error.what();
    if (o.verdict.empty()) o.problems.push_back("an error without words");
  } catch (const std::exception& error) {
    o.problems.push_back(std::string("an exception that is no Error: ") + error.what());
  }
  return OutcomeJson(o);
}

}  // namespace

nlohmann::json OutcomeJson(const Outcome& o) {
  return {{"seed", o.seed},       {"exit_code", o.exit_code}, {"verdict", o.verdict},
          {"seconds", o.seconds}, {"problems", o.problems},   {"trace", o.trace}};
}

Outcome RunCase(std::uint64_t seed, unsigned limit, const std::filesystem::path& keep) {
  const testing::Scratch scratch;
  const std::filesystem::path folder = keep.empty() ? scratch.folder() : keep;
  MakeFolder(folder);
  const testing::Ended ended = testing::InChild(
      [&] {
        return Work(seed, folder).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
      },
      limit);
  Outcome o;
  o.seed = seed;
  const auto json = nlohmann::json::parse(ended.text, nullptr, false);
  if (json.is_object()) {
    o.exit_code = json.at("exit_code"), o.verdict = json.at("verdict");
    o.problems = json.at("problems").get<std::vector<std::string>>();
  } else if (ended.too_long) {
    o.problems.push_back(fmt::format("no end in {} s", limit));
  } else {
    o.problems.push_back(ended.signal ? fmt::format("ended by signal {}", ended.signal)
                                      : fmt::format("ended by exit({})", ended.exit_code));
  }
  o.seconds = ended.seconds, o.trace = ended.trace;
  return o;
}

}  // namespace continuum::random_diagnoses
