#include "identification/study/summary.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "error.h"
#include "sim/io/csv.h"
#include "sim/io/file.h"
#include "sim/io/rounded.h"

namespace continuum {
namespace {

using State = RowStatus::State;

std::string Cell(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : ""; }

// "mass [kg]" of all rows, each once.
std::vector<std::string> ParametersOf(const StudySummary& summary) {
  std::vector<std::string> names;
  for (const StudyLine& line : summary.lines) {
    for (const RowParameter& p : line.result.parameters) {
      const std::string name = fmt::format("{} [{}]", p.name, p.unit);
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

void AddParameters(const RowResult& r, const std::vector<std::string>& names,
                   std::vector<std::string>& cells) {
  for (const std::string& name : names) {
    const auto is = [&](const RowParameter& p) {
      return fmt::format("{} [{}]", p.name, p.unit) == name;
    };
    const auto found = std::find_if(r.parameters.begin(), r.parameters.end(), is);
    const bool has = found != r.parameters.end();
    cells.push_back(has ? Cell(found->value) : "");
    cells.push_back(has ? Cell(found->low) : "");
    cells.push_back(has ? Cell(found->high) : "");
  }
}

std::vector<std::string> CellsOf(const StudySummary& summary, const StudyLine& line,
                                 const std::vector<std::string>& parameters) {
  const RowResult& r = line.result;
  const auto& record = line.status.record;
  std::vector<std::string> cells{std::to_string(line.row->number), line.row->name,
                                 StateName(line.status.state), line.row->command,
                                 line.row->experiment};
  for (const std::string& label : summary.study->labels) {
    const auto found = line.row->labels.find(label);
    cells.push_back(found == line.row->labels.end() ? "" : found->second);
  }
  cells.insert(cells.end(), {r.verdict, r.certainty, r.cause, Cell(r.gain), Cell(r.gain_low),
                             Cell(r.gain_high), r.unit, Cell(r.train), Cell(r.validate),
                             Cell(r.validate_after), record ? Cell(record->seconds) : "",
                             record ? Cell(record->peak_megabytes) : "", line.status.reason});
  AddParameters(r, parameters, cells);
  return cells;
}

std::string CsvLine(const std::vector<std::string>& cells) {
  std::string text;
  for (const std::string& cell : cells) {
    std::string plain = cell;
    std::replace(plain.begin(), plain.end(), '\n', ' ');
    text += (text.empty() ? "" : ",") + CsvCell(plain);
  }
  return text + "\n";
}

nlohmann::json ParametersJson(const RowResult& r) {
  auto json = nlohmann::json::array();
  for (const RowParameter& p : r.parameters)
    json.push_back({{"name", p.name},
                    {"unit", p.unit},
                    {"value", p.value},
                    {"ci95", {p.low, p.high}},
                    {"at_bound", p.at_bound}});
  return json;
}

nlohmann::json LineJson(const StudyLine& line) {
  const RowResult& r = line.result;
  nlohmann::json json{{"row", line.row->number},
                      {"name", line.row->name},
                      {"status", StateName(line.status.state)},
                      {"reason", line.status.reason},
                      {"command", line.row->command},
                      {"options", line.row->options},
                      {"experiment", line.row->experiment},
                      {"labels", line.row->labels}};
  json["input"] = line.status.inputs ? nlohmann::json(line.status.inputs->Hash()) : nullptr;
  if (line.status.record) {
    json["seconds"] = line.status.record->seconds;
    json["peak_megabytes"] = line.status.record->peak_megabytes;
    json["host"] = line.status.record->host;
  }
  if (line.status.state != State::kDone) return json;
  json["verdict"] = r.verdict;
  json["certainty"] = r.certainty;
  json["causes"] = r.effects;
  json["cause"] = r.cause;
  json["gain"] = {{"validate_error_removed", r.gain}, {"ci95", {r.gain_low, r.gain_high}}};
  json["error"] = {{"unit", r.unit},
                   {"train", r.train},
                   {"validate", r.validate},
                   {"validate_after", r.validate_after}};
  json["parameters"] = ParametersJson(r);
  return json;
}

nlohmann::json PopulationJson(const StudySummary& summary, const Population& p) {
  nlohmann::json json{{"model", p.model},
                      {"parameter", p.name},
                      {"unit", p.unit},
                      {"mean", p.spread.mean},
                      {"mean_ci95", {p.spread.mean_low, p.spread.mean_high}},
                      {"between_units", p.spread.between},
                      {"between_units_ci95", {p.spread.between_low, p.spread.between_high}},
                      {"p_one_value", p.spread.p},
                      {"odd", OddUnits(p, summary.lines)}};
  json["units"] = nlohmann::json::array();
  for (const PopulationUnit& u : p.units)
    json["units"].push_back({{"row", summary.lines[u.line].row->name},
                             {"value", u.parameter.value},
                             {"ci95", {u.parameter.low, u.parameter.high}},
                             {"t", u.deviation.t},
                             {"p", u.deviation.p}});
  json["left_out"] = nlohmann::json::array();
  for (const std::size_t line : p.left_out)
    json["left_out"].push_back(summary.lines[line].row->name);
  return json;
}

}  // namespace

std::size_t StudySummary::Count(State state) const {
  const auto is = [&](const StudyLine& line) { return line.status.state == state; };
  return static_cast<std::size_t>(std::count_if(lines.begin(), lines.end(), is));
}

std::string StudySummary::InWords() const {
  std::vector<State> states;
  for (const StudyLine& line : lines) states.push_back(line.status.state);
  return CountsInWords(states);
}

StudySummary Summarise(const StudyTable& study, std::vector<RowStatus> status,
                       const std::filesystem::path& out) {
  StudySummary summary{&study, {}, {}};
  for (std::size_t i = 0; i < study.rows.size(); ++i) {
    StudyLine line{&study.rows[i], std::move(status[i]), {}};
    try {
      if (line.status.state == State::kDone)
        line.result = ReadResult(out / line.row->name, line.row->command);
    } catch (const Error& e) {
      line.status.state = State::kFailed;
      line.status.reason = line.row->where + ": " + e.what();
    }
    summary.lines.push_back(std::move(line));
  }
  summary.populations = PopulationsOf(summary.lines);
  return summary;
}

std::string VerdictInWords(const RowResult& r) {
  return r.certainty.empty() ? r.verdict : r.verdict + " (" + r.certainty + ")";
}

std::string GainInWords(const RowResult& r) {
  if (!std::isfinite(r.gain)) return "";
  const std::string gain = Percent(r.gain);
  return std::isfinite(r.gain_low) ? gain + fmt::format(" [{}, {}]", Fixed(100 * r.gain_low, 0),
                                                        Fixed(100 * r.gain_high, 0))
                                   : gain;
}

std::string InWords(const RowResult& r) {
  std::string text = VerdictInWords(r);
  if (!r.cause.empty()) text += (text.empty() ? "" : ": ") + r.cause;
  if (std::isfinite(r.gain)) text += ", gain " + GainInWords(r);
  if (!std::isfinite(r.gain) && std::isfinite(r.train))
    text += fmt::format("{}error {:.4g} {}", text.empty() ? "" : ", ", r.train, r.unit);
  return text;
}

std::string SummaryCsv(const StudySummary& summary) {
  std::vector<std::string> header{"row", "name", "status", "command", "experiment"};
  for (const std::string& label : summary.study->labels) header.push_back(label);
  header.insert(header.end(), {"verdict", "certainty", "cause", "gain", "gain_low", "gain_high",
                               "error_unit", "error_train", "error_validate",
                               "error_validate_after", "seconds", "peak_megabytes", "reason"});
  const auto parameters = ParametersOf(summary);
  for (const std::string& name : parameters)
    header.insert(header.end(), {name, name + " low", name + " high"});
  std::string text = CsvLine(header);
  for (const StudyLine& line : summary.lines) text += CsvLine(CellsOf(summary, line, parameters));
  return text;
}

std::string SummaryJson(const StudySummary& summary) {
  nlohmann::json json{{"study", summary.study->name},
                      {"rows", nlohmann::json::array()},
                      {"populations", nlohmann::json::array()}};
  for (const auto& [key, state] : {std::pair{"done", State::kDone},
                                   {"failed", State::kFailed},
                                   {"changed", State::kChanged},
                                   {"missing", State::kMissing}})
    json["counts"][key] = summary.Count(state);
  for (const StudyLine& line : summary.lines) json["rows"].push_back(LineJson(line));
  for (const Population& p : summary.populations)
    json["populations"].push_back(PopulationJson(summary, p));
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

void WriteSummary(const StudySummary& summary, const std::filesystem::path& out) {
  MakeFolder(out);
  WriteFile(out / "study.csv", SummaryCsv(summary));
  WriteFile(out / "study.json", SummaryJson(summary));
  WriteStudyPage(summary, out / "study.html");
}

}  // namespace continuum
