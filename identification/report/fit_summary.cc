#include "identification/report/fit_summary.h"

#include <cmath>
#include <functional>
#include <vector>

#include <fmt/format.h>

#include "identification/report/fit_report.h"
#include "identification/report/parts.h"
#include "sim/replay/replay_report.h"

namespace continuum {
namespace {

std::string NearerBound(const FreeParameter& p, double value) {
  return value - p.lower < p.upper - value ? "its lower bound" : "its upper bound";
}

// Where the time step moves it by more than its uncertainty: what the machine has.
std::string AtFineStep(double value, const Uncertainty& u, Eigen::Index i) {
  constexpr double kShows = 0.01;  // of the value
  if (u.step.size() == 0) return "";
  const double moved = std::abs(u.step[i]);
  if (!(moved > u.standard_error[i] && moved > kShows * std::abs(value))) return "";
  return fmt::format("; {:.4g} at a fine time step", value + u.step[i]);
}

std::string ParameterLine(const FreeParameter& p, double value, const Uncertainty& u,
                          Eigen::Index i) {
  std::string range = u.known() ? fmt::format("95 %: {:.5g} … {:.5g}", u.lower[i], u.upper[i])
                                : "interval not computed";
  range += AtFineStep(value, u, i);
  if (u.at_bound[i]) range = "at " + NearerBound(p, value) + "; " + range;
  if (p.initial <= p.lower || p.initial >= p.upper)
    range += "; it starts at " + NearerBound(p, p.initial);
  const std::string& why = p.WhyNearerBound(value);
  if (u.at_bound[i] && !why.empty()) range += "; " + why;
  const std::string unit = p.unit == "1" ? "" : " " + p.unit;
  return fmt::format("{:<24} {:.6g}{} ({})\n", p.name, value, unit, range);
}

// Where trials begin is found by itself; what stops at a bound is worth a line.
std::string ParameterLines(const IdentifyResult& result) {
  RequireCount("standard errors", result.uncertainty.standard_error.size(), result.fit.x.size());
  std::string lines, starts;
  for (Eigen::Index i = 0; i < result.fit.x.size(); ++i) {
    const FreeParameter& p = result.parameters[i];
    const double value = result.fit.x[i];
    if (!p.IsStart()) {
      lines += ParameterLine(p, value, result.uncertainty, i);
    } else if (result.uncertainty.at_bound[i]) {
      starts += fmt::format("{} = {:.4g} {} is at {}: does the log begin elsewhere?\n", p.name,
                            value, p.unit, NearerBound(p, value));
    }
  }
  return lines + starts;
}

std::string DivergenceLines(const Experiment& e, const IdentifyResult& result) {
  std::string lines;
  for (std::size_t l = 0; l < result.divergence.size(); ++l) {
    if (!result.divergence[l].empty())
      lines += fmt::format("log '{}' ({}) has no error, with the fitted parameters: {}\n",
                           e.logs[l].label, e.logs[l].file.string(), result.divergence[l]);
  }
  return lines;
}

std::string RegressionLines(const Regression& found) {
  std::string lines =
      fmt::format("forces by the inverse model: error {:.3g} % (train)", found.train);
  if (found.validate > 0) lines += fmt::format(" {:.3g} % (validate)", found.validate);
  return lines + "\n" + found.how + "\n";
}

std::string ErrorLines(const Experiment& e, const IdentifyResult& result) {
  RequireWhole(e, result.logs);
  std::vector<ChannelScore> scores;
  for (const Replayed& log : result.logs)
    scores.insert(scores.end(), log.score.begin(), log.score.end());
  std::string lines =
      ErrorText(e, PooledError(e, result.logs)) + MeanAbsoluteErrorText(scores) + "\n";
  if (result.at_step)
    lines += "as the model steps: " + ErrorText(e, PooledError(e, result.at_step->logs)) + "\n";
  if (result.regression) lines += RegressionLines(*result.regression);
  return lines;
}

std::string EffortLines(const IdentifyResult& result, const std::string& folder) {
  std::string lines;
  if (result.segments)
    lines += fmt::format("in segments first: cost of the whole logs {:.4g} -> {:.4g}\n",
                         result.segments->before, result.segments->after);
  if (result.fit.anew) lines += std::string(kAnewInWords) + "\n";
  if (result.starts) lines += result.starts->InWords() + "\n";
  return lines + fmt::format("{} iterations, {} simulations, {:.1f} s; report: {}/report.html\n",
                             result.fit.iterations, result.fit.evaluations, result.fit.seconds,
                             folder);
}

}  // namespace

std::string FitSummary(const Experiment& e, const IdentifyResult& result,
                       const std::string& folder) {
  std::string text;
  const auto add = [&](const std::string& name, const std::function<std::string()>& make) {
    std::vector<MissingPart> missing;
    MakePart(name, missing, [&] { text += make(); });
    text += MissingInWords(missing);
  };
  add("parameters", [&] { return ParameterLines(result); });
  text += DivergenceLines(e, result);
  add("error", [&] { return ErrorLines(e, result); });
  text += EffortLines(result, folder);
  for (const Confounding& t : result.trade_offs) text += t.text + "\n";
  if (const std::string several = result.SeveralMinima(); !several.empty()) text += several + "\n";
  for (const std::string& line : {OverPiecesInWords(result), OverNoiseInWords(result)})
    if (!line.empty()) text += line + "\n";
  if (!result.start_hint.empty()) text += result.start_hint + "\n";
  return text;
}

}  // namespace continuum
