#include "sim/experiment/experiment.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "effects/effect.h"
#include "error.h"
#include "sim/experiment/candidate_list.h"
#include "sim/experiment/duplicate_logs.h"
#include "sim/io/csv.h"
#include "sim/io/file.h"
#include "sim/io/mat_file.h"
#include "sim/io/units.h"

namespace continuum {
namespace {

// The numbers of a log's file, whatever its format.
class Recording {
 public:
  Recording(const std::filesystem::path& file, const std::string& variable) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".mat") {
      mat_ = ReadMat(file, variable);
      name_ = file.string();
    } else {
      table_ = CsvTable::Read(file);
      name_ = file.string();
    }
  }

  std::size_t rows() const { return table_ ? table_->rows() : mat_->values.front().size(); }
  std::string Where(std::size_t row) const {
    return table_ ? table_->Where(row) : name_ + ", row " + std::to_string(row + 1);
  }
  bool Flag(std::size_t row, const std::string& column) const {
    return table_ ? table_->Flag(row, column) : Number(row, column, false) != 0;
  }
  double Number(std::size_t row, const std::string& column, bool may_miss) const {
    if (table_) return may_miss ? table_->NumberOrNan(row, column) : table_->Number(row, column);
    const auto found = std::find(mat_->names.begin(), mat_->names.end(), column);
    if (found == mat_->names.end()) {
      std::string all;
      for (const auto& name : mat_->names) all += (all.empty() ? "" : ", ") + name;
      throw Error::Input(name_, "a column '" + column + "'", all);
    }
    const double value = mat_->values[found - mat_->names.begin()][row];
    if (std::abs(value) <= CsvTable::kLargest || (may_miss && std::isnan(value))) return value;
    throw Error::Input(Where(row) + ", column '" + column + "'", "a number within +-1e100",
                       std::isnan(value) ? "none" : Decimal(value));
  }

 private:
  std::optional<CsvTable> table_;
  std::optional<Columns> mat_;
  std::string name_;
};

template <class T>
T OneOf(const Yaml& y, const std::vector<std::pair<std::string, T>>& options) {
  const std::string text = y.Text();
  std::string all;
  for (const auto& [name, value] : options) {
    if (text == name) return value;
    all += (all.empty() ? "" : " | ") + name;
  }
  throw Error::Input(y.Where(), all, "'" + text + "'");
}

std::string TextOr(const Yaml& y, const std::string& key, const std::string& fallback) {
  const auto found = y.Find(key);
  return found ? found->Text() : fallback;
}

Input ReadInput(const Yaml& y) {
  y.Only({"column", "unit", "actuator", "interpolate", "enable"});
  Input in;
  in.where = y.Where();
  in.actuator = y.At("actuator").Text();
  in.column = TextOr(y, "column", "");
  in.enable = TextOr(y, "enable", "");
  in.unit = TextOr(y, "unit", "1");
  if (in.column.empty() && in.enable.empty()) {
    throw Error::Input(y.Where(), "the key 'column' or 'enable'", "none");
  }
  if (const auto i = y.Find("interpolate")) {
    in.linear = OneOf<bool>(*i, {{"hold", false}, {"linear", true}});
  }
  if (const auto unit = y.Find("unit")) UnitFactor(in.unit, unit->Where());
  return in;
}

Measurement ReadMeasurement(const Yaml& y) {
  Measurement m;
  m.bias = y.NumberOr("bias", 0);
  m.scale = y.NumberOr("scale", 1);
  m.delay = y.NumberOr("delay", 0);
  m.rate = y.NumberOr("rate", 0);
  m.angle = y.NumberOr("angle", 0);
  if (const auto axis = y.Find("axis")) {
    m.axis = axis->Numbers();
    if (m.axis.size() != 3)
      throw Error::Input(axis->Where(), "three numbers", std::to_string(m.axis.size()));
  }
  if (m.angle != 0 && m.axis[0] == 0 && m.axis[1] == 0 && m.axis[2] == 0) {
    throw Error::Input(y.At("axis").Where(), "an axis with a direction", "zero");
  }
  if (m.delay < 0)
    throw Error::Input(y.At("delay").Where(), "a delay >= 0 s", y.At("delay").Text());
  return m;
}

