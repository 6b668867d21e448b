#include "sim/experiment/signal_reader.h"

#include <string>
#include <vector>

#include "effects/effect.h"
#include "error.h"
#include "sim/io/units.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

Measurement ReadMeasurement(const Yaml& y) {
  Measurement m;
  m.bias = y.NumberOr("bias", 0);
  m.scale = y.NumberOr("scale", 1);
  m.delay = y.NumberOr("delay", 0);
  m.rate = y.NumberOr("rate", 0);
  m.angle = y.NumberOr("angle", 0);
  m.cosine = y.NumberOr("cosine", 0);
  m.sine = y.NumberOr("sine", 0);
  m.harmonic = y.NumberOr("harmonic", 1);
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

// One column, or the four of a quaternion.
std::vector<std::string> ReadColumns(const Yaml& y) {
  if (!y.IsList()) return {y.Text()};
  std::vector<std::string> columns;
  for (const Yaml& item : y.Items()) columns.push_back(item.Text());
  if (columns.size() == 4) return columns;
  throw Error::Input(y.Where(), "one column, or four of a quaternion (w, x, y, z)",
                     std::to_string(columns.size()));
}

void ReadSource(const Yaml& y, Output& out) {
  if (y.Has("sensor") == y.Has("actuator")) {
    throw Error::Input(y.Where(), "one of the keys 'sensor' and 'actuator'",
                       y.Has("sensor") ? "both" : "none");
  }
  if (y.Has("sensor")) {
    out.source = y.At("sensor").Text();
    return;
  }
  out.source = y.At("actuator").Text();
  out.kind = Output::Kind::kForce;
  if (const auto q = y.Find("quantity")) {
    out.kind = q->OneOf<Output::Kind>(
        {{"force", Output::Kind::kForce}, {"control", Output::Kind::kControl}});
  }
}

// Only angles have turns.
bool ReadUnwrap(const Yaml& y, const std::string& unit) {
  const auto unwrap = y.Find("unwrap");
  if (!unwrap || !unwrap->Bool()) return false;
  if (ParseUnit(unit, unwrap->Where()).IsAngle()) return true;
  throw Error::Input(unwrap->Where(), "the unit of an angle, as rad or deg", "'" + unit + "'");
}

}  // namespace

Input ReadInput(const Yaml& y) {
  y.Only({"column", "unit", "actuator", "interpolate", "enable", "unwrap"});
  Input in;
  in.where = y.Where();
  in.actuator = y.At("actuator").Text();
  in.column = y.TextOr("column", "");
  in.enable = y.TextOr("enable", "");
  in.unit = y.TextOr("unit", "1");
  if (in.column.empty() && in.enable.empty()) {
    throw Error::Input(y.Where(), "the key 'column' or 'enable'", "none");
  }
  if (const auto i = y.Find("interpolate")) {
    in.linear = i->OneOf<bool>({{"hold", false}, {"linear", true}});
    in.gaps = true;
  }
  if (const auto unit = y.Find("unit")) UnitFactor(in.unit, unit->Where());
  in.unwrap = ReadUnwrap(y, in.unit);
  return in;
}

Output ReadOutput(const Yaml& y) {
  y.Only({"column", "columns", "unit", "sensor", "actuator", "quantity", "sigma", "weight", "bias",
          "scale", "delay", "rate", "angle", "axis", "cosine", "sine", "harmonic", "unwrap"});
  Output out;
  out.where = y.Where();
  const Yaml column = y.Has("columns") ? y.At("columns") : y.At("column");
  out.columns = ReadColumns(column);
  out.unit = y.TextOr("unit", "1");
  ReadSource(y, out);
  if (out.quaternion() && out.kind != Output::Kind::kSensor) {
    throw Error::Input(column.Where(), "one column", "four for an actuator's number");
  }
  if (const auto sigma = y.Find("sigma")) out.sigma = sigma->Number(1e-300, kInfinity);
  if (const auto weight = y.Find("weight")) out.weight = weight->Number(0, kInfinity);
  out.measurement = ReadMeasurement(y);
  if (out.measurement.angle != 0 && out.kind != Output::Kind::kSensor) {
    throw Error::Input(y.At("angle").Where(), "a turn of a vector or a quaternion",
                       "one of an actuator's " + y.TextOr("quantity", "force"));
  }
  if (const auto unit = y.Find("unit")) UnitFactor(out.unit, unit->Where());
  out.unwrap = ReadUnwrap(y, out.unit);
  return out;
}

}  // namespace continuum
