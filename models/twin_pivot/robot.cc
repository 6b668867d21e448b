#include "models/twin_pivot/robot.h"

#include <numeric>

#include "error.h"
#include "sim/io/decimal.h"
#include "sim/io/file.h"
#include "sim/io/yaml.h"

namespace continuum::twin_pivot {
namespace {

double Positive(const Yaml& node) {
  const double value = node.Parameter();
  if (value > 0) return value;
  throw Error::Input(node.Where(), "a number > 0", Decimal(value));
}

double AtLeast(const Yaml& node, double lower) {
  const double value = node.Parameter();
  if (value >= lower) return value;
  throw Error::Input(node.Where(), "a number >= " + Decimal(lower), Decimal(value));
}

std::vector<Yaml> List(const Yaml& node, std::size_t count, const std::string& what) {
  std::vector<Yaml> items = node.Quantity().Items();
  if (items.size() == count) return items;
  throw Error::Input(node.Where(), std::to_string(count) + " numbers, " + what,
                     std::to_string(items.size()));
}

// What is solved in seconds: Jacobians are dense.
constexpr int kMostDiscs = 400;

std::vector<int> Discs(const Yaml& node) {
  std::vector<int> discs;
  int all = 0;
  for (const Yaml& item : node.Quantity().Items()) {
    const int count = item.Integer();
    if (count <= 0 || count % 2 != 0) {
      throw Error::Input(item.Where(), "an even number > 0, two discs per segment",
                         std::to_string(count));
    }
    if (count > kMostDiscs - all) {
      throw Error::Input(item.Where(), "at most " + std::to_string(kMostDiscs) + " discs in all",
                         std::to_string(count) + " more than " + std::to_string(all));
    }
    discs.push_back(count);
    all += count;
  }
  if (discs.empty()) throw Error::Input(node.Where(), "one section or more", "none");
  return discs;
}

void RequireVersion(const Yaml& yaml) {
  const Yaml format = yaml.At("format");
  if (format.Integer() != 1) throw Error::Input(format.Where(), "1", format.Text());
  const Yaml robot = yaml.At("robot");
  if (robot.Text() != "twin_pivot") {
    throw Error::Input(robot.Where(), "twin_pivot", "'" + robot.Text() + "'");
  }
}

void ReadFriction(const Yaml& node, Robot& robot) {
  node.Only({"a", "b", "c", "mu_const", "eps"});
  robot.friction.a = node.At("a").Parameter();
  robot.friction.b = node.At("b").Parameter();
  robot.friction.c = AtLeast(node.At("c"), 0);
  robot.mu_const = AtLeast(node.At("mu_const"), 0);
  robot.eps = Positive(node.At("eps"));
}

}  // namespace

int Robot::Joints() const { return std::accumulate(discs.begin(), discs.end(), 0); }

int Robot::Anchor(int cable) const {
  return std::accumulate(discs.begin(), discs.begin() + cable / 4 + 1, 0);
}

Robot Robot::Read(const std::filesystem::path& file) {
  const Yaml yaml = Yaml::Read(file);
  yaml.Only({"format", "robot", "discs", "L", "h", "E", "I_z", "rods", "r", "phi", "m_D", "m_NiTi",
             "rho_cable", "m_CL", "cable_EA", "friction", "gravity"});
  RequireVersion(yaml);
  Robot robot;
  robot.file = file.string();
  robot.discs = Discs(yaml.At("discs"));
  robot.L = Positive(yaml.At("L"));
  robot.h = Positive(yaml.At("h"));
  robot.E = Positive(yaml.At("E"));
  robot.I_z = Positive(yaml.At("I_z"));
  robot.rods = AtLeast(yaml.At("rods"), 1);
  const std::size_t cables = 4 * robot.discs.size();
  for (const Yaml& item : List(yaml.At("r"), cables, "four cables per section")) {
    robot.r.push_back(Positive(item));
  }
  for (const Yaml& item : List(yaml.At("phi"), cables, "four cables per section")) {
    robot.phi.push_back(item.Number());
  }
  robot.m_D = AtLeast(yaml.At("m_D"), 0);
  robot.m_NiTi = AtLeast(yaml.At("m_NiTi"), 0);
  robot.rho_cable = AtLeast(yaml.At("rho_cable"), 0);
  robot.m_CL = AtLeast(yaml.At("m_CL"), 0);
  if (yaml.Has("cable_EA")) robot.cable_EA = Positive(yaml.At("cable_EA"));
  ReadFriction(yaml.At("friction"), robot);
  const std::vector<Yaml> gravity = List(yaml.At("gravity"), 3, "x, y, z");
  for (int i = 0; i < 3; ++i) robot.gravity[i] = gravity[i].Number();
  return robot;
}

}  // namespace continuum::twin_pivot
