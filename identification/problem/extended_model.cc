#include "identification/problem/extended_model.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

#include "sim/experiment/measurement_model.h"
#include "sim/experiment/registration.h"
#include "sim/io/decimal.h"
#include "sim/model/asset_folders.h"

namespace continuum {
namespace {

std::string Quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string SettingsYaml(const Problem& problem, const Problem::Vector& x, std::size_t log) {
  // What a log alone puts on top of the model is written by itself, not in what lies beneath.
  std::vector<Change> beneath, on_top;
  const auto common = problem.CommonChanges(x);
  for (const Change& c : problem.ChangesFor(x, log)) {
    const bool own = std::find(common.begin(), common.end(), c) == common.end();
    (own && LiesOnTop(c) ? on_top : beneath).push_back(c);
  }
  std::map<std::string, std::map<std::string, double>> settings;
  const Experiment measured = problem.MeasuredBy(x, log);
  const auto read = [&](const Change& c) {
    if (IsMeasurement(c.target, c.attribute)) {
      settings[c.target][c.attribute] = MeasurementValue(measured, c.target, c.attribute);
      return;
    }
    settings[c.target][c.attribute] =
        problem.system().ValueAfter(LiesOnTop(c) ? on_top : beneath, c.target, c.attribute);
  };
  for (const Change& c : problem.experiment().logs[log].set) read(c);
  for (const FreeParameter& p : problem.parameters()) {
    const bool common = std::find(p.log.begin(), p.log.end(), false) == p.log.end();
    if (!common && p.log[log] && !p.IsStart()) read(p.change);
  }
  if (settings.empty()) return "";
  std::string text = ",\n     set: {";
  for (const auto& [target, attributes] : settings) {
    if (text.back() != '{') text += ", ";
    text += Quoted(target) + ": {";
    for (const auto& [attribute, value] : attributes) {
      if (text.back() != '{') text += ", ";
      text += Quoted(attribute) + ": " + Decimal(value);
    }
    text += "}";
  }
  return text + "}";
}

// Where the trial begins, where that is known or was fitted.
std::string StartYaml(const Problem& problem, const Problem::Vector& x, std::size_t log) {
  auto start = problem.experiment().logs[log].start;
  for (std::size_t i = 0; i < problem.parameters().size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    if (!p.IsStart() || !p.log[log]) continue;
    start[p.change.target.substr(6)][p.change.attribute == "speed"] =
        x[static_cast<Eigen::Index>(i)];
  }
  std::string text;
  for (const auto& [joint, state] : start) {
    text += fmt::format("{}{}: [{}, {}]", text.empty() ? "" : ", ", Quoted(joint),
                        Decimal(state[0]), Decimal(state[1]));
  }
  return text.empty() ? "" : ",\n     start: {" + text + "}";
}

std::string MeasurementYaml(const Measurement& m) {
  std::string text;
  const Measurement none;
  if (m.bias != none.bias) text += ", bias: " + Decimal(m.bias);
  if (m.scale != none.scale) text += ", scale: " + Decimal(m.scale);
  if (m.delay != none.delay) text += ", delay: " + Decimal(m.delay);
  if (m.rate != none.rate) text += ", rate: " + Decimal(m.rate);
  if (m.angle != none.angle) {
    text += fmt::format(", angle: {}, axis: [{}, {}, {}]", Decimal(m.angle), Decimal(m.axis[0]),
                        Decimal(m.axis[1]), Decimal(m.axis[2]));
  }
  if (m.cosine != none.cosine || m.sine != none.sine) {
    text += fmt::format(", cosine: {}, sine: {}, harmonic: {}", Decimal(m.cosine), Decimal(m.sine),
                        Decimal(m.harmonic));
  }
  return text;
}

std::string OutputYaml(const Output& out) {
  std::string text = "  - {";
  if (out.quaternion()) {
    text += "column: [";
    for (const auto& c : out.columns) text += (text.back() == '[' ? "" : ", ") + Quoted(c);
    text += "]";
  } else {
    text += "column: " + Quoted(out.columns.front());
  }
  text += ", unit: " + Quoted(out.unit);
  if (out.kind == Output::Kind::kSensor) {
    text += ", sensor: " + Quoted(out.source);
  } else {
    text += ", actuator: " + Quoted(out.source) +
            ", quantity: " + (out.kind == Output::Kind::kForce ? "force" : "control");
  }
  if (out.sigma > 0) text += ", sigma: " + Decimal(out.sigma);
  if (out.weight != 1) text += ", weight: " + Decimal(out.weight);
  if (out.unwrap) text += ", unwrap: true";
  return text + MeasurementYaml(out.measurement) + "}\n";
}

std::string ParameterYaml(const Problem& problem, const FreeParameter& p, double value,
                          std::set<std::string>& names) {
  std::string name = p.name;  // an effect's parameter may be called as one of the experiment's
  while (!names.insert(name).second) name += "_effect";
  const bool absolute = p.change.operation == Change::Operation::kSet;
  const bool on_top = LiesOnTop(p.change);
  // The model has the rest already.
  const double null = on_top ? problem.system().Value(p.change.target, p.change.attribute)
                      : p.change.operation == Change::Operation::kScale ? 1
                                                                        : 0;
  // Nor does a limit change anything that is set once more; without one there is no number.
  const double start = (absolute && !on_top) || !std::isfinite(null) ? value : null;
  const char* const operation[] = {"set", "scale", "add"};
  return fmt::format(
      "  - {{name: {}, target: {}, attribute: {}, operation: {}, initial: {}, lower: {}, upper: "
      "{}}}\n",
      Quoted(name), Quoted(p.change.target), Quoted(p.change.attribute),
      operation[static_cast<int>(p.change.operation)], Decimal(start),
      Decimal(std::min(p.lower, start)), Decimal(std::max(p.upper, start)));
}

std::string LogYaml(const Problem& problem, const Problem::Vector& x,
                    const std::filesystem::path& folder, std::size_t l) {
  const Log& log = problem.experiment().logs[l];
  std::string y = fmt::format("  - {{file: {}", Quoted(RelativePath(log.file, folder).string()));
  if (!log.variable.empty()) y += ", variable: " + Quoted(log.variable);
  y += fmt::format(", trial: {}, use: {}", Quoted(log.trial), log.train ? "train" : "validate");
  if (!log.window.empty())
    y += fmt::format(", window: [{}, {}]", Decimal(log.window[0]), Decimal(log.window[1]));
  if (!log.condition.empty()) y += ", condition: " + Quoted(log.condition);
  return y + SettingsYaml(problem, x, l) + StartYaml(problem, x, l) + "}\n";
}

std::string InputsYaml(const Experiment& e) {
  if (e.inputs.empty()) return "";
  std::string y = "inputs:\n";
  for (const Input& in : e.inputs) {
    y += "  - {actuator: " + Quoted(in.actuator) + ", unit: " + Quoted(in.unit);
    if (!in.column.empty()) y += ", column: " + Quoted(in.column);
    if (!in.enable.empty()) y += ", enable: " + Quoted(in.enable);
    if (in.unwrap) y += ", unwrap: true";
    if (in.linear || in.gaps) y += in.linear ? ", interpolate: linear" : ", interpolate: hold";
    y += "}\n";
  }
  return y;
}

std::string ParametersYaml(const Problem& problem, const Problem::Vector& x) {
  std::string parameters;
  std::set<std::string> names;
  for (std::size_t i = 0; i < problem.parameters().size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    const bool common = std::find(p.log.begin(), p.log.end(), false) == p.log.end();
    if (common && !p.change.target.empty() && !p.IsStart())
      parameters += ParameterYaml(problem, p, x[static_cast<Eigen::Index>(i)], names);
  }
  return parameters.empty() ? "" : "parameters:\n" + parameters;
}

std::string FoldsYaml(const Experiment& e) {
  const char* const folds[] = {"trial", "condition", "window"};
  std::string y = "folds: [";
  for (const auto f : e.folds)
    y += std::string(y.back() == '[' ? "" : ", ") + folds[static_cast<int>(f)];
  return y + "]\n";
}

}  // namespace

ExtendedModel Extend(const Problem& problem, const ModelSpec& whole, const Problem::Vector& x,
                     const std::filesystem::path& folder, const std::string& model) {
  const Experiment& e = problem.experiment();
  const Experiment measured = problem.MeasuredBy(x, 0);
  std::string y = "format: 1\nmodel: " + model + "\nlogs:\n";
  for (std::size_t l = 0; l < e.logs.size(); ++l) y += LogYaml(problem, x, folder, l);
  y += fmt::format("time: {{column: {}, unit: {}, skew: {}}}\n", Quoted(e.time_column),
                   Quoted(e.time_unit), Decimal(measured.skew));
  const char* const starts[] = {"rest", "equilibrium", "measured", "estimate"};
  y += fmt::format("start: {}\n", starts[static_cast<int>(e.start)]);
  if (e.quasi_static) y += "quasi_static: true\n";
  y += RegistrationYaml(measured.registration) + InputsYaml(e) + "outputs:\n";
  for (const Output& out : measured.outputs) y += OutputYaml(out);
  y += ParametersYaml(problem, x) + FoldsYaml(e);
  if (e.soft > 0) y += "loss: {soft_l1: " + Decimal(e.soft) + "}\n";
  return {whole.Xml(problem.CommonChanges(x), {}, folder), y};
}

}  // namespace continuum