Output ReadOutput(const Yaml& y) {
  y.Only({"column", "columns", "unit", "sensor", "actuator", "quantity", "sigma", "weight", "bias",
          "scale", "delay", "rate", "angle", "axis"});
  Output out;
  out.where = y.Where();
  const Yaml column = y.Has("columns") ? y.At("columns") : y.At("column");
  if (column.IsList()) {
    for (const Yaml& item : column.Items()) out.columns.push_back(item.Text());
    if (out.columns.size() != 4) {
      throw Error::Input(column.Where(), "one column, or four of a quaternion (w, x, y, z)",
                         std::to_string(out.columns.size()));
    }
  } else {
    out.columns = {column.Text()};
  }
  out.unit = TextOr(y, "unit", "1");
  if (y.Has("sensor") == y.Has("actuator")) {
    throw Error::Input(y.Where(), "one of the keys 'sensor' and 'actuator'",
                       y.Has("sensor") ? "both" : "none");
  }
  if (y.Has("sensor")) {
    out.source = y.At("sensor").Text();
  } else {
    out.source = y.At("actuator").Text();
    out.kind = Output::Kind::kForce;
    if (const auto q = y.Find("quantity")) {
      out.kind = OneOf<Output::Kind>(
          *q, {{"force", Output::Kind::kForce}, {"control", Output::Kind::kControl}});
    }
  }
  if (out.quaternion() && out.kind != Output::Kind::kSensor) {
    throw Error::Input(column.Where(), "one column", "four for an actuator's number");
  }
  if (const auto sigma = y.Find("sigma")) out.sigma = sigma->Number(1e-300, kInfinity);
  if (const auto weight = y.Find("weight")) out.weight = weight->Number(0, kInfinity);
  out.measurement = ReadMeasurement(y);
  if (out.measurement.angle != 0 && out.kind != Output::Kind::kSensor) {
    throw Error::Input(y.At("angle").Where(), "a turn of a vector or a quaternion",
                       "one of an actuator's " + TextOr(y, "quantity", "force"));
  }
  if (const auto unit = y.Find("unit")) UnitFactor(out.unit, unit->Where());
  return out;
}

Registration::Vector ReadVector(const Yaml& y) {
  const auto numbers = y.Numbers();
  if (numbers.size() != 3) {
    throw Error::Input(y.Where(), "three numbers", std::to_string(numbers.size()));
  }
  return {numbers[0], numbers[1], numbers[2]};
}

// Whether a part is to be estimated; anything else is read as what is known of it.
Registration::Part ReadPart(const Yaml& y, const std::function<void()>& known) {
  using Part = Registration::Part;
  if (y.IsScalar() && y.Text() == "estimate") return Part::kEstimate;
  known();
  return Part::kKnown;
}

Registration ReadRegistration(const Yaml& y) {
  y.Only({"frame", "marker", "clock_shift"});
  Registration r;
  if (const auto frame = y.Find("frame")) {
    r.frame = ReadPart(*frame, [&] {
      if (!frame->IsMap()) {
        throw Error::Input(frame->Where(), "estimate | {rotation: [x, y, z], translation: [..]}",
                           frame->Found());
      }
      frame->Only({"rotation", "translation"});
      if (const auto v = frame->Find("rotation")) r.rotation = ReadVector(*v);
      if (const auto v = frame->Find("translation")) r.translation = ReadVector(*v);
    });
  }
  if (const auto marker = y.Find("marker")) {
    r.marker = ReadPart(*marker, [&] {
      if (!marker->IsMap()) {
        r.offset[""] = ReadVector(*marker);
        return;
      }
      for (const auto& sensor : marker->Keys()) r.offset[sensor] = ReadVector(marker->At(sensor));
    });
  }
  if (const auto clock = y.Find("clock_shift"))
    r.clock = ReadPart(*clock, [&] { r.clock_shift = clock->Number(); });
  return r;
}

std::vector<Change> ReadSettings(const Yaml& y) {
  std::vector<Change> settings;
  for (const auto& target : y.Keys()) {
    const Yaml attributes = y.At(target);
    for (const auto& attribute : attributes.Keys()) {
      settings.push_back({target, attribute, attributes.At(attribute).Number()});
    }
  }
  return settings;
}

std::string Listed(const std::vector<double>& numbers) {
  std::string text = "[";
  for (const double x : numbers) text += (text.size() > 1 ? ", " : "") + Decimal(x);
  return text + "]";
}

std::map<std::string, std::array<double, 2>> ReadStart(const Yaml& y) {
  std::map<std::string, std::array<double, 2>> start;
  for (const auto& joint : y.Keys()) {
    const auto numbers = y.At(joint).Numbers();
    if (numbers.size() != 2)
      throw Error::Input(y.At(joint).Where(), "[position, speed]", Listed(numbers));
    start[joint] = {numbers[0], numbers[1]};
  }
  return start;
}

