#include "identification/report/fit_output.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "error.h"
#include "identification/fit/intervals.h"
#include "identification/fit/prediction_error.h"
#include "identification/problem/extended_model.h"
#include "identification/problem/start_checks.h"
#include "identification/report/fit_json.h"
#include "identification/report/fit_report.h"
#include "identification/report/residual_plots.h"
#include "identification/statistics/identifiability.h"
#include "identification/statistics/noise_model.h"
#include "sim/io/file.h"
#include "sim/io/json.h"
#include "sim/io/units.h"
#include "sim/replay/replay.h"

namespace continuum {
namespace {

HeatMapSpec CorrelationMap(const Problem& problem, const Uncertainty& u) {
  HeatMapSpec spec{"Correlation of the parameters", {}, {}, {}};
  std::vector<Eigen::Index> shown;
  for (Eigen::Index i = 0; i < u.correlation.rows(); ++i) {
    if (!problem.parameters()[i].IsStart()) shown.push_back(i);
  }
  for (const Eigen::Index a : shown) {
    spec.rows.push_back(problem.parameters()[a].name);
    spec.values.emplace_back();
    for (const Eigen::Index b : shown) spec.values.back().push_back(u.correlation(a, b));
  }
  return spec;
}

std::vector<Replayed> Predicted(const Problem& problem, const Problem::Vector& x) {
  const Experiment& e = problem.experiment();
  std::vector<Replayed> logs;
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    Trace trace = problem.Predict(x, l);
    auto score = ScoreLog(e, e.logs[l], trace);
    logs.push_back({std::move(trace), std::move(score)});
  }
  return logs;
}

// In the order in which they were tried; a start that diverges has no cost (null).
nlohmann::json StartsJson(const Problem& problem, const MultiStart& all) {
  auto json = nlohmann::json::array();
  for (const Start& start : all.starts) {
    json.push_back({{"cost", start.cost}, {"parameters", nlohmann::json::object()}});
    for (Eigen::Index i = 0; i < start.x.size(); ++i)
      json.back()["parameters"][problem.parameters()[i].name] = start.x[i];
  }
  return json;
}

// Where each start lies, of the parameters that were drawn, and where it ended.
void AddStarts(Page& page, const Problem& problem, const MultiStart& all) {
  std::vector<std::string> header{"start", "cost at its end", "over the best"};
  std::vector<Eigen::Index> drawn;
  for (Eigen::Index i = 0; i < all.best.x.size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    if (p.IsStart()) continue;
    drawn.push_back(i);
    header.push_back(p.name + (p.unit == "1" ? "" : " [" + p.unit + "]"));
  }
  std::vector<std::vector<std::string>> rows;
  for (const Start& start : all.starts) {
    const bool ended = std::isfinite(start.cost);
    rows.push_back({rows.empty() ? "given" : fmt::format("random {}", rows.size()),
                    ended ? fmt::format("{:.6g}", start.cost) : "diverged",
                    ended ? fmt::format("{:.2g} %", 100 * (start.cost / all.best.cost - 1)) : ""});
    for (const Eigen::Index i : drawn) rows.back().push_back(fmt::format("{:.4g}", start.x[i]));
  }
  page.Heading("Starts");
  page.Table(header, rows, {all.InWords() + "; those that cannot come near it any more give up."});
}

// What the model gives at its own step, where the fit was one of its differential equation.
std::vector<Replayed> Stepped(Problem problem, const Problem::Vector& x) {
  problem.Follow(Path::kStepped);
  return Predicted(problem, x);
}

nlohmann::json AtStep(const Problem& problem, const Problem::Vector& x,
                      const std::vector<Replayed>& logs) {
  auto parameters = nlohmann::json::object();
  for (Eigen::Index i = 0; i < x.size(); ++i) parameters[problem.parameters()[i].name] = x[i];
  return {{"timestep", problem.system().model().opt.timestep},
          {"parameters", parameters},
          {"error", ErrorsJson(problem.experiment(), logs)}};
}

constexpr std::size_t kAhead = 10;  // rows

nlohmann::json AheadJson(const Experiment& e, const PredictionError& ahead) {
  nlohmann::json json{{"rows", ahead.rows}, {"seconds", ahead.seconds}};
  for (const auto& [use, errors] :
       {std::pair{"train", &ahead.train}, {"validate", &ahead.validate}}) {
    for (std::size_t c = 0; c < errors->size(); ++c) {
      if (!std::isnan((*errors)[c]))
        json[use][e.channels[c].name] = (*errors)[c] / e.channels[c].factor;
    }
  }
  return json;
}

// Beside the errors of free simulation.
void AddAhead(Page& page, const Experiment& e, const PredictionError& ahead) {
  std::vector<std::vector<std::string>> rows;
  const auto shown = [&](double error, std::size_t c) {
    return std::isnan(error) ? "" : fmt::format("{:.4g}", error / e.channels[c].factor);
  };
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    rows.push_back({e.channels[c].name, e.channels[c].unit, shown(ahead.train[c], c),
                    shown(ahead.validate[c], c)});
  }
  page.Table({"channel", "unit", "RMSE on train", "on validate"}, rows,
             {fmt::format("{} rows ({:.3g} s) ahead, from states as measured; beside them stand "
                          "the errors of free simulation above.",
                          ahead.rows, ahead.seconds)});
}

