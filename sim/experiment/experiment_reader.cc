#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "effects/effect.h"
#include "error.h"
#include "sim/experiment/bounds_reader.h"
#include "sim/experiment/candidate_list.h"
#include "sim/experiment/duplicate_logs.h"
#include "sim/experiment/experiment.h"
#include "sim/experiment/log_reader.h"
#include "sim/experiment/registration_reader.h"
#include "sim/experiment/signal_reader.h"
#include "sim/io/decimal.h"
#include "sim/io/units.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

Parameter ReadParameter(const Yaml& y) {
  y.Only(
      {"name", "target", "attribute", "initial", "lower", "upper", "operation", "frozen", "per"});
  Parameter p;
  p.where = y.Where();
  p.name = y.At("name").Text();
  if (p.name.find_first_not_of(" \t\n") == std::string::npos)
    throw Error::Input(y.At("name").Where(), "a name", "none");
  p.target = y.At("target").Text();
  p.attribute = y.At("attribute").Text();
  ReadBounds(y, p);
  if (const auto initial = y.Find("initial")) {
    p.initial = initial->Number();
    p.has_initial = true;
    if (p.initial < p.lower || p.initial > p.upper) {
      throw Error::Input(
          initial->Where(),
          "a start within the bounds, " + Decimal(p.lower) + " to " + Decimal(p.upper),
          initial->Text());
    }
  }
  if (const auto o = y.Find("operation")) {
    p.operation = o->OneOf<Change::Operation>({{"set", Change::Operation::kSet},
                                               {"scale", Change::Operation::kScale},
                                               {"add", Change::Operation::kAdd}});
  }
  if (const auto frozen = y.Find("frozen")) p.frozen = frozen->Bool();
  if (const auto per = y.Find("per")) {
    p.per = per->OneOf<Parameter::Per>(
        {{"log", Parameter::Per::kLog}, {"condition", Parameter::Per::kCondition}});
  }
  return p;
}

std::vector<Experiment::Folds> ReadFolds(const Yaml& y) {
  std::vector<Experiment::Folds> folds;
  for (const Yaml& item : y.IsList() ? y.Items() : std::vector<Yaml>{y}) {
    folds.push_back(item.OneOf<Experiment::Folds>({{"trial", Experiment::Folds::kTrial},
                                                   {"condition", Experiment::Folds::kCondition},
                                                   {"window", Experiment::Folds::kWindow}}));
  }
  return folds;
}

void CheckNames(const Experiment& e, const Yaml& root) {
  std::set<std::string> names;
  for (const auto& channel : e.channels) {
    if (!names.insert(channel.name).second) {
      throw Error::Input(root.At("outputs").Where(), "different columns",
                         "'" + channel.name + "' twice");
    }
  }
  names.clear();
  for (const auto& p : e.parameters) {
    if (!names.insert(p.name).second) {
      throw Error::Input(p.where, "different parameter names", "'" + p.name + "' twice");
    }
  }
  std::set<std::string> actuators;
  for (const auto& in : e.inputs) {
    if (!actuators.insert(in.actuator).second) {
      throw Error::Input(root.At("inputs").Where(), "one input per actuator",
                         "'" + in.actuator + "' twice");
    }
  }
}

// Two logs of one file, or of files with one name, need labels of their own.
void MakeLabelsUnique(std::vector<Log>& logs) {
  std::set<std::string> taken;
  for (Log& log : logs) {
    const std::string stem = log.label;
    for (int k = 2; !taken.insert(log.label).second; ++k) {
      log.label = stem + "_" + std::to_string(k);
    }
  }
}