Parameter ReadParameter(const Yaml& y) {
  y.Only(
      {"name", "target", "attribute", "initial", "lower", "upper", "operation", "frozen", "per"});
  Parameter p;
  p.where = y.Where();
  p.name = y.At("name").Text();
  p.target = y.At("target").Text();
  p.attribute = y.At("attribute").Text();
  p.lower = y.At("lower").Number();
  p.upper = y.At("upper").Number();
  if (!(p.lower < p.upper)) {
    throw Error::Input(y.At("upper").Where(), "upper above lower", y.At("upper").Text());
  }
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
    p.operation = OneOf<Change::Operation>(*o, {{"set", Change::Operation::kSet},
                                                {"scale", Change::Operation::kScale},
                                                {"add", Change::Operation::kAdd}});
  }
  if (const auto frozen = y.Find("frozen")) p.frozen = frozen->Bool();
  if (const auto per = y.Find("per")) {
    p.per = OneOf<Parameter::Per>(
        *per, {{"log", Parameter::Per::kLog}, {"condition", Parameter::Per::kCondition}});
  }
  return p;
}

std::vector<Experiment::Folds> ReadFolds(const Yaml& y) {
  std::vector<Experiment::Folds> folds;
  for (const Yaml& item : y.IsList() ? y.Items() : std::vector<Yaml>{y}) {
    folds.push_back(OneOf<Experiment::Folds>(item, {{"trial", Experiment::Folds::kTrial},
                                                    {"condition", Experiment::Folds::kCondition},
                                                    {"window", Experiment::Folds::kWindow}}));
  }
  return folds;
}

// Rows that were written twice are the usual cause.
Error TimeGoesBack(const Experiment& e, const Recording& rec, std::size_t row) {
  const double now = rec.Number(row, e.time_column, false);
  std::string found = Decimal(now) + " after " + Decimal(rec.Number(row - 1, e.time_column, false));
  for (std::size_t k = 0; k < row; ++k) {
    if (rec.Number(k, e.time_column, false) != now) continue;
    found += ", as in " + rec.Where(k) + ": are rows there twice?";
    break;
  }
  return Error::Input(rec.Where(row) + ", column '" + e.time_column + "'", "increasing time",
                      found);
}

void ReadRows(Log& log, const Experiment& e, const Recording& rec, double time_unit) {
  const std::vector<double>& window = log.window;
  double last = -kInfinity;
  std::vector<std::size_t> kept;
  for (std::size_t row = 0; row < rec.rows(); ++row) {
    const double t = rec.Number(row, e.time_column, false) * time_unit;
    if (!(t > last)) throw TimeGoesBack(e, rec, row);
    last = t;
    if (!window.empty() && (t < window[0] || t > window[1])) continue;
    kept.push_back(row);
    log.time.push_back(t * (1 + e.skew));
  }
  if (kept.size() < 2) {
    const std::string in = window.empty() ? "" : " within its window, " + Listed(window) + " s";
    const std::string rows = rec.rows() > 0 && kept.empty()
                                 ? "none: it ends at " + Decimal(last) + " s"
                                 : std::to_string(kept.size());
    throw Error::Input(log.file.string() + in, "at least two rows", rows);
  }
  for (const Input& in : e.inputs) {
    std::vector<double> values;
    std::vector<bool> on;
    const double factor = UnitFactor(in.unit, "");
    for (const std::size_t row : kept) {
      values.push_back(in.column.empty() ? 0 : factor * rec.Number(row, in.column, false));
      if (!in.enable.empty()) on.push_back(rec.Flag(row, in.enable));
    }
    log.input.push_back(std::move(values));
    log.enable.push_back(std::move(on));
  }
  for (const auto& channel : e.channels) {
    std::vector<double> values;
    for (const std::size_t row : kept) {
      values.push_back(channel.factor * rec.Number(row, channel.name, true));
    }
    if (std::all_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) {
      throw Error::Input(log.file.string() + ", column '" + channel.name + "'",
                         "at least one number", "none");
    }
    log.measured.push_back(std::move(values));
  }
}

// The file that a key names, beside the experiment.
std::filesystem::path FileAt(const Yaml& y, const std::filesystem::path& experiment,
                             const std::string& expected) {
  const std::filesystem::path file = experiment.parent_path() / y.Text();
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw Error::Input(y.Where(), expected, "no file " + file.string());
  if (std::filesystem::is_directory(file, ignored))
    throw Error::Input(y.Where(), expected, "a folder");
  return file;
}