void RequireWithin(const std::filesystem::path& fit, const Problem& problem,
                   const Problem::Vector& x) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    const double edge = 1e-9 * p.scale;
    if (p.lower - edge <= x[i] && x[i] <= p.upper + edge) continue;
    throw Error::Input(
        fit.string() + ": parameter '" + p.name + "'",
        fmt::format("a value within its bounds [{:g}, {:g}], {}", p.lower, p.upper, p.where),
        fmt::format("{:g}", x[i]));
  }
}

}  // namespace

Problem::Vector ValuesIn(const std::filesystem::path& fit, const Problem& problem) {
  const nlohmann::json json = ReadJson(fit);
  Problem::Vector x = problem.Start();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const std::string& name = problem.parameters()[i].name;
    bool found = false;
    try {
      for (const auto& p : json.at("parameters")) {
        if (p.at("name") == name) x[i] = p.at("value").get<double>(), found = true;
      }
    } catch (const nlohmann::json::exception& e) {
      throw Error::Input(fit.string(), "a fit.json", e.what());
    }
    if (!found) throw Error::Input(fit.string(), "a value of the parameter '" + name + "'", "none");
  }
  RequireWithin(fit, problem, x);
  return problem.Clamp(x);
}

namespace {

// Intervals are those of a model that is right, next to the best of its valleys.
std::string BeyondNoise(const Experiment& e, double error) {
  const Noise noise = NoiseOf(e);
  if (!(noise.rms > 0) || !(error > kFarOverNoise * noise.rms)) return "";
  return fmt::format(
      "what remains is {:.0f} times the measurement noise ({}): the model lacks something "
      "(`continuum diagnose` says what) or a better fit is elsewhere (`--starts 8`); intervals "
      "allow for neither",
      error / noise.rms, noise.source);
}

}  // namespace

