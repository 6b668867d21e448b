#include "models/tdcr/read_sections.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "error.h"
#include "sim/io/decimal.h"

namespace continuum::tdcr {
namespace {

constexpr double kMostLength = 100, kMostStiffness = 1e9, kMostMass = 1e6;
constexpr int kMostDisks = 1000;

double Above0(const Yaml& node, double most) {
  const double value = node.Parameter();
  if (value > 0 && value <= most) return value;
  throw Error::Input(node.Where(), fmt::format("a number above 0, at most {}", Decimal(most)),
                     Decimal(value));
}

double AtLeast0(const Yaml& map, const std::string& key) {
  return map.Has(key) ? map.At(key).Parameter(0, kMostMass) : 0;
}

std::vector<double> Disks(const Yaml& node, double length) {
  std::vector<double> places;
  if (!node.Quantity().IsList()) {
    const double count = node.Parameter();
    if (!(count >= 1 && count <= kMostDisks && count == std::floor(count))) {
      throw Error::Input(node.Where(),
                         fmt::format("1 to {} disks, or a list of places", kMostDisks),
                         Decimal(count));
    }
    for (int i = 1; i <= static_cast<int>(count); ++i) places.push_back(i * length / count);
    return places;
  }
  places = node.Parameters();
  double before = 0;
  for (const double place : places) {
    if (!(place > before)) {
      throw Error::Input(node.Where(), "places that rise from above 0", Decimal(place));
    }
    before = place;
  }
  constexpr double kRounded = 1e-9;
  if (!(std::abs(before - length) <= kRounded * length)) {
    throw Error::Input(node.Where(),
                       "a last disk where the section ends, at " + Decimal(length) + " m",
                       Decimal(before));
  }
  places.back() = length;
  return places;
}

// Stiffness and weight of a rod or tube of one material.
void ReadMaterial(const Yaml& y, Section& section) {
  const double E = Above0(y.At("E"), 1e13), nu = y.At("nu").Parameter();
  if (!(nu > -1 && nu <= 0.5)) {
    throw Error::Input(y.At("nu").Where(), "-1 < nu <= 0.5", Decimal(nu));
  }
  const double d = section.diameter, bore = section.bore;
  section.EI = E * std::numbers::pi / 64 * (std::pow(d, 4) - std::pow(bore, 4));
  section.GJ = section.EI / (1 + nu);
  section.E = E;
  section.mass_per_length = y.At("density").Parameter(0, 1e5) * section.area();
}

void ReadStiffness(const Yaml& y, Section& section) {
  const bool given = y.Has("EI") || y.Has("GJ") || y.Has("mass_per_length");
  const char* const material[] = {"E", "nu", "density"};
  if (!given) return ReadMaterial(y, section);
  for (const char* key : material) {
    if (y.Has(key)) {
      throw Error::Input(y.At(key).Where(),
                         "E, nu and density, or EI, GJ and mass_per_length, not both",
                         y.At(key).Found());
    }
  }
  section.EI = Above0(y.At("EI"), kMostStiffness);
  section.GJ = Above0(y.At("GJ"), kMostStiffness);
  section.mass_per_length = y.At("mass_per_length").Parameter(0, kMostMass);
}

Section ReadSection(const Yaml& y) {
  Section section;
  y.Only({"length", "diameter", "bore", "E", "nu", "density", "EI", "GJ", "mass_per_length",
          "disks", "disk_mass", "disk_radius", "precurvature"});
  const double length = Above0(y.At("length"), kMostLength);
  section.diameter = Above0(y.At("diameter"), length);
  if (y.Has("bore")) section.bore = y.At("bore").Parameter();
  if (!(section.bore >= 0 && section.bore < section.diameter)) {
    throw Error::Input(y.At("bore").Where(),
                       "a bore from 0 to below the diameter, " + Decimal(section.diameter),
                       Decimal(section.bore));
  }
  ReadStiffness(y, section);
  section.disks = Disks(y.At("disks"), length);
  section.disk_mass = AtLeast0(y, "disk_mass");
  if (y.Has("disk_radius")) section.disk_radius = Above0(y.At("disk_radius"), length);
  if (y.Has("precurvature")) {
    const std::vector<double> u = y.At("precurvature").Parameters();
    if (u.size() != 3) {
      throw Error::Input(y.At("precurvature").Where(), "three numbers: kappa_x, kappa_y, tau",
                         std::to_string(u.size()));
    }
    section.natural = {u[0], u[1], u[2]};
  }
  return section;
}

int DiskNumber(const Yaml& node, double value, int disks) {
  if (value >= 0 && value <= disks && value == std::floor(value)) return static_cast<int>(value);
  throw Error::Input(node.Where(), fmt::format("disks from 0 (base) to {}", disks), Decimal(value));
}

/// Reads tendons, given the sections.
class TendonReader {
 public:
  explicit TendonReader(const std::vector<Section>& sections) : sections_(sections) {
    double start = 0;
    for (const Section& section : sections) {
      for (const double disk : section.disks) places_.push_back(start + disk);
      start += section.length();
    }
  }

  Route Read(const Yaml& y) const {
    y.Only({"radius", "angle", "section", "disk", "at"});
    const std::vector<int> at = Knots(y);
    Route route;
    route.radius = Values(y.At("radius"), at);
    route.angle = Values(y.At("angle"), at);
    for (int i = 0; i <= route.end(); ++i) {
      RequireRoom(y.At("radius"), i, route.radius[static_cast<std::size_t>(i)]);
    }
    return route;
  }

