#include "identification/study/row_result.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "error.h"
#include "sim/io/json.h"

namespace continuum {
namespace {

using nlohmann::json;

double Number(const json& value) {
  return value.is_number() ? value.get<double>() : RowResult::kNone;
}

// 0 where there are no such logs.
double Rms(const json& value) {
  const double error = Number(value);
  return error > 0 ? error : RowResult::kNone;
}

void ReadInterval(const json& ends, double& low, double& high) {
  low = high = RowResult::kNone;
  if (ends.is_array() && ends.size() == 2) low = Number(ends[0]), high = Number(ends[1]);
}

void ReadDiagnosis(const json& d, RowResult& r) {
  d.at("verdict").get_to(r.verdict);
  d.at("certainty").get_to(r.certainty);
  for (const json& cause : d.at("causes")) {
    r.effects.push_back(cause.at("effect"));
    r.cause += fmt::format("{}{} at {}", r.cause.empty() ? "" : "; ", r.effects.back(),
                           cause.at("where").get<std::string>());
  }
  if (const json& gain = d.at("gain"); gain.is_object()) {
    r.gain = Number(gain.at("validate_error_removed"));
    ReadInterval(gain.at("ci95"), r.gain_low, r.gain_high);
  }
  const json& error = d.at("error");
  error.at("unit").get_to(r.unit);
  r.train = Rms(error.at("before").at("train"));
  r.validate = Rms(error.at("before").at("validate"));
  r.validate_after = Rms(error.at("after").at("validate"));
}

void ReadErrors(const json& error, RowResult& r) {
  if (!error.is_object()) return;
  error.at("unit").get_to(r.unit);
  r.train = Rms(error.at("train"));
  r.validate = Rms(error.at("validate"));
}

void ReadFit(const json& fit, RowResult& r) {
  r.verdict = fit.at("converged").get<bool>() ? "converged" : "not converged";
  if (fit.contains("error")) ReadErrors(fit.at("error"), r);
  for (const json& p : fit.value("parameters", json::array())) {
    RowParameter read{p.at("name"), p.at("unit"), Number(p.at("value")), 0, 0, p.at("at_bound")};
    ReadInterval(p.at("ci95"), read.low, read.high);
    r.parameters.push_back(std::move(read));
  }
}

std::string Count(std::size_t number, const char* what) {
  return number == 0 ? "" : fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

void ReadFindings(const json& findings, RowResult& r) {
  for (const char* const severity : {"error", "warning"}) {
    const auto is = [&](const json& f) { return f.at("severity") == severity; };
    const auto number = std::count_if(findings.begin(), findings.end(), is);
    if (number == 0) continue;
    r.verdict +=
        (r.verdict.empty() ? "" : ", ") + Count(static_cast<std::size_t>(number), severity);
    const json& first = *std::find_if(findings.begin(), findings.end(), is);
    if (r.cause.empty())
      r.cause =
          fmt::format("{} {}: {}", first.at("log").get<std::string>(),
                      first.at("channel").get<std::string>(), first.at("text").get<std::string>());
  }
  if (r.verdict.empty()) r.verdict = "nothing odd";
}

}  // namespace

const char* ResultFile(const std::string& command) {
  if (command == "check") return kFindings;
  if (command == "replay") return "errors.json";
  return command == "identify" ? "fit.json" : "diagnosis.json";
}

RowResult ReadResult(const std::filesystem::path& folder, const std::string& command) {
  RowResult r;
  const json result = ReadJson(folder / ResultFile(command));
  try {
    if (command == "check") ReadFindings(result, r);
    if (command == "replay") ReadErrors(result, r);
    if (command == "identify") ReadFit(result, r);
    if (command == "diagnose") ReadDiagnosis(result, r);
  } catch (const json::exception& e) {
    throw Error::Input(folder.string(), "the result of " + command, e.what());
  }
  std::error_code failed;
  if (std::filesystem::exists(folder / "report.html", failed)) r.page = "report.html";
  if (command == "check") r.page = kFindings;
  return r;
}

}  // namespace continuum
