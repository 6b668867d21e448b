#include "hidden_effects/study_cases.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "error.h"
#include "hidden_effects/outcome.h"
#include "sim/io/csv.h"
#include "sim/io/file.h"

namespace continuum::hidden {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr char kStudy[] = "study.csv", kExperiment[] = "experiment.yaml", kRecord[] = "row.json";

std::string FolderOf(std::size_t row) { return fmt::format("case_{:05}", row + 1); }

std::string LineOfStudy(const Case& c, std::size_t row, const std::string& effort) {
  const Json line = LineOf(c, {});
  std::string hidden;
  for (const std::string& effect : c.effects) hidden += (hidden.empty() ? "" : "+") + effect;
  return fmt::format("{0}/{1},diagnose,--effort {2},{0},{3},{4},{5},{6},{7},{8},{9}\n",
                     FolderOf(row), kExperiment, effort, c.Name(), line["suite"].get<std::string>(),
                     c.robot, hidden.empty() ? "none" : hidden, c.listed ? "yes" : "no", c.factor,
                     line["noise"].get<std::string>());
}

void AddOnce(const std::string& name, std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

// Effects of an array of causes or candidates.
std::vector<std::string> EffectsOf(const Json& causes) {
  std::vector<std::string> effects;
  for (const Json& cause : causes) AddOnce(cause.at("effect"), effects);
  return effects;
}

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool IsPartner(const Json& cause) {
  return cause.at("probability_is") == "of both causes together";
}

void ReadScreen(const Json& candidates, Answer& a) {
  double most = 0;
  for (const Json& one : candidates) {
    const Json& first = one.at("first_order");
    a.p = std::min(a.p, first.at("p").get<double>());
    if (first.at("explained") > most) most = first["explained"], a.screened = one.at("effect");
  }
}

// The size that was found of what is hidden.
void ReadSize(const Case& c, const Json& cause, Answer& a) {
  if (c.effects.empty() || c.background || cause.at("effect") != c.effects.front()) return;
  const Hidden& h = RobotNamed(c.robot).Named(c.effects.front());
  a.truth = h.null + h.size * c.factor;
  if (!cause.at("parameters").contains(h.parameter)) return;
  const Json& found = cause["parameters"][h.parameter];
  const Json& ends = found.at("ci95");
  if (ends.is_null()) return;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto end = [&](int i, double otherwise) {
    return ends[i].is_number() ? ends[i].get<double>() : otherwise;
  };
  a.value = found.contains("fine_step") ? found["fine_step"] : found.at("value");
  a.low = end(0, -kInfinity), a.high = end(1, kInfinity);
}

void ReadPartner(const Json& partner, bool other_corrects, Answer& a) {
  a.partner = {partner.at("effect")};
  const std::vector<std::string> relatives = partner.at("relatives");
  for (const std::string name : partner.at("equivalent"))
    if (!Has(relatives, name)) a.partner.push_back(name);
  for (const std::string& name : relatives) AddOnce(name, a.relatives);
  const bool corrects = partner.at("correction");
  a.corrects = corrects || other_corrects;
  if (other_corrects && !corrects) std::swap(a.named, a.partner);
}

void ReadNames(const Case& c, const Json& d, Answer& a) {
  for (const char* const of : {"relatives", "alternatives"})
    for (const Json& cause : d.at(of)) ReadSize(c, cause, a);
  a.relatives = EffectsOf(d["relatives"]), a.named = EffectsOf(d["alternatives"]);
  const Json* partner = nullptr;
  bool corrects = false;
  for (const Json& cause : d.at("causes")) {
    if (IsPartner(cause)) {
      partner = &cause;
      continue;
    }
    corrects = cause.value("correction", false);
    for (const std::string name : cause.at("equivalent"))
      if (!Has(a.relatives, name)) AddOnce(name, a.named);
  }
  if (partner) ReadPartner(*partner, corrects, a);
  if (d.at("leading").is_object()) a.leading = d["leading"].at("effect");
}

// What follows from likelihoods.
void ReadProbabilities(const Json& d, Answer& a) {
  const Json& causes = d.at("causes");
  const bool judged = std::any_of(causes.begin(), causes.end(), [](const Json& cause) {
    return cause["probability_is"].get<std::string>().starts_with("posterior");
  });
  const Json& all = d.at("candidates");
  if (!judged) return;
  a.closest = 1e9;
  for (const Json& one : all) {
    if (!one.contains("likelihood")) continue;  // it was not fitted
    const double lambda = one["lambda"];
    if (one["effect"] != all[0]["effect"] && lambda > 0) a.closest = std::min(a.closest, lambda);
    if (causes.size() == 1) a.stated[one["effect"]] += one["probability"].get<double>();
  }
}

Json JsonOf(const fs::path& file) { return Json::parse(ReadFile(file)); }

Answer AnswerIn(const Case& c, const fs::path& folder) {
  Answer a = AnswerFrom(c, JsonOf(folder / "diagnosis.json"));
  a.cpu = JsonOf(folder / kRecord).at("processor_seconds");
  return a;
}

}  // namespace

void WriteStudy(const std::vector<Case>& cases, const std::string& effort, const fs::path& folder) {
  MakeFolder(folder);
  std::string text =
      "experiment,command,options,name,case,suite,robot,hidden,listed,factor,noise\n";
  for (std::size_t i = 0; i < cases.size(); ++i) {
    text += LineOfStudy(cases[i], i, effort);
    if (!fs::exists(folder / FolderOf(i) / kExperiment)) WriteCase(cases[i], folder / FolderOf(i));
  }
  WriteFile(folder / kStudy, text);
}

std::vector<Json> LinesOfStudy(const std::vector<Case>& cases, const fs::path& study,
                               const fs::path& results) {
  const CsvTable table = CsvTable::Read(study / kStudy);
  if (table.rows() != cases.size())
    throw Error::Input((study / kStudy).string(), fmt::format("{} cases", cases.size()),
                       std::to_string(table.rows()));
  std::vector<Json> lines;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::string name = cases[i].Name();
    if (table.Text(i, "case") != name)
      throw Error::Input(table.Where(i), "the case '" + name + "'", table.Text(i, "case"));
    const fs::path whole = results / FolderOf(i), failed = results / (FolderOf(i) + ".failed");
    if (fs::exists(whole)) {
      lines.push_back(LineOf(cases[i], AnswerIn(cases[i], whole)));
    } else if (fs::exists(failed)) {
      lines.push_back(NoAnswer(cases[i], JsonOf(failed / kRecord).at("reason")));
    }
  }
  return lines;
}

Answer AnswerFrom(const Case& c, const Json& d) {
  Answer a;
  a.verdict = d.at("verdict"), a.complete = d.at("complete").get<bool>();
  a.seconds = d.at("seconds");
  const Json &gain = d.at("gain"), &explained = gain.at("explainable_error_removed");
  a.removed = gain.at("validate_error_removed");
  if (explained.is_number()) a.explained = explained.get<double>();
  const Json& lack = d.at("lack_of_fit");
  a.lack = std::min(lack.at("force").get<double>(), lack.at("channel").get<double>());
  ReadScreen(d.at("candidates"), a);
  ReadNames(c, d, a);
  ReadProbabilities(d, a);
  return a;
}

Json NoAnswer(const Case& c, const std::string& why) {
  Answer none;
  none.verdict = "no answer";
  Json line = LineOf(c, none);
  line["what"] = why;
  return line;
}

}  // namespace continuum::hidden
