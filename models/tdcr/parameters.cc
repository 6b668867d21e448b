#include "models/tdcr/parameters.h"

#include <algorithm>
#include <iterator>
#include <numbers>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "error.h"

namespace continuum::tdcr {
namespace {

constexpr double kMaxFriction = 0.999, kMostBend = 20;

enum class Owner { kRobot, kSection, kTendon };

struct Kind {
  const char* name;
  Quantity quantity;
  Owner owner;
  int components;
};
constexpr Kind kKinds[] = {{"E", Quantity::kE, Owner::kSection, 1},
                           {"GJ", Quantity::kGJ, Owner::kSection, 1},
                           {"density", Quantity::kDensity, Owner::kSection, 1},
                           {"disk_mass", Quantity::kDiskMass, Owner::kSection, 1},
                           {"precurvature", Quantity::kPrecurvature, Owner::kSection, 3},
                           {"angle", Quantity::kAngle, Owner::kTendon, 1},
                           {"radius", Quantity::kRadius, Owner::kTendon, 1},
                           {"mu", Quantity::kMu, Owner::kRobot, 1},
                           {"base_rotation", Quantity::kBaseRotation, Owner::kRobot, 3}};

// How many the robot has of its owner; 0: one, without a number in its name.
int PartsOf(const Kind& kind, const Robot& robot) {
  if (kind.owner == Owner::kTendon) {
    // All tendons of the paper's segment are at one radius.
    return kind.quantity == Quantity::kRadius && !robot.has_sections() ? 0 : robot.tendons;
  }
  if (kind.owner == Owner::kSection) return static_cast<int>(robot.sections.size());
  return 0;
}

bool Knows(Method method, Quantity quantity) {
  if (quantity == Quantity::kMu) return method != Method::kCrt;
  if (quantity != Quantity::kPrecurvature) return true;
  return method == Method::kCrt || method == Method::kCrtFriction;
}

double MassOf(const Robot& robot, const Unknown& u) {
  const bool disk = u.quantity == Quantity::kDiskMass;
  if (!robot.has_sections()) return disk ? robot.disk_mass : robot.density;
  const Section& section = robot.sections[static_cast<std::size_t>(u.part)];
  return disk ? section.disk_mass : section.mass_per_length;
}

void Add(const Kind& kind, int part, const std::string& name, std::vector<Unknown>& unknowns) {
  for (int i = 0; i < kind.components; ++i) unknowns.push_back({kind.quantity, part, i, name});
}

// Of one name. @returns whether the robot has it.
bool AddNamed(const std::string& name, const Robot& robot, Method method,
              std::vector<Unknown>& unknowns) {
  for (const Kind& kind : kKinds) {
    if (!Knows(method, kind.quantity)) continue;
    const int parts = PartsOf(kind, robot);
    if (name == kind.name) {
      if (parts == 0) Add(kind, 0, name, unknowns);
      for (int i = 0; i < parts; ++i) Add(kind, i, fmt::format("{}_{}", name, i + 1), unknowns);
      return true;
    }
    for (int i = 0; i < parts; ++i) {
      if (name != fmt::format("{}_{}", kind.name, i + 1)) continue;
      Add(kind, i, name, unknowns);
      return true;
    }
  }
  return false;
}

void ChangeSection(const Unknown& u, double x, double length, Section& section) {
  switch (u.quantity) {
    case Quantity::kE:
      section.E *= x;
      section.EI *= x;
      section.GJ *= x;
      break;
    case Quantity::kGJ:
      section.GJ *= x;
      break;
    case Quantity::kDensity:
      section.mass_per_length *= x;
      break;
    case Quantity::kDiskMass:
      section.disk_mass *= x;
      break;
    default:
      section.natural[u.component] = x / length;
  }
}

void ChangeSegment(const Unknown& u, double x, Robot& robot) {
  switch (u.quantity) {
    case Quantity::kE:
      robot.E *= x;
      break;
    case Quantity::kGJ:
      robot.nu = (1 + robot.nu) / x - 1;
      break;
    case Quantity::kDensity:
      robot.density *= x;
      break;
    case Quantity::kDiskMass:
      robot.disk_mass *= x;
      break;
    default:
      robot.natural[u.component] = x / robot.length;
  }
}

void ChangeTendon(const Unknown& u, double x, Robot& robot) {
  const auto k = static_cast<std::size_t>(u.part);
  if (u.quantity == Quantity::kAngle) {
    if (!robot.has_sections()) {
      robot.SpreadTendons();
      robot.tendon_angles[k] += x;
      return;
    }
    for (double& angle : robot.routes[k].angle) angle += x;
  } else if (robot.has_sections()) {
    for (double& radius : robot.routes[k].radius) radius *= x;
  } else {
    robot.tendon_radius *= x;
  }
}

void Change(const Unknown& u, double x, Robot& robot) {
  switch (u.quantity) {
    case Quantity::kMu:
      robot.mu = x;
      break;
    case Quantity::kBaseRotation:
      robot.base_rotation[u.component] = x;
      break;
    case Quantity::kAngle:
    case Quantity::kRadius:
      ChangeTendon(u, x, robot);
      break;
    default:
      if (robot.has_sections()) {
        ChangeSection(u, x, robot.length, robot.sections[static_cast<std::size_t>(u.part)]);
      } else {
        ChangeSegment(u, x, robot);
      }
  }
}

// The smallest ratio of GJ that a material can have: nu = 1/2. Given stiffness may be any.
double LeastTwist(const Robot& robot, const Unknown& u) {
  if (!robot.has_sections()) return (1 + robot.nu) / 1.5;
  const Section& section = robot.sections[static_cast<std::size_t>(u.part)];
  return section.E > 0 ? section.EI / section.GJ / 1.5 : 0.01;
}

struct Range {
  double low, high;
};
Range RangeOf(const Robot& robot, const Unknown& u) {
  constexpr double kPi = std::numbers::pi;
  switch (u.quantity) {
    case Quantity::kE:
      return {0.01, 100};
    case Quantity::kGJ:
      return {LeastTwist(robot, u), 100};
    case Quantity::kDensity:
    case Quantity::kDiskMass:
      return {0, 100};
    case Quantity::kPrecurvature:
      return {-kMostBend, kMostBend};
    case Quantity::kRadius:
      return {0.5, 2};
    case Quantity::kMu:
      return {0, kMaxFriction};
    default:
      return {-kPi, kPi};
  }
}

double Start(const Robot& robot, const Unknown& u) {
  if (u.is_ratio()) return 1;
  if (u.quantity == Quantity::kMu) return robot.mu;
  if (u.quantity == Quantity::kBaseRotation) return robot.base_rotation[u.component];
  if (u.quantity == Quantity::kAngle) return 0;
  const auto part = static_cast<std::size_t>(u.part);
  const Eigen::Vector3d& natural =
      robot.has_sections() ? robot.sections[part].natural : robot.natural;
  return natural[u.component] * robot.length;
}

template <class Of>
Eigen::VectorXd ForAll(const std::vector<Unknown>& unknowns, Of&& of) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(unknowns.size()));
  std::transform(unknowns.begin(), unknowns.end(), x.begin(), of);
  return x;
}

}  // namespace