// Seconds per unit of the time column.
double ReadTime(const Yaml& y, Experiment& e) {
  const auto time = y.Find("time");
  if (!time) return 1;
  time->Only({"column", "unit", "skew"});
  e.time_column = time->TextOr("column", "time");
  e.time_unit = time->TextOr("unit", "s");
  double factor = 1;
  if (const auto unit = time->Find("unit")) {
    factor = UnitFactor(e.time_unit, unit->Where());
    RequireUnitLike("s", e.time_unit, unit->Where());
  }
  e.skew = time->NumberOr("skew", 0);
  if (e.skew <= -1) throw Error::Input(time->At("skew").Where(), "a skew above -1", "less");
  return factor;
}

void ReadOutputs(const Yaml& y, Experiment& e) {
  for (const Yaml& item : y.Items()) {
    e.outputs.push_back(ReadOutput(item));
    const Output& out = e.outputs.back();
    for (std::size_t c = 0; c < out.columns.size(); ++c) {
      e.channels.push_back(
          {out.columns[c], out.unit, e.outputs.size() - 1, c, UnitFactor(out.unit, "")});
    }
  }
  if (e.outputs.empty()) throw Error::Input(y.Where(), "at least one output", "none");
  if (std::none_of(e.outputs.begin(), e.outputs.end(), [](auto& o) { return o.weight > 0; }))
    throw Error::Input(y.Where(), "an output with a weight above 0", "none");
}

void ReadParameters(const Yaml& y, Experiment& e) {
  for (const Yaml& item : y.Items()) {
    e.parameters.push_back(ReadParameter(item));
    const Parameter& p = e.parameters.back();
    if (p.target == "registration" && p.attribute.starts_with("marker:"))
      e.registration.offset.try_emplace(p.attribute.substr(7, p.attribute.rfind('[') - 7));
  }
}

void ReadLogs(const Yaml& y, double time_unit, Experiment& e) {
  std::vector<std::string> where;
  for (const Yaml& item : y.Items()) {
    e.logs.push_back(ReadLog(item, e, time_unit));
    where.push_back(item.Where());
  }
  if (e.logs.empty()) throw Error::Input(y.Where(), "at least one log", "none");
  RefuseRepeatedLogs(e.logs, where);
  MakeLabelsUnique(e.logs);
}

}  // namespace

Experiment Experiment::Read(const std::filesystem::path& file) {
  const Yaml y = Yaml::Read(file);
  y.Only({"format", "model", "logs", "time", "start", "inputs", "outputs", "registration",
          "quasi_static", "parameters", "candidates", "folds", "loss", "swarm"});
  if (y.At("format").Number() != 1) {
    throw Error::Input(y.At("format").Where(), "format 1", y.At("format").Text());
  }

  Experiment e;
  e.file = file;
  e.model = y.At("model").File("a model file");
  const double time_unit = ReadTime(y, e);
  if (const auto start = y.Find("start")) {
    e.start = start->OneOf<Start>({{"rest", Start::kRest},
                                   {"equilibrium", Start::kEquilibrium},
                                   {"measured", Start::kMeasured},
                                   {"estimate", Start::kEstimate}});
  }
  if (const auto q = y.Find("quasi_static")) e.quasi_static = q->Bool();
  if (const auto inputs = y.Find("inputs")) {
    for (const Yaml& item : inputs->Items()) e.inputs.push_back(ReadInput(item));
  }
  ReadOutputs(y.At("outputs"), e);
  if (const auto r = y.Find("registration")) e.registration = ReadRegistration(*r);
  if (const auto parameters = y.Find("parameters")) ReadParameters(*parameters, e);
  if (const auto c = y.Find("candidates"); c && !(c->IsScalar() && c->Text() == "all")) {
    e.all_candidates = false;
    e.candidates = ReadCandidates(*c);
  }
  if (const auto folds = y.Find("folds")) e.folds = ReadFolds(*folds);
  if (const auto loss = y.Find("loss")) {
    loss->Only({"soft_l1"});
    e.soft = loss->At("soft_l1").Number(1e-300, kInfinity);
  }
  CheckNames(e, y);
  ReadLogs(y.At("logs"), time_unit, e);
  return e;
}

}  // namespace continuum
