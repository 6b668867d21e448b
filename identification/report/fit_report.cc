#include "identification/report/fit_report.h"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "identification/report/parts.h"
#include "identification/report/residual_plots.h"
#include "sim/io/rounded.h"
#include "sim/replay/replay_report.h"

namespace continuum {
namespace {

HeatMapSpec CorrelationMap(const std::vector<FreeParameter>& parameters, const Uncertainty& u) {
  HeatMapSpec spec{"Correlation of the parameters", {}, {}, {}};
  std::vector<Eigen::Index> shown;
  for (Eigen::Index i = 0; i < u.correlation.rows(); ++i) {
    if (!parameters[i].IsStart()) shown.push_back(i);
  }
  for (const Eigen::Index a : shown) {
    spec.rows.push_back(parameters[a].name);
    spec.values.emplace_back();
    for (const Eigen::Index b : shown) spec.values.back().push_back(u.correlation(a, b));
  }
  return spec;
}

class FitPage {
 public:
  FitPage(const Experiment& e, const IdentifyResult& result, std::vector<MissingPart>& missing)
      : e_(e),
        result_(result),
        missing_(missing),
        page_("Fit",
              e.model.filename().string() + " to " + std::to_string(e.logs.size()) + " logs") {}

  Page Make() {
    Part("error", [&] { AddVerdict(); });
    Part("noise", [&] { AddWarnings(); });
    page_.Heading("Parameters");
    Part("parameters", [&] { AddParameters(); });
    page_.Heading("Convergence");
    Part("convergence", [&] { AddConvergence(); });
    if (result_.starts) Part("starts", [&] { AddStarts(*result_.starts); });
    page_.Heading("Residuals");
    Part("residuals", [&] {
      RequireWhole(e_, result_.logs);
      AddResiduals(page_, e_, result_.channels, result_.logs);
    });
    page_.Heading("Errors");
    Part("error_table", [&] { AddErrors(); });
    if (result_.ahead) Part("ahead", [&] { AddAhead(*result_.ahead); });
    AddMissing(page_, "ahead", result_.missing);
    page_.Heading("Logs");
    Part("logs", [&] { AddLogs(); });
    return std::move(page_);
  }

 private:
  void Part(const std::string& name, const std::function<void()>& content) {
    AddPart(page_, name, missing_, content);
  }

  void AddVerdict() {
    RequireWhole(e_, result_.logs);
    const Fit& fit = result_.fit;
    page_.Badge(fit.converged ? Tone::kGood : Tone::kWarn,
                ErrorText(e_, PooledError(e_, result_.logs)),
                fmt::format("{} iterations, {} simulations, {:.1f} s; {}.", fit.iterations,
                            fit.evaluations, fit.seconds, fit.message) +
                    (fit.anew ? fmt::format(" The fit was {}.", kAnewInWords) : "") +
                    (result_.starts ? " " + result_.starts->InWords() + "." : ""));
  }

  // What else has to be known before the values are read.
  void AddWarnings() {
    const std::string beyond = OverNoiseInWords(result_);
    if (!beyond.empty())
      page_.Badge(Tone::kWarn, "Residuals exceed the measurement noise", beyond + ".");
    if (const std::string pieces = OverPiecesInWords(result_); !pieces.empty())
      page_.Badge(Tone::kWarn, "Nothing follows whole logs", pieces + ".");
    for (std::size_t l = 0; l < result_.divergence.size(); ++l) {
      if (!result_.divergence[l].empty())
        page_.Badge(Tone::kWarn, "Log " + e_.logs[l].label + " has no error",
                    "With the fitted parameters: " + result_.divergence[l] + ".");
    }
    for (const char* part : {"noise", "divergence", "for_step", "at_step", "fitted_model"})
      AddMissing(page_, part, result_.missing);
  }

  void AddParameters() {
    const Uncertainty& u = result_.uncertainty;
    AddParameterTable(page_, result_.parameters, result_.fit.x, u);
    for (const Confounding& t : result_.trade_offs) page_.Badge(Tone::kWarn, "Trade-off", t.text);
    AddMissing(page_, "trade_offs", result_.missing);
    if (!u.lacks.empty()) {
      const std::string all = u.known() ? "Intervals are " : "Intervals and correlations were ";
      page_.Badge(Tone::kWarn, all + u.lacks,
                  "Run it again, with `--from` this fit.json to go on from here.");
    }
    if (const std::string several = result_.SeveralMinima(); !several.empty())
      page_.Badge(Tone::kWarn, "Intervals are not to be trusted", several);
    if (u.known() && u.correlation.rows() > 1) page_.HeatMap(CorrelationMap(result_.parameters, u));
  }

  void AddConvergence() {
    ScatterSpec cost{"Cost", {"iteration", ""}, {"cost", ""}, {}, {}, true};
    Trend trend{"cost", {}, result_.fit.trace};
    for (std::size_t k = 0; k < trend.y.size(); ++k) trend.x.push_back(static_cast<double>(k));
    cost.trends.push_back(trend);
    page_.Scatter(cost);
  }

  // Where each start lies, of the parameters that were drawn, and where it ended.
  void AddStarts(const MultiStart& all) {
    std::vector<std::string> header{"start", "cost at its end", "over the best"};
    std::vector<Eigen::Index> drawn;
    for (Eigen::Index i = 0; i < all.best.x.size(); ++i) {
      const FreeParameter& p = result_.parameters[i];
      if (p.IsStart()) continue;
      drawn.push_back(i);
      header.push_back(p.name + (p.unit == "1" ? "" : " [" + p.unit + "]"));
    }
    std::vector<std::vector<std::string>> rows;
    for (const Start& start : all.starts) {
      const bool ended = std::isfinite(start.cost);
      const double over = start.cost / all.best.cost - 1;
      rows.push_back({rows.empty() ? "given" : fmt::format("random {}", rows.size()),
                      ended ? fmt::format("{:.6g}", start.cost) : "diverged",
                      ended ? Significant(100 * over, 2) + " %" : ""});
      for (const Eigen::Index i : drawn) rows.back().push_back(fmt::format("{:.4g}", start.x[i]));
    }
    page_.Heading("Starts");
    page_.Table(header, rows,
                {all.InWords() + "; starts that cannot come near it any more are given up."});
  }