Determined WriteFit(const Problem& problem, const Fit& fit, const std::filesystem::path& folder,
                    const FitRecord& record) {
  const Experiment& e = problem.experiment();
  MakeFolder(folder);
  const auto r = problem.Residuals(fit.x, problem.AllLogs());
  const Uncertainty u = record.regression ? record.regression->uncertainty
                                          : IntervalsOf(problem, fit.x, r, record.progress);
  const auto trade_offs = TradeOffsOf(problem, fit.x, u);
  const std::vector<Replayed> logs = Predicted(problem, fit.x);
  std::vector<Trace> traces;
  for (const Replayed& log : logs) traces.push_back(log.trace);
  const SplitError error = PooledError(e, logs);

  nlohmann::json json{{"parameters", ParametersJson(problem.parameters(), fit.x, u)},
                      {"correlation", nlohmann::json::array()},
                      {"error", ErrorsJson(e, logs)},
                      {"method", record.method},
                      {"path", problem.path() == Path::kSmooth ? "smooth" : "stepped"},
                      {"cost", fit.cost},
                      {"iterations", fit.iterations},
                      {"evaluations", fit.evaluations},
                      {"seconds", fit.seconds},
                      {"converged", fit.converged},
                      {"message", fit.message},
                      {"begun_anew", fit.anew},
                      {"trace", fit.trace},
                      {"fitted_model", "fitted.xml"},
                      {"fitted_experiment", "fitted.yaml"}};
  if (!u.lacks.empty()) json["intervals"] = u.lacks;
  for (Eigen::Index a = 0; a < u.correlation.rows(); ++a) {
    json["correlation"].emplace_back(
        std::vector<double>(u.correlation.row(a).begin(), u.correlation.row(a).end()));
  }
  json["trade_offs"] = nlohmann::json::array();
  for (const Confounding& t : trade_offs) json["trade_offs"].push_back(t.text);
  const Problem::Vector& x = record.for_step ? *record.for_step : fit.x;
  if (const Regression* const inverse = record.regression)
    json["force_error"] = {
        {"unit", "%"}, {"train", inverse->train}, {"validate", inverse->validate}};
  std::optional<SplitError> at_step;
  if (problem.path() == Path::kSmooth) {
    const auto stepped = Stepped(problem, x);
    json["at_step"] = AtStep(problem, x, stepped);
    at_step = PooledError(e, stepped);
  }
  const auto ahead = PredictAhead(problem, fit.x, kAhead);
  if (ahead) json["ahead"] = AheadJson(e, *ahead);
  if (record.starts) json["starts"] = StartsJson(problem, *record.starts);
  WriteFile(folder / "fit.json", json.dump(2) + "\n");
  const ExtendedModel fitted = Extend(problem, x, folder, "fitted.xml");
  WriteFile(folder / "fitted.xml", fitted.xml);
  WriteFile(folder / "fitted.yaml", fitted.yaml);
  WriteSimulated(e, traces, folder / "simulated");

  Page page("Fit", e.model.filename().string() + " to " + std::to_string(e.logs.size()) + " logs");
  page.Badge(fit.converged ? Tone::kGood : Tone::kWarn, ErrorInWords(e, error),
             fmt::format("{} iterations, {} simulations, {:.1f} s; {}.", fit.iterations,
                         fit.evaluations, fit.seconds, fit.message) +
                 (fit.anew ? fmt::format(" The fit was {}.", kAnewInWords) : "") +
                 (record.starts ? " " + record.starts->InWords() + "." : ""));
  const std::string beyond = BeyondNoise(e, TypicalRms(problem, r, problem.TrainLogs()));
  if (!beyond.empty()) page.Badge(Tone::kWarn, "More than noise is left", beyond + ".");
  for (std::size_t l = 0; l < logs.size(); ++l) {
    if (logs[l].trace.diverged)
      page.Badge(Tone::kWarn, "Log " + e.logs[l].label + " has no error",
                 "With the fitted parameters: " + WhyItDiverges(problem, fit.x, l) + ".");
  }
  page.Heading("Parameters");
  AddParameterTable(page, problem.parameters(), fit.x, u);
  for (const Confounding& t : trade_offs) page.Badge(Tone::kWarn, "Trade-off", t.text);
  if (!u.lacks.empty()) {
    const std::string all = u.known() ? "Intervals are " : "Intervals and correlations were ";
    page.Badge(Tone::kWarn, all + u.lacks,
               "Run it again, with `--from` this fit.json to go on from here.");
  }
  if (u.known() && u.correlation.rows() > 1) page.HeatMap(CorrelationMap(problem, u));
  page.Heading("Convergence");
  ScatterSpec cost{"Cost", {"iteration", ""}, {"cost", ""}, {}, {}, true};
  Trend trend{"cost", {}, fit.trace};
  for (std::size_t k = 0; k < fit.trace.size(); ++k) trend.x.push_back(static_cast<double>(k));
  cost.trends.push_back(trend);
  page.Scatter(cost);
  if (record.starts) AddStarts(page, problem, *record.starts);
  page.Heading("What remains");
  AddResiduals(page, e, problem.channels(), logs);
  page.Heading("Errors");
  std::vector<std::vector<std::string>> rows;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    for (const ChannelScore& s : logs[l].score) {
      rows.push_back({e.logs[l].label, e.logs[l].train ? "train" : "validate", s.channel, s.unit});
      if (logs[l].trace.diverged) {
        rows.back().insert(rows.back().end(), {"diverges", "", "", ""});
        continue;
      }
      rows.back().insert(rows.back().end(),
                         {fmt::format("{:.4g}", s.rmse), fmt::format("{:.4g}", s.mae),
                          fmt::format("{:.3f}", s.nrmse), fmt::format("{:.1f}", s.fit)});
    }
  }
  page.Table({"log", "use", "channel", "unit", "RMSE", "mean abs.", "NRMSE", "fit %"}, rows);
  if (ahead) AddAhead(page, e, *ahead);
  page.Heading("Logs");
  for (std::size_t l = 0; l < logs.size(); ++l) {
    AddOverlay(page, e, e.logs[l], {{"fitted", Style::kAfter, &traces[l]}}, true);
  }
  page.Write(folder / "report.html");
  return {u, trade_offs, at_step, beyond};
}

}  // namespace continuum
