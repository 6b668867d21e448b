#include "models/stiff_flop/module.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "error.h"
#include "sim/io/decimal.h"
#include "sim/io/yaml.h"

namespace continuum::stiff_flop {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string_view Name(BodyLaw law) {
  constexpr std::array<std::string_view, 5> kNames = {"fixed", "elongation", "simple", "planar",
                                                      "general"};
  return kNames[static_cast<std::size_t>(law)];
}

std::string_view Name(ChamberLaw law) {
  constexpr std::array<std::string_view, 4> kNames = {"fixed", "elongation", "exact", "constant"};
  return kNames[static_cast<std::size_t>(law)];
}

double Above(const Yaml& node, double lower) {
  const double value = node.Parameter();
  if (value > lower) return value;
  throw Error::Input(node.Where(), "a number > " + Decimal(lower), Decimal(value));
}

double AtLeast(const Yaml& node, double lower) { return node.Parameter(lower, kInfinity); }

int Tubes(const Yaml& node) {
  const double value = AtLeast(node, 1);
  if (value == std::floor(value) && value <= 1e6) return static_cast<int>(value);
  throw Error::Input(node.Where(), "a whole number >= 1", Decimal(value));
}

Module ReadModule(const Yaml& node) {
  node.Only({"r_c1", "r_c2", "gamma", "r_o", "r_1", "r_2", "l", "l_fs", "E", "m", "m_fs", "n_c"});
  Module module;
  module.r_c1 = Above(node.At("r_c1"), 0);
  module.r_c2 = Above(node.At("r_c2"), module.r_c1);
  module.gamma = Above(node.At("gamma"), 0);
  // A right angle that was written with fewer digits than a double has is still a right angle.
  if (module.gamma > std::numbers::pi / 2 + 1e-6) {
    throw Error::Input(node.At("gamma").Where(), "a number <= pi/2", Decimal(module.gamma));
  }
  module.gamma = std::min(module.gamma, std::numbers::pi / 2);
  module.r_o = Above(node.At("r_o"), 0);
  module.r_1 = AtLeast(node.At("r_1"), 0);
  module.r_2 = Above(node.At("r_2"), module.r_1);
  module.l = Above(node.At("l"), 0);
  module.l_fs = AtLeast(node.At("l_fs"), 0);
  module.E = Above(node.At("E"), 0);
  module.m = AtLeast(node.At("m"), 0);
  module.m_fs = AtLeast(node.At("m_fs"), 0);
  if (node.Has("n_c")) module.n_c = Tubes(node.At("n_c"));
  return module;
}

Eigen::Vector3d ReadGravity(const Yaml& node) {
  const std::vector<double> values = node.Parameters();
  if (values.size() == 3) return {values[0], values[1], values[2]};
  throw Error::Input(node.Where(), "three numbers x, y, z", std::to_string(values.size()));
}

}  // namespace

const std::array<Method, 8>& Method::All() {
  using B = BodyLaw;
  using C = ChamberLaw;
  static constexpr std::array<Method, 8> kAll = {{{B::kElongation, C::kFixed},
                                                  {B::kElongation, C::kElongation},
                                                  {B::kFixed, C::kFixed},
                                                  {B::kSimple, C::kElongation},
                                                  {B::kPlanar, C::kConstant},
                                                  {B::kGeneral, C::kElongation},
                                                  {B::kGeneral, C::kExact},
                                                  {B::kGeneral, C::kConstant}}};
  return kAll;
}

std::string Method::Name(Direction direction) const {
  const bool hooke = direction == Direction::kForward || body == BodyLaw::kFixed;
  std::string name = hooke ? "hooke+" : "neo_hookean+";
  return name.append(stiff_flop::Name(body)).append("+").append(stiff_flop::Name(chamber));
}

Method Method::Parse(const std::string& name, Direction direction) {
  if (name.empty()) return {};
  std::string valid;
  for (const Method& method : All()) {
    if (method.Name(direction) == name) return method;
    valid += (valid.empty() ? "" : ", ") + method.Name(direction);
  }
  throw Error::Input("--method", "one of " + valid, "'" + name + "'");
}

double Module::Area() const { return std::numbers::pi * (r_2 * r_2 - r_1 * r_1); }

double Module::SecondMoment() const {
  return std::numbers::pi / 4 * (std::pow(r_2, 4) - std::pow(r_1, 4));
}

Robot Robot::Read(const std::filesystem::path& file, const std::string& module) {
  const Yaml yaml = Yaml::Read(file);
  yaml.Only({"format", "model", "module", "gravity", "modules", "calibration"});
  const Yaml format = yaml.At("format");
  if (format.Integer() != 1) throw Error::Input(format.Where(), "1", format.Text());
  const Yaml model = yaml.At("model");
  if (model.Text() != "stiff_flop") {
    throw Error::Input(model.Where(), "stiff_flop", "'" + model.Text() + "'");
  }
  const Yaml modules = yaml.At("modules");
  const Yaml chosen = yaml.At("module");
  const std::string name = module.empty() ? chosen.Text() : module;
  if (!modules.Has(name)) {
    throw Error::Input(chosen.Where(), "an entry of `modules`", "'" + name + "'");
  }
  for (const std::string& key : modules.Keys()) ReadModule(modules.At(key));
  return {ReadModule(modules.At(name)), ReadGravity(yaml.At("gravity")), name};
}

}  // namespace continuum::stiff_flop
