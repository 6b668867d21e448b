#include "sim/replay/replay_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sim/experiment/registration.h"
#include "sim/io/csv.h"
#include "sim/io/decimal.h"
#include "sim/io/output_manifest.h"
#include "sim/io/rounded.h"
#include "sim/replay/sensor_score.h"
#include "sim/simulation/score.h"

namespace continuum {
namespace {

std::vector<double> InUnit(const std::vector<double>& si, double factor) {
  std::vector<double> out(si);
  for (double& v : out) v /= factor;
  return out;
}

std::string Cell(double value) { return std::isnan(value) ? "" : fmt::format("{:.9g}", value); }

void AddRegistration(Page& page, const Registration& r) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& line : RegistrationLines(r)) rows.push_back({line});
  if (rows.empty()) return;
  page.Heading("Registration");
  page.Table({"where and when the outputs were measured"}, rows);
}

}  // namespace

std::string ErrorText(const Experiment& e, const SplitError& error) {
  std::string text;
  const auto say = [&](bool train, const char* use, double value) {
    const auto used = [&](const Log& log) { return log.train == train; };
    if (std::none_of(e.logs.begin(), e.logs.end(), used)) return;
    const std::string unit = text.empty() ? " " + Pool(e).unit() + " RMS" : "";
    text += text.empty() ? "error " : ", ";
    text += std::isfinite(value) ? fmt::format("{:.4g}{} on {}", value, unit, use)
                                 : fmt::format("none on {}, where a log diverges", use);
  };
  say(true, "train", error.train);
  say(false, "validate", error.validate);
  return text;
}

nlohmann::json ScoreJson(const std::vector<ChannelScore>& score) {
  auto channels = nlohmann::json::array();
  for (const ChannelScore& s : score) {
    channels.push_back({{"channel", s.channel},
                        {"unit", s.unit},
                        {"rows", s.rows},
                        {"rmse", s.rmse},
                        {"mae", s.mae},
                        {"nrmse", s.nrmse},
                        {"fit_percent", s.fit},
                        {"largest", s.largest},
                        {"when", s.when}});
  }
  return channels;
}

nlohmann::json ErrorsJson(const Experiment& e, const std::vector<Replayed>& logs) {
  const SplitError error = PooledError(e, logs);
  nlohmann::json json{
      {"unit", Pool(e).unit()}, {"train", error.train}, {"validate", error.validate}};
  for (std::size_t l = 0; l < logs.size(); ++l) {
    const Log& log = e.logs[l];
    json["logs"].push_back({{"log", log.label},
                            {"trial", log.trial},
                            {"condition", log.condition},
                            {"use", log.train ? "train" : "validate"},
                            {"diverged", logs[l].trace.diverged},
                            {"channels", ScoreJson(logs[l].score)}});
  }
  json["sensors"] = ToJson(ScoreSensors(e, logs));
  return json;
}

void WriteSimulated(const Experiment& e, const std::vector<Trace>& traces,
                    const std::filesystem::path& folder) {
  OutputManifest files(folder);
  for (std::size_t l = 0; l < traces.size(); ++l) {
    const Log& log = e.logs[l];
    std::string text = "time";
    for (const auto& c : e.channels)
      text += "," + CsvCell(c.name) + "," + CsvCell(c.name + "_measured");
    text += "\n";
    for (std::size_t k = 0; k < log.rows(); ++k) {
      text += Decimal(log.time[k]);
      for (std::size_t c = 0; c < e.channels.size(); ++c) {
        const double factor = e.channels[c].factor;
        text +=
            "," + Cell(traces[l].channel[c][k] / factor) + "," + Cell(log.measured[c][k] / factor);
      }
      text += "\n";
    }
    files.Write(log.label + ".csv", text);
  }
  files.Finish();
}

void AddOverlay(Page& page, const Experiment& e, const Log& log,
                const std::vector<NamedTrace>& traces, bool residual, const std::string& only) {
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const auto& channel = e.channels[c];
    if (e.outputs[channel.output].weight == 0 || (!only.empty() && channel.name != only)) continue;
    TimeSeriesSpec spec{
        log.label + ": " + channel.name, {channel.name, channel.unit}, log.time, {}, log.label};
    spec.series.push_back({"measured", InUnit(log.measured[c], channel.factor), Style::kMeasured});
    for (const auto& t : traces) {
      spec.series.push_back({t.name, InUnit(t.trace->channel[c], channel.factor), t.style});
    }
    page.TimeSeries(spec);
    if (!residual) continue;
    TimeSeriesSpec rest{"", {"residual", channel.unit}, log.time, {}, log.label, 110};
    for (const auto& t : traces) {
      const auto r = Residuals(e, log, *t.trace);
      rest.series.push_back({t.name + " − measured", InUnit(r[c], channel.factor),
                             traces.size() == 1 ? Style::kResidual : t.style});
    }
    page.TimeSeries(rest);
  }
}

void WriteReplayReport(const Experiment& e, const std::vector<Replayed>& logs,
                       const std::filesystem::path& file) {
  Page page("Replay",
            e.model.filename().string() + " against " + std::to_string(logs.size()) + " logs");
  page.Badge(Tone::kInfo, ErrorText(e, PooledError(e, logs)),
             "root mean square over all samples, channels and logs; the model as it stands");
  page.Heading("Errors");
  std::vector<std::vector<std::string>> rows;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    for (const ChannelScore& s : logs[l].score) {
      rows.push_back({e.logs[l].label, e.logs[l].train ? "train" : "validate", s.channel, s.unit,
                      fmt::format("{:.4g}", s.rmse), fmt::format("{:.4g}", s.mae),
                      fmt::format("{:.3f}", s.nrmse), Fixed(s.fit, 1),
                      fmt::format("{:.4g}", s.largest), Fixed(s.when, 3)});
    }
  }
  page.Table(
      {"log", "use", "channel", "unit", "RMSE", "mean abs.", "NRMSE", "fit %", "largest", "at s"},
      rows);
  AddRegistration(page, e.registration);
  for (std::size_t l = 0; l < logs.size(); ++l) {
    page.Heading(e.logs[l].label);
    AddOverlay(page, e, e.logs[l], {{"simulated", Style::kSimulated, &logs[l].trace}}, true);
  }
  page.Write(file);
}

}  // namespace continuum
