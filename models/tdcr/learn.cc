#include "models/tdcr/learn.h"

#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "error.h"
#include "models/statics/results.h"
#include "models/tdcr/calibrate.h"
#include "models/tdcr/calibration_document.h"
#include "models/tdcr/document.h"
#include "models/tdcr/explained.h"
#include "models/tdcr/hybrid.h"
#include "models/tdcr/inputs.h"

namespace continuum::tdcr {
namespace {

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

// The exit code of a calibration or training.
int Judge(const SolveRequest& request, bool poor, const std::string& job,
          const std::string& sentence) {
  if (!poor) return 0;
  request.warn(request.measured.string() + ": the " + job + " is poor: " + sentence);
  return 1;
}

// What is to be found: --parameters, or the usual ones.
std::vector<Unknown> UnknownsOf(const SolveRequest& request, const Robot& robot, Method method) {
  const auto& given = request.parameters;
  return ParseUnknowns(given.empty() ? DefaultParameters(robot, method) : given, robot, method,
                       "--parameters");
}

}  // namespace

int CalibrateRobot(const SolveRequest& request, const Yaml& file, const Robot& robot,
                   Method method) {
  CheckLearning(request, "--calibrate");
  const auto cases = ReadInput(request, robot);
  const auto measured = ReadMeasurements(request, robot);
  const Calibration c = Calibrate(robot, method, UnknownsOf(request, robot, method),
                                  ReadPairs(request, cases, measured), request.measured.string());
  const std::string name = MethodName(request, robot);
  const std::string source = fmt::format("calibrated by {} on {} cases of {}", name, c.cases,
                                         request.measured.filename().string());
  WriteDocument(request.out, CalibrationDocument(file, robot, name, c, source));
  return Judge(request, c.explained.poor(), "calibration", c.explained.Sentence());
}

int TrainHybrid(const SolveRequest& request, const Yaml& file, const Robot& robot, Method method) {
  CheckLearning(request, "--hybrid train");
  const auto cases = ReadInput(request, robot);
  const auto measured = ReadMeasurements(request, robot);
  const Hybrid h = Train(robot, method, ReadPairs(request, cases, measured),
                         request.measured.string(), request.lambda);

  YAML::Node node;
  node["method"] = NameOf(method);
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