  void AddErrors() {
    std::vector<std::vector<std::string>> rows;
    for (std::size_t l = 0; l < result_.logs.size(); ++l) {
      const Log& log = e_.logs[l];
      for (const ChannelScore& s : result_.logs[l].score) {
        rows.push_back({log.label, log.train ? "train" : "validate", s.channel, s.unit});
        if (result_.logs[l].trace.diverged) {
          rows.back().insert(rows.back().end(), {"diverges", "", "", ""});
          continue;
        }
        rows.back().insert(rows.back().end(),
                           {fmt::format("{:.4g}", s.rmse), fmt::format("{:.4g}", s.mae),
                            fmt::format("{:.3f}", s.nrmse), Fixed(s.fit, 1)});
      }
    }
    page_.Table({"log", "use", "channel", "unit", "RMSE", "mean abs.", "NRMSE", "fit %"}, rows);
  }

  // Beside the errors of free simulation.
  void AddAhead(const PredictionError& ahead) {
    for (const auto* errors : {&ahead.train, &ahead.validate})
      RequireCount("prediction errors", errors->size(), e_.channels.size());
    std::vector<std::vector<std::string>> rows;
    for (std::size_t c = 0; c < e_.channels.size(); ++c) {
      const auto& channel = e_.channels[c];
      const auto cell = [&](double error) {
        return std::isnan(error) ? "" : fmt::format("{:.4g}", error / channel.factor);
      };
      rows.push_back({channel.name, channel.unit, cell(ahead.train[c]), cell(ahead.validate[c])});
    }
    page_.Table({"channel", "unit", "RMSE on train", "on validate"}, rows,
                {fmt::format("{} rows ({:.3g} s) ahead, from states as measured; beside them stand "
                             "the errors of free simulation above.",
                             ahead.rows, ahead.seconds)});
  }

  void AddLogs() {
    RequireWhole(e_, result_.logs);
    for (std::size_t l = 0; l < result_.logs.size(); ++l)
      AddOverlay(page_, e_, e_.logs[l], {{"fitted", Style::kAfter, &result_.logs[l].trace}}, true);
  }

  const Experiment& e_;
  const IdentifyResult& result_;
  std::vector<MissingPart>& missing_;
  Page page_;
};

}  // namespace

void AddParameterTable(Page& page, const std::vector<FreeParameter>& parameters,
                       const Eigen::VectorXd& x, const Uncertainty& u) {
  RequireCount("parameters", parameters.size(), x.size());
  RequireCount("standard errors", u.standard_error.size(), x.size());
  std::vector<std::vector<std::string>> rows;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = parameters[i];
    if (p.IsStart()) continue;
    const std::string range =
        u.known() ? fmt::format("{:.5g} … {:.5g}", u.lower[i], u.upper[i]) : "not computed";
    const std::string& why = p.WhyNearerBound(x[i]);
    rows.push_back(
        {p.name, fmt::format("{:.5g}", x[i]), p.unit,
         u.known() ? fmt::format("{:.2g}", u.standard_error[i]) : "–",
         range + (u.at_bound[i] ? ", at its bound" + (why.empty() ? "" : ": " + why) : ""),
         u.step.size() ? fmt::format("{:.5g}", x[i] + u.step[i]) : "",
         fmt::format("{:.5g}", p.initial)});
  }
  std::string note = "Intervals allow for residuals that are correlated in time";
  if (u.step.size()) note += ", and reach over what a fine time step would give";
  if (!u.known()) note = "Standard errors, intervals and correlations are " + u.lacks;
  page.Table({"parameter", "value", "unit", "standard error", "95 % interval",
              u.step.size() ? "at a fine step" : "", "start"},
             rows, {note + "."});
}

std::string OverPiecesInWords(const IdentifyResult& result) {
  if (!result.fit.over_pieces) return "";
  const std::string left =
      result.of_pieces ? fmt::format("; there they leave {:.2g} times the measurement noise ({})",
                                     result.of_pieces->times, result.of_pieces->source)
                       : "";
  return "no parameters that were found follow whole logs, whose motion soon parts from any "
         "simulation (chaos, or states that are measured too coarsely): these follow eighths of "
         "the logs, each begun at the measured state" +
         left +
         "; the intervals are those of this fit; write such eighths as logs of their own "
         "(`window:`) "
         "with `start: estimate`, and each begins where the fit says";
}

std::string OverNoiseInWords(const IdentifyResult& result) {
  if (!result.over_noise || result.fit.over_pieces) return "";
  if (!result.over_noise->far)
    return fmt::format(
        "residuals are {:.2g} times the measurement noise ({}): where the model is not quite the "
        "machine, true values may lie outside of these intervals",
        result.over_noise->times, result.over_noise->source);
  return fmt::format(
      "residuals are {:.0f} times the measurement noise ({}): the model lacks something "
      "(`continuum diagnose` finds the cause) or a better fit is elsewhere (`--starts 8`); "
      "intervals "
      "allow for neither",
      result.over_noise->times, result.over_noise->source);
}

void WriteFitReport(const Experiment& e, const IdentifyResult& result,
                    const std::filesystem::path& file, std::vector<MissingPart>& missing) {
  FitPage(e, result, missing).Make().Write(file);
}

}  // namespace continuum
