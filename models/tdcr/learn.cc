#include "models/tdcr/learn.h"

#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "error.h"
#include "models/statics/results.h"
#include "models/tdcr/calibrate.h"
#include "models/tdcr/document.h"
#include "models/tdcr/explained.h"
#include "models/tdcr/hybrid.h"
#include "models/tdcr/inputs.h"

namespace continuum::tdcr {
namespace {

// Nothing: to be chosen by cross-validation.
std::optional<double> Penalty(const SolveRequest& request) {
  if (request.cross_validate) return std::nullopt;
  return request.lambda.value_or(0);
}

void CheckLearning(const SolveRequest& request, const std::string& job) {
  Need(request.input, "--input", job);
  Need(request.measured, "--measured", job);
  Refuse(!request.plot.empty(), "--plot", job);
  statics::RequireExtension(request.out, {".yaml", ".yml"}, "--out");
}

std::vector<Pair> ReadPairs(const SolveRequest& request, const std::vector<Case>& cases,
                            const std::vector<Measured>& measured) {
  RefuseLengths(request, cases, "calibration and training");
  for (const Case& c : cases) {
    if (c.reference < 0) continue;
    throw Error::Input(request.input.string() + ", column 'reference'",
                       "empty cells in calibration and training", "case '" + c.name + "'");
  }
  return Match(cases, measured, request.measured.string());
}

void AddExplained(const Explained& explained, bool poor, YAML::Node& node) {
  node["status"] = poor ? "poor" : "ok";
  node["rmse"] = Number(explained.rmse());
  node["deflection"] = Number(explained.deflection());
  node["scatter"] = Number(explained.scatter());
}

// The exit code of a calibration or training.
int Judge(const SolveRequest& request, bool poor, const std::string& job,
          const std::string& sentence) {
  if (!poor) return 0;
  request.warn(request.measured.string() + ": the " + job + " is poor: " + sentence);
  return 1;
}

// R.yaml with the values found.
YAML::Node CalibrationDocument(const SolveRequest& request, const Yaml& file,
                               const Calibration& c) {
  const std::string method = request.method.empty() ? "eas" : request.method;
  const bool friction = c.standard.size() > 4;
  const YAML::Node base = List(c.robot.base_rotation);
  YAML::Node standard;
  standard["E"] = Number(c.standard[0]);
  if (friction) standard["mu"] = Number(c.standard[4]);
  standard["base_rotation"] = List(Eigen::VectorXd(c.standard.segment<3>(1)));

  YAML::Node document = YAML::Clone(file.node());
  const auto set = [&](const char* key, const YAML::Node& value) {
    SetParameter(document, key, value, YAML::Clone(standard[key]),
                 fmt::format("calibrated by {} on {} cases of {}", method, c.cases,
                             request.measured.filename().string()));
  };
  set("E", Number(c.robot.E));
  if (friction) set("mu", Number(c.robot.mu));
  set("base_rotation", base);

  YAML::Node node;
  node["method"] = method;
  node["cases"] = c.cases;
  node["E"] = Number(c.robot.E);
  if (friction) node["mu"] = Number(c.robot.mu);
  node["base_rotation"] = YAML::Clone(base);
  node["standard_error"] = standard;
  node["at_bound"] = List(c.at_bound);
  AddExplained(c.explained, c.explained.poor(), node);
  node["tip_error_percent"] = Document(c.tips);
  document["calibration"] = node;
  return document;
}

}  // namespace

int CalibrateRobot(const SolveRequest& request, const Yaml& file, const Robot& robot,
                   Method method) {
  CheckLearning(request, "--calibrate");
  const auto cases = ReadInput(request, robot);
  const auto measured = ReadMeasurements(request, robot);
  const Calibration c =
      Calibrate(robot, method, ReadPairs(request, cases, measured), request.measured.string());
  WriteDocument(request.out, CalibrationDocument(request, file, c));
  return Judge(request, c.explained.poor(), "calibration", c.explained.Sentence());
}

int TrainHybrid(const SolveRequest& request, const Yaml& file, const Robot& robot) {
  CheckLearning(request, "--hybrid train");
  const auto cases = ReadInput(request, robot);
  const auto measured = ReadMeasurements(request, robot);
  const Hybrid h = Train(robot, ReadPairs(request, cases, measured), request.measured.string(),
                         Penalty(request));

  YAML::Node node;
  node["features"] = List(h.features);
  YAML::Node weights(YAML::NodeType::Sequence);
  for (Eigen::Index i = 0; i < h.weights.rows(); ++i) {
    weights.push_back(List(Eigen::VectorXd(h.weights.row(i).transpose())));
  }
  node["weights"] = weights;
  node["penalty"] = Number(h.penalty);
  AddExplained(h.explained, h.poor(), node);
  if (h.left_out) node["rmse_left_out"] = Number(h.left_out->explained.rmse());
  node["tip_error_percent"] = Document(h.tips);
  if (const auto spread = h.left_out ? Statistics(h.left_out->tips) : std::nullopt) {
    node["tip_error_percent"]["five_fold"] = Document(*spread);
  }
  YAML::Node document = YAML::Clone(file.node());
  document["hybrid"] = node;
  WriteDocument(request.out, document);
  return Judge(request, h.poor(), "training", h.Sentence());
}

}  // namespace continuum::tdcr
