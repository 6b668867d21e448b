#include "identification/report/fit_json.h"

#include <cmath>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "identification/report/parts.h"
#include "sim/replay/replay_report.h"

namespace continuum {
namespace {

const char* NameOf(FitMethod method) {
  switch (method) {
    case FitMethod::kParticleSwarm:
      return "pso";
    case FitMethod::kInverseModel:
      return "regressor";
    default:
      return "lm";
  }
}

nlohmann::json ValuesJson(const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& x) {
  auto json = nlohmann::json::object();
  for (Eigen::Index i = 0; i < x.size(); ++i) json[parameters[i].name] = x[i];
  return json;
}

nlohmann::json CorrelationJson(const Eigen::MatrixXd& correlation) {
  auto json = nlohmann::json::array();
  for (Eigen::Index a = 0; a < correlation.rows(); ++a)
    json.emplace_back(std::vector<double>(correlation.row(a).begin(), correlation.row(a).end()));
  return json;
}

// In the order in which they were tried; a start that diverges has no cost (null).
nlohmann::json StartsJson(const std::vector<FreeParameter>& parameters, const MultiStart& all) {
  auto json = nlohmann::json::array();
  for (const Start& start : all.starts)
    json.push_back({{"cost", start.cost}, {"parameters", ValuesJson(parameters, start.x)}});
  return json;
}

nlohmann::json ModelStepJson(const Experiment& e, const IdentifyResult& result) {
  RequireWhole(e, result.at_step->logs);
  return {{"timestep", result.at_step->timestep},
          {"parameters", ValuesJson(result.parameters, result.at_step->x)},
          {"error", ErrorsJson(e, result.at_step->logs)}};
}

nlohmann::json AheadJson(const Experiment& e, const PredictionError& ahead) {
  nlohmann::json json{{"rows", ahead.rows}, {"seconds", ahead.seconds}};
  for (const auto& [use, errors] :
       {std::pair{"train", &ahead.train}, {"validate", &ahead.validate}}) {
    RequireCount("prediction errors", errors->size(), e.channels.size());
    for (std::size_t c = 0; c < errors->size(); ++c) {
      if (!std::isnan((*errors)[c]))
        json[use][e.channels[c].name] = (*errors)[c] / e.channels[c].factor;
    }
  }
  return json;
}

nlohmann::json EffortJson(const IdentifyResult& result) {
  const Fit& fit = result.fit;
  return {{"method", NameOf(result.method)},
          {"path", result.path == Path::kSmooth ? "smooth" : "stepped"},
          {"cost", fit.cost},
          {"iterations", fit.iterations},
          {"evaluations", fit.evaluations},
          {"seconds", fit.seconds},
          {"converged", fit.converged},
          {"message", fit.message},
          {"begun_anew", fit.anew},
          {"over_pieces", fit.over_pieces},
          {"trace", fit.trace}};
}

nlohmann::json MinimaJson(const IdentifyResult& result) {
  auto json = nlohmann::json::array();
  for (const LocalMinimum& other : result.minima.found) {
    json.push_back({{"cost", other.cost}});
    for (std::size_t i = 0; i < result.parameters.size(); ++i)
      json.back()[result.parameters[i].name] = other.x[static_cast<Eigen::Index>(i)];
  }
  return json;
}

}  // namespace

nlohmann::json FitJson(const Experiment& e, const IdentifyResult& result,
                       std::vector<MissingPart>& missing) {
  nlohmann::json json = EffortJson(result);
  const auto add = [&](const std::string& key, const auto& make) {
    MakePart(key, missing, [&] { json[key] = make(); });
  };
  const Uncertainty& u = result.uncertainty;
  add("parameters", [&] { return ParametersJson(result.parameters, result.fit.x, u); });
  add("correlation", [&] { return CorrelationJson(u.correlation); });
  add("error", [&] {
    RequireWhole(e, result.logs);
    return ErrorsJson(e, result.logs);
  });
  if (!result.fitted.xml.empty())
    json["fitted_model"] = "fitted.xml", json["fitted_experiment"] = "fitted.yaml";
  if (!u.lacks.empty()) json["intervals"] = u.lacks;
  json["several_minima"] = result.SeveralMinima();
  json["minima"] = MinimaJson(result);
  json["trade_offs"] = nlohmann::json::array();
  for (const Confounding& t : result.trade_offs) json["trade_offs"].push_back(t.text);
  if (result.regression)
    json["force_error"] = {{"unit", "%"},
                           {"train", result.regression->train},
                           {"validate", result.regression->validate}};
  if (result.at_step) add("at_step", [&] { return ModelStepJson(e, result); });
  if (result.ahead) add("ahead", [&] { return AheadJson(e, *result.ahead); });
  if (result.starts) add("starts", [&] { return StartsJson(result.parameters, *result.starts); });
  return json;
}

nlohmann::json ParametersJson(const std::vector<FreeParameter>& parameters,
                              const Eigen::VectorXd& x, const Uncertainty& u) {
  RequireCount("parameters", parameters.size(), x.size());
  RequireCount("standard errors", u.standard_error.size(), x.size());
  auto all = nlohmann::json::array();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = parameters[i];
    const double edge = 1e-9 * p.scale;
    all.push_back({{"name", p.name},
                   {"unit", p.unit},
                   {"value", x[i]},
                   {"standard_error", u.standard_error[i]},
                   {"ci95", {u.lower[i], u.upper[i]}},
                   {"lower", p.lower},
                   {"upper", p.upper},
                   {"start", p.initial},
                   {"at_bound", static_cast<bool>(u.at_bound[i])},
                   {"start_at_bound", p.initial <= p.lower + edge || p.initial >= p.upper - edge}});
    for (const std::string& why : {p.why_lower, p.why_upper})
      if (!why.empty()) all.back()["bound_moved"].push_back(why);
    if (u.step.size()) all.back()["fine_step"] = x[i] + u.step[i];
  }
  return all;
}

}  // namespace continuum