Log ReadLog(const Yaml& y, const Experiment& e, double time_unit) {
  y.Only({"file", "variable", "trial", "use", "window", "condition", "set", "start"});
  Log log;
  log.file = FileAt(y.At("file"), e.file, "a log file");
  log.label = log.file.stem().string();
  log.trial = TextOr(y, "trial", log.label);
  log.condition = TextOr(y, "condition", "");
  if (const auto use = y.Find("use")) {
    log.train = OneOf<bool>(*use, {{"train", true}, {"validate", false}});
  }
  log.variable = TextOr(y, "variable", "");
  if (const auto w = y.Find("window")) {
    log.window = w->Numbers();
    if (log.window.size() != 2 || !(log.window[0] < log.window[1])) {
      throw Error::Input(w->Where(), "[begin, end] in s", Listed(log.window));
    }
    log.label += "_" + w->Items()[0].Text() + "_" + w->Items()[1].Text();
  }
  if (const auto set = y.Find("set")) log.set = ReadSettings(*set), log.set_where = set->Where();
  if (const auto start = y.Find("start")) log.start = ReadStart(*start);
  ReadRows(log, e, Recording(log.file, log.variable), time_unit);
  return log;
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

}  // namespace

const Candidate* Experiment::Written(std::string_view name) const {
  for (const Candidate& c : candidates) {
    if (c.law && c.law->name == name) return &c;
  }
  return nullptr;
}

Experiment Experiment::Read(const std::filesystem::path& file) {
  const Yaml y = Yaml::Read(file);
  y.Only({"format", "model", "logs", "time", "start", "inputs", "outputs", "registration",
          "quasi_static", "parameters", "candidates", "folds", "loss"});
  if (y.At("format").Number() != 1) {
    throw Error::Input(y.At("format").Where(), "format 1", y.At("format").Text());
  }

  Experiment e;
  e.file = file;
  e.model = FileAt(y.At("model"), file, "a model file");
  double time_unit = 1;
  if (const auto time = y.Find("time")) {
    time->Only({"column", "unit", "skew"});
    e.time_column = TextOr(*time, "column", "time");
    e.time_unit = TextOr(*time, "unit", "s");
    if (const auto unit = time->Find("unit")) {
      time_unit = UnitFactor(e.time_unit, unit->Where());
      RequireUnitLike("s", e.time_unit, unit->Where());
    }
    e.skew = time->NumberOr("skew", 0);
    if (e.skew <= -1) throw Error::Input(time->At("skew").Where(), "a skew above -1", "less");
  }
  if (const auto start = y.Find("start")) {
    e.start = OneOf<Start>(*start, {{"rest", Start::kRest},
                                    {"equilibrium", Start::kEquilibrium},
                                    {"measured", Start::kMeasured},
                                    {"estimate", Start::kEstimate}});
  }
  if (const auto q = y.Find("quasi_static")) e.quasi_static = q->Bool();
  if (const auto inputs = y.Find("inputs")) {
    for (const Yaml& item : inputs->Items()) e.inputs.push_back(ReadInput(item));
  }
  for (const Yaml& item : y.At("outputs").Items()) {
    e.outputs.push_back(ReadOutput(item));
    const Output& out = e.outputs.back();
    for (std::size_t c = 0; c < out.columns.size(); ++c) {
      e.channels.push_back(
          {out.columns[c], out.unit, e.outputs.size() - 1, c, UnitFactor(out.unit, "")});
    }
  }
  if (e.outputs.empty()) throw Error::Input(y.At("outputs").Where(), "at least one output", "none");
  if (std::none_of(e.outputs.begin(), e.outputs.end(), [](auto& o) { return o.weight > 0; }))
    throw Error::Input(y.At("outputs").Where(), "an output with a weight above 0", "none");
  if (const auto r = y.Find("registration")) e.registration = ReadRegistration(*r);
  if (const auto parameters = y.Find("parameters")) {
    for (const Yaml& item : parameters->Items()) {
      e.parameters.push_back(ReadParameter(item));
      const Parameter& p = e.parameters.back();
      if (p.target == "registration" && p.attribute.starts_with("marker:"))
        e.registration.offset.try_emplace(p.attribute.substr(7, p.attribute.rfind('[') - 7));
    }
  }
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
  std::vector<std::string> where;
  for (const Yaml& item : y.At("logs").Items()) {
    e.logs.push_back(ReadLog(item, e, time_unit));
    where.push_back(item.Where());
  }
  if (e.logs.empty()) throw Error::Input(y.At("logs").Where(), "at least one log", "none");
  RefuseRepeatedLogs(e.logs, where);
  MakeLabelsUnique(e.logs);
  return e;
}

}  // namespace continuum