 private:
  int disks() const { return static_cast<int>(places_.size()) - 1; }
  double Place(int disk) const { return places_[static_cast<std::size_t>(disk)]; }

  // The disk where the tendon ends; 0: not said.
  int End(const Yaml& y) const {
    if (y.Has("section") && y.Has("disk")) {
      throw Error::Input(y.At("disk").Where(), "either the section or the disk where it ends",
                         "both");
    }
    if (y.Has("disk")) {
      const int disk = DiskNumber(y.At("disk"), y.At("disk").Parameter(), disks());
      if (disk > 0) return disk;
      throw Error::Input(y.At("disk").Where(), "a disk beyond the base, where it begins", "0");
    }
    if (!y.Has("section")) return 0;
    const auto sections = static_cast<int>(sections_.size());
    const int section = y.At("section").Integer();
    if (section < 1 || section > sections) {
      throw Error::Input(y.At("section").Where(), fmt::format("a section from 1 to {}", sections),
                         std::to_string(section));
    }
    int end = 0;
    for (int i = 0; i < section; ++i) {
      end += static_cast<int>(sections_[static_cast<std::size_t>(i)].disks.size());
    }
    return end;
  }

  // Disks at which radius and angle are given, from the base to its end.
  std::vector<int> Knots(const Yaml& y) const {
    const int end = End(y);
    if (!y.Has("at")) return {0, end > 0 ? end : disks()};
    const Yaml node = y.At("at");
    std::vector<int> knots;
    for (const double value : node.Parameters()) {
      const int disk = DiskNumber(node, value, disks());
      if (knots.empty() ? disk != 0 : disk <= knots.back()) {
        throw Error::Input(node.Where(), "disks that rise from 0 (the base)", Decimal(value));
      }
      knots.push_back(disk);
    }
    if (knots.size() < 2) throw Error::Input(node.Where(), "at least two disks", node.Found());
    if (end > 0 && knots.back() != end) {
      throw Error::Input(node.Where(), fmt::format("a last disk where the tendon ends, {}", end),
                         std::to_string(knots.back()));
    }
    return knots;
  }

  // At every disk from 0 on: linear along the rod between the knots.
  std::vector<double> Values(const Yaml& node, const std::vector<int>& at) const {
    std::vector<double> given =
        node.Quantity().IsList() ? node.Parameters() : std::vector<double>{node.Parameter()};
    if (given.size() == 1) given.assign(at.size(), given.front());
    if (given.size() != at.size()) {
      throw Error::Input(node.Where(), fmt::format("one value, or {}", at.size()),
                         std::to_string(given.size()));
    }
    std::vector<double> values{given.front()};
    for (std::size_t i = 1; i < at.size(); ++i) {
      const double from = Place(at[i - 1]), to = Place(at[i]);
      for (int disk = at[i - 1] + 1; disk <= at[i]; ++disk) {
        const double share = disk == at[i] ? 1 : (Place(disk) - from) / (to - from);
        values.push_back(given[i - 1] + share * (given[i] - given[i - 1]));
      }
    }
    return values;
  }

  // Of a tendon at a disk: outside the rod or in its bore, and within the disk.
  void RequireRoom(const Yaml& node, int disk, double radius) const {
    std::size_t i = 0;
    for (int before = disk; i + 1 < sections_.size(); ++i) {
      before -= static_cast<int>(sections_[i].disks.size());
      if (before <= 0) break;
    }
    const Section& section = sections_[i];
    const double rod = section.diameter / 2, bore = section.bore / 2;
    if (!(radius >= rod || (radius >= 0 && radius < bore))) {
      throw Error::Input(node.Where(),
                         fmt::format("a radius outside the rod of {} m radius at disk {}{}",
                                     Decimal(rod), disk, bore > 0 ? ", or in its bore" : ""),
                         Decimal(radius));
    }
    if (section.disk_radius > 0 && !(radius < section.disk_radius)) {
      throw Error::Input(
          node.Where(),
          fmt::format("a radius within disk {} of {} m radius", disk, Decimal(section.disk_radius)),
          Decimal(radius));
    }
  }

  const std::vector<Section>& sections_;
  std::vector<double> places_{0};  ///< of the disks, 0 is the base [m]
};

}  // namespace

std::vector<Section> ReadSections(const Yaml& file) {
  std::vector<Section> sections;
  std::size_t disks = 0;
  for (const Yaml& y : file.At("sections").Items()) {
    sections.push_back(ReadSection(y));
    disks += sections.back().disks.size();
  }
  if (disks >= 1 && disks <= kMostDisks) return sections;
  throw Error::Input(file.At("sections").Where(),
                     fmt::format("sections with 1 to {} disks together", kMostDisks),
                     std::to_string(disks));
}

std::vector<Route> ReadRoutes(const Yaml& file, const std::vector<Section>& sections) {
  const TendonReader reader(sections);
  std::vector<Route> routes;
  bool beside = false;
  for (const Yaml& y : file.At("tendons").Items()) {
    routes.push_back(reader.Read(y));
    for (const double radius : routes.back().radius) beside = beside || radius > 0;
  }
  const Yaml node = file.At("tendons");
  if (routes.empty() || routes.size() > kMaxTendons) {
    throw Error::Input(node.Where(), fmt::format("1 to {} tendons", kMaxTendons),
                       std::to_string(routes.size()));
  }
  if (!beside) throw Error::Input(node.Where(), "a tendon beside the rod's axis", "none");
  return routes;
}

}  // namespace continuum::tdcr
