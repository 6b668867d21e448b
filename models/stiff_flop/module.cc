#include "models/stiff_flop/module.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

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

constexpr int kFewestLines = 2, kMostLines = 4;

// `psi`: the angles of the lines; else `lines`: so many at even angles.
std::vector<LineAngle> ReadLines(const Yaml& module) {
  const std::string expected = fmt::format("{} to {}", kFewestLines, kMostLines);
  const auto check = [&](const Yaml& node, double count) {
    if (count >= kFewestLines && count <= kMostLines && count == std::floor(count)) return;
    throw Error::Input(node.Where(), expected + " pressure lines", Decimal(count));
  };
  if (module.Has("lines")) check(module.At("lines"), module.At("lines").Parameter());
  if (!module.Has("psi")) {
    return EvenLines(module.Has("lines") ? static_cast<int>(module.At("lines").Parameter()) : 3);
  }
  const Yaml psi = module.At("psi");
  const std::vector<double> angles = psi.Parameters();
  check(psi, static_cast<double>(angles.size()));
  if (module.Has("lines") && module.At("lines").Parameter() != static_cast<double>(angles.size())) {
    throw Error::Input(psi.Where(), "an angle for each of `lines`", std::to_string(angles.size()));
  }
  std::vector<LineAngle> lines;
  for (const double angle : angles) {
    if (std::abs(angle) > 2 * std::numbers::pi) {
      throw Error::Input(psi.Where(), "angles within a turn [rad]", Decimal(angle));
    }
    lines.push_back({std::cos(angle), std::sin(angle)});
  }
  return lines;
}

Module ReadModule(const Yaml& node) {
  node.Only({"r_c1", "r_c2", "gamma", "r_o", "r_1", "r_2", "l", "l_fs", "E", "m", "m_fs", "n_c",
             "lines", "psi"});
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
  module.lines = ReadLines(node);
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

std::vector<LineAngle> EvenLines(int count) {
  constexpr double kHalfRoot3 = 0.86602540378443864676;
  if (count == 3) return {{1, 0}, {-0.5, kHalfRoot3}, {-0.5, -kHalfRoot3}};
  if (count == 2) return {{1, 0}, {-1, 0}};
  if (count == 4) return {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  std::vector<LineAngle> lines;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    lines.push_back({std::cos(angle), std::sin(angle)});
  }
  return lines;
}

Eigen::Index ModuleSeries::lines() const {
  Eigen::Index count = 0;
  for (const Module& module : modules) count += static_cast<Eigen::Index>(module.lines.size());
  return count;
}

double ModuleSeries::length() const {
  double length = 0;
  for (const Module& module : modules) length += module.l;
  return length;
}

double ModuleSeries::mounts() const {
  double length = 0;
  for (const Module& module : modules) length += module.l_fs;
  return length;
}

double ModuleSeries::mass() const {
  double mass = 0;
  for (const Module& module : modules) mass += module.m + module.m_fs;
  return mass;
}

double ModuleSeries::unit() const { return first().E * first().SecondMoment() / length(); }

Eigen::VectorXd ModuleSeries::PressuresOf(std::size_t module, const Eigen::VectorXd& all) const {
  Eigen::Index start = 0;
  for (std::size_t i = 0; i < module; ++i) {
    start += static_cast<Eigen::Index>(modules[i].lines.size());
  }
  return all.segment(start, static_cast<Eigen::Index>(modules[module].lines.size()));
}

Eigen::Vector3d ModuleSeries::Above(std::size_t module, const Eigen::Vector3d& force,
                                    const Eigen::Vector3d& gravity) const {
  double mass = modules[module].m_fs;
  for (std::size_t i = module + 1; i < size(); ++i) mass += modules[i].m + modules[i].m_fs;
  return force + mass * gravity;
}

Eigen::Vector3d ModuleSeries::Lever(std::size_t module, const Eigen::Vector3d& force,
                                    const Eigen::Vector3d& gravity) const {
  const Module& m = modules[module];
  return m.l_fs * (Above(module, force, gravity) - 0.5 * m.m_fs * gravity);
}

namespace {

// The keys under `modules` of the modules in series: `module`, or `series`.
std::vector<std::string> Chosen(const Yaml& robot, const std::string& module) {
  const Yaml modules = robot.At("modules");
  const auto check = [&](const Yaml& where, const std::string& name) {
    if (modules.Has(name)) return name;
    throw Error::Input(where.Where(), "an entry of `modules`", "'" + name + "'");
  };
  if (!module.empty()) return {check(modules, module)};
  if (!robot.Has("series")) return {check(robot.At("module"), robot.At("module").Text())};
  const Yaml series = robot.At("series");
  if (robot.Has("module")) {
    throw Error::Input(series.Where(), "`module` or `series`", "both");
  }
  std::vector<std::string> names;
  for (const Yaml& item : series.Items()) names.push_back(check(item, item.Text()));
  if (names.empty()) throw Error::Input(series.Where(), "entries of `modules`", "none");
  return names;
}

}  // namespace

Robot Robot::Read(const std::filesystem::path& file, const std::string& module) {
  const Yaml yaml = Yaml::Read(file);
  yaml.Only({"format", "model", "module", "series", "gravity", "modules", "calibration"});
  const Yaml format = yaml.At("format");
  if (format.Integer() != 1) throw Error::Input(format.Where(), "1", format.Text());
  const Yaml model = yaml.At("model");
  if (model.Text() != "stiff_flop") {
    throw Error::Input(model.Where(), "stiff_flop", "'" + model.Text() + "'");
  }
  const Yaml all = yaml.At("modules");
  for (const std::string& key : all.Keys()) ReadModule(all.At(key));
  std::vector<Module> modules;
  const std::vector<std::string> names = Chosen(yaml, module);
  for (const std::string& name : names) modules.push_back(ReadModule(all.At(name)));
  return {ModuleSeries(std::move(modules)), ReadGravity(yaml.At("gravity")), names,
          fmt::format("{}", fmt::join(names, "+"))};
}

void Robot::RequireOne(const std::string& what) const {
  if (series.size() == 1) return;
  throw Error::Input(what, "a robot of one module", std::to_string(series.size()) + " in series");
}

}  // namespace continuum::stiff_flop