bool Unknown::is_ratio() const {
  return quantity == Quantity::kE || quantity == Quantity::kGJ || quantity == Quantity::kDensity ||
         quantity == Quantity::kDiskMass || quantity == Quantity::kRadius;
}

std::vector<std::string> ParameterNames(const Robot& robot, Method method) {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) {
    if (!Knows(method, kind.quantity)) continue;
    names.emplace_back(kind.name);
    const int parts = PartsOf(kind, robot);
    if (parts > 0) names.back() += fmt::format(" (or {0}_1 .. {0}_{1})", kind.name, parts);
  }
  return names;
}

std::vector<std::string> DefaultParameters(const Robot&, Method method) {
  std::vector<std::string> names{"E", "base_rotation"};
  if (Knows(method, Quantity::kMu)) names.emplace_back("mu");
  return names;
}

std::vector<Unknown> ParseUnknowns(const std::vector<std::string>& names, const Robot& robot,
                                   Method method, const std::string& where) {
  std::vector<Unknown> unknowns;
  for (const std::string& name : names) {
    if (AddNamed(name, robot, method, unknowns)) continue;
    throw Error::Input(where,
                       fmt::format("one of {}", fmt::join(ParameterNames(robot, method), ", ")),
                       "'" + name + "'");
  }
  if (unknowns.empty()) throw Error::Input(where, "at least one parameter", "none");
  std::set<std::string> seen;
  for (const Unknown& u : unknowns) {
    if (!seen.insert(fmt::format("{}.{}", u.name, u.component)).second) {
      throw Error::Input(where, "every parameter once", "'" + u.name + "' again");
    }
    const bool mass = u.quantity == Quantity::kDensity || u.quantity == Quantity::kDiskMass;
    if (mass && !(MassOf(robot, u) > 0)) {
      throw Error::Input(where, "a " + u.name + " above 0 in the robot's file to begin with", "0");
    }
  }
  return unknowns;
}

Eigen::VectorXd StartOf(const std::vector<Unknown>& unknowns, const Robot& nominal) {
  return ForAll(unknowns, [&](const Unknown& u) { return Start(nominal, u); });
}

Eigen::VectorXd LowestOf(const std::vector<Unknown>& unknowns, const Robot& nominal) {
  return ForAll(unknowns, [&](const Unknown& u) { return RangeOf(nominal, u).low; });
}

Eigen::VectorXd HighestOf(const std::vector<Unknown>& unknowns, const Robot& nominal) {
  return ForAll(unknowns, [&](const Unknown& u) { return RangeOf(nominal, u).high; });
}

double UnitOf(const Unknown& u, const Robot& nominal) {
  const auto sections = nominal.Sections();
  const Section& section = sections[static_cast<std::size_t>(u.part) % sections.size()];
  switch (u.quantity) {
    case Quantity::kE:
      return section.E > 0 ? section.E : section.EI;
    case Quantity::kGJ:
      return section.GJ;
    case Quantity::kDensity:
      return section.E > 0 ? section.mass_per_length / section.area() : section.mass_per_length;
    case Quantity::kDiskMass:
      return section.disk_mass;
    case Quantity::kPrecurvature:
      return 1 / nominal.length;
    case Quantity::kRadius:
      return nominal.RouteOf(u.part).radius.front();
    default:
      return 1;
  }
}

Robot Changed(const Robot& nominal, const std::vector<Unknown>& unknowns,
              const Eigen::VectorXd& x) {
  Robot robot = nominal;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    Change(unknowns[i], x[static_cast<Eigen::Index>(i)], robot);
  }
  return robot;
}

}  // namespace continuum::tdcr
