#include "models/twin_pivot/robot.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

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

// A number, or one for each section; each as `read` accepts it.
template <class Check>
PerSection Sectional(const Yaml& node, int sections, const Check& read) {
  if (!node.Quantity().IsList()) return read(node);
  std::vector<double> values;
  for (const Yaml& item : List(node, static_cast<std::size_t>(sections), "one per section")) {
    values.push_back(read(item));
  }
  return PerSection(std::move(values));
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

constexpr int kLeastCables = 3, kMostCables = 60;  // of a section

std::vector<int> ReadCounts(const Yaml& node, int sections) {
  std::vector<int> counts;
  for (const Yaml& item : List(node, static_cast<std::size_t>(sections), "one per section")) {
    counts.push_back(item.Integer());
    if (counts.back() >= kLeastCables && counts.back() <= kMostCables) continue;
    throw Error::Input(item.Where(),
                       fmt::format("{} to {} cables in a section", kLeastCables, kMostCables),
                       std::to_string(counts.back()));
  }
  return counts;
}

// As `cables` says; without it as many in each section as the length of `r` leaves it.
std::vector<int> Cables(const Yaml& yaml, int sections) {
  if (yaml.Has("cables")) return ReadCounts(yaml.At("cables"), sections);
  const Yaml r = yaml.At("r");
  const int all = static_cast<int>(r.Quantity().Items().size());
  const int each = all / sections;
  if (all % sections == 0 && each >= kLeastCables && each <= kMostCables) {
    return std::vector<int>(static_cast<std::size_t>(sections), each);
  }
  throw Error::Input(r.Where(),
                     fmt::format("{} to {} cables for each of {} sections; their numbers in "
                                 "`cables` where they differ",
                                 kLeastCables, kMostCables, sections),
                     std::to_string(all));
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
  node.Only({"a", "b", "c", "mu_const", "eps", "theta_max"});
  robot.friction.a = node.At("a").Parameter();
  robot.friction.b = node.At("b").Parameter();
  robot.friction.c = AtLeast(node.At("c"), 0);
  robot.mu_const = AtLeast(node.At("mu_const"), 0);
  robot.eps = Positive(node.At("eps"));
  if (node.Has("theta_max")) {
    robot.theta_max = node.At("theta_max").Parameter(1e-6, 0.5 * std::numbers::pi);
  }
}

void ReadSections(const Yaml& yaml, Robot& robot) {
  const auto read = [&](const char* key, const auto& check) {
    return Sectional(yaml.At(key), robot.Sections(), check);
  };
  const auto positive = [](const Yaml& node) { return Positive(node); };
  const auto not_negative = [](const Yaml& node) { return AtLeast(node, 0); };
  robot.L = read("L", positive);
  robot.h = read("h", positive);
  robot.E = read("E", positive);
  robot.I_z = read("I_z", positive);
  robot.rods = read("rods", [](const Yaml& node) { return AtLeast(node, 1); });
  robot.m_D = read("m_D", not_negative);
  robot.m_NiTi = read("m_NiTi", not_negative);
  robot.rho_cable = read("rho_cable", not_negative);
  robot.m_CL = read("m_CL", not_negative);
}

void ReadCables(const Yaml& yaml, Robot& robot) {
  robot.cables = Cables(yaml, robot.Sections());
  const int all = std::accumulate(robot.cables.begin(), robot.cables.end(), 0);
  const auto list = [&](const char* key) {
    return List(yaml.At(key), static_cast<std::size_t>(all), "one for each cable");
  };
  for (const Yaml& item : list("r")) robot.r.push_back(Positive(item));
  for (const Yaml& item : list("phi")) robot.phi.push_back(item.Number());
}

// The section that holds the item of this number.
int SectionOf(const std::vector<int>& counts, int item) {
  int section = 0;
  while (item >= counts[static_cast<std::size_t>(section)]) {
    item -= counts[static_cast<std::size_t>(section++)];
  }
  return section;
}

}  // namespace

int Robot::Joints() const { return std::accumulate(discs.begin(), discs.end(), 0); }

int Robot::SectionOfJoint(int joint) const { return SectionOf(discs, joint); }
int Robot::SectionOfCable(int cable) const { return SectionOf(cables, cable); }

int Robot::Anchor(int cable) const {
  return std::accumulate(discs.begin(), discs.begin() + SectionOfCable(cable) + 1, 0);
}

double Robot::Thickness(int disc) const { return h[disc == 0 ? 0 : SectionOfJoint(disc - 1)]; }

std::vector<Link> Robot::Links() const {
  std::vector<Link> links;
  double before = 0.5 * h[0];
  for (int section = 0; section < Sections(); ++section) {
    for (int i = 0; i < discs[static_cast<std::size_t>(section)]; ++i) {
      links.push_back({L[section], before, 0.5 * h[section]});
      before = links.back().after;
    }
  }
  return links;
}

double Robot::Place(int disc) const {
  double x = 0;
  int section = 0;
  for (; disc > discs[static_cast<std::size_t>(section)]; ++section) {
    const int count = discs[static_cast<std::size_t>(section)];
    x += count * (L[section] + h[section]);
    disc -= count;
  }
  return x + disc * (L[section] + h[section]) + 0.5 * (h[0] - h[section]);
}

double Robot::LengthOfCable(int cable) const {
  double length = 0;
  for (int section = 0; section <= SectionOfCable(cable); ++section) {
    length += discs[static_cast<std::size_t>(section)] * L[section];
  }
  return length;
}

double Robot::Stiffness(int section) const {
  return rods[section] * E[section] * I_z[section] / L[section];
}

double Robot::RodDiameter(int section) const {
  return std::pow(64 * I_z[section] / std::numbers::pi, 0.25);
}

Robot Robot::Read(const std::filesystem::path& file) {
  const Yaml yaml = Yaml::Read(file);
  yaml.Only({"format", "robot", "discs", "cables", "L", "h", "E", "I_z", "rods", "r", "phi", "m_D",
             "m_NiTi", "rho_cable", "m_CL", "cable_EA", "strain_limit", "friction", "gravity"});
  RequireVersion(yaml);
  Robot robot;
  robot.file = file.string();
  robot.discs = Discs(yaml.At("discs"));
  ReadSections(yaml, robot);
  ReadCables(yaml, robot);
  if (yaml.Has("cable_EA")) robot.cable_EA = Positive(yaml.At("cable_EA"));
  if (yaml.Has("strain_limit")) robot.strain_limit = yaml.At("strain_limit").Parameter(1e-6, 1);
  ReadFriction(yaml.At("friction"), robot);
  const std::vector<Yaml> gravity = List(yaml.At("gravity"), 3, "x, y, z");
  for (int i = 0; i < 3; ++i) robot.gravity[i] = gravity[i].Number();
  return robot;
}

}  // namespace continuum::twin_pivot
