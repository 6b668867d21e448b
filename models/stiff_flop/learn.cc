#include "models/stiff_flop/learn.h"

#include <fmt/format.h>

#include "error.h"
#include "models/statics/results.h"
#include "models/statics/yaml_document.h"
#include "models/stiff_flop/calibrate.h"
#include "sim/io/yaml.h"

namespace continuum::stiff_flop {
namespace {

using statics::List;
using statics::Number;

YAML::Node DocumentOf(const SolveRequest& request, const Robot& nominal, const std::string& method,
                      const Calibration& c) {
  YAML::Node document = YAML::Clone(Yaml::Read(request.robot).node());
  YAML::Node node, standard, shapes, model;
  node["method"] = method;
  node["cases"] = c.cases;
  for (std::size_t k = 0; k < c.names.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const std::string& name = c.names[k];
    const auto modules = ModulesOf(nominal, name);
    const double unit = IsGamma(name) ? 1 : nominal.series[modules.front()].E;
    const YAML::Node value = Number(unit * c.x[i]);
    node[name] = value;
    standard[name] = Number(unit * c.spread.standard[i]);
    shapes[name] = List(Eigen::VectorXd(unit * c.spread.shapes.row(i).transpose()));
    model[name] = List(Eigen::VectorXd(unit * c.spread.model.row(i).transpose()));
    for (const std::size_t at : modules) {
      YAML::Node module = document["modules"][nominal.names[at]];
      const double own = IsGamma(name) ? 1 : nominal.series[at].E;
      statics::SetParameter(module, IsGamma(name) ? "gamma" : "E", Number(own * c.x[i]),
                            Number(own * c.spread.standard[i]),
                            fmt::format("calibrated by {} on {} cases of {}", method, c.cases,
                                        request.measured.filename().string()));
    }
  }
  node["standard_error"] = standard;
  node["interval_of_shapes"] = shapes;
  node["interval_with_model_error"] = model;
  node["at_bound"] = List(c.at_bound);
  node["status"] = c.poor() ? "poor" : "ok";
  node["rmse"] = Number(c.rmse);
  node["scatter"] = Number(c.scatter);
  node["prediction"]["level"] = Number(c.level);
  node["prediction"]["cases"] = c.cases;
  node["prediction"]["within"] = List(Eigen::VectorXd(Eigen::VectorXd::Constant(1, c.within)));
  document["calibration"] = node;
  return document;
}

}  // namespace

int CalibrateRobot(const SolveRequest& request, const Robot& robot, const Method& method,
                   const Cases& cases) {
  statics::RequireExtension(request.out, {".yaml", ".yml"}, "--out");
  if (cases.direction != Direction::kForward) {
    throw Error::Input("--calibrate", "cases with p1, p2, p3", "kappa");
  }
  if (request.measured.empty())
    throw Error::Input("--measured", "a file for --calibrate", "nothing");
  const std::vector<std::string> names =
      request.parameters.empty() ? std::vector<std::string>{"E", "gamma"} : request.parameters;
  const auto measured = statics::ReadMeasuredPoints(CsvTable::Read(request.measured),
                                                    static_cast<int>(robot.series.size()));
  const Calibration c =
      Calibrate(robot, method, names, cases.rows, measured, request.measured.string());
  statics::WriteDocument(request.out,
                         DocumentOf(request, robot, method.Name(Direction::kForward), c));
  if (!c.poor()) return 0;
  request.warn(fmt::format(
      "{}: the calibration is poor: {:.3g} mm of the measured ends are not explained; they scatter "
      "by {:.3g} mm",
      request.measured.string(), 1e3 * c.rmse, 1e3 * c.scatter));
  return 1;
}

}  // namespace continuum::stiff_flop
