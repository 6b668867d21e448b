#include "models/tdcr/plausible.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "models/statics/plausible.h"

namespace continuum::tdcr {

namespace {

void WarnOfAngles(const SolveRequest& request, const Yaml& file, const Robot& robot) {
  for (const double angle : robot.tendon_angles) {
    statics::WarnIfDegrees(request, file.At("tendon_angles").Where(), angle);
  }
  if (!file.Find("base_rotation")) return;
  for (const double angle : robot.base_rotation) {
    statics::WarnIfDegrees(request, file.At("base_rotation").Where(), angle);
  }
}

// Between neighbouring disks a tendon is straight; a turn of more than a right angle there is no
// helix.
void WarnOfRoute(const SolveRequest& request, const Yaml& y, const Robot& robot,
                 const Route& route) {
  statics::WarnIfImplausible(request, y.At("radius").Where(), route.radius.front(), 1e-4,
                             robot.length / 2, "m");
  for (std::size_t i = 1; i < route.angle.size(); ++i) {
    const double turn = std::abs(route.angle[i] - route.angle[i - 1]);
    if (turn <= std::numbers::pi / 2) continue;
    return request.warn(fmt::format(
        "{}: a turn of {:.3g} rad between disks {} and {}; is it in degrees? At most 1.57 is "
        "plausible",
        y.At("angle").Where(), turn, i - 1, i));
  }
  if (route.angle.front() == route.angle.back()) {
    statics::WarnIfDegrees(request, y.At("angle").Where(), route.angle.front());
  }
}

void WarnOfSections(const SolveRequest& request, const Yaml& file, const Robot& robot) {
  std::size_t i = 0;
  for (const Yaml& y : file.At("sections").Items()) {
    const Section& section = robot.sections[i++];
    const auto check = [&](const char* key, double value, double low, double high,
                           const char* unit) {
      if (!y.Has(key)) return;
      statics::WarnIfImplausible(request, y.At(key).Where(), value, low, high, unit);
    };
    check("length", section.length(), 1e-3, 10, "m");
    check("diameter", section.diameter, 1e-5, section.length() / 2, "m");
    if (y.Has("E")) check("E", y.At("E").Parameter(), 1e4, 1e12, "Pa");
    if (y.Has("density")) check("density", y.At("density").Parameter(), 50, 25e3, "kg/m^3");
    check("EI", section.EI, 1e-9, 1e4, "N m^2");
    check("GJ", section.GJ, section.EI / 100, 2 * section.EI, "N m^2");
    check("disk_mass", section.disk_mass, 1e-7, 1, "kg");
    check("precurvature", section.natural.norm(), 1e-3, 20 / section.length(), "1/m");
  }
  i = 0;
  for (const Yaml& y : file.At("tendons").Items()) {
    WarnOfRoute(request, y, robot, robot.routes[i++]);
  }
}

}  // namespace

void WarnOfImplausibleRobot(const SolveRequest& request, const Yaml& file, const Robot& robot) {
  statics::WarnIfImplausible(request, file.At("gravity").Where(), robot.gravity.norm(), 0.1, 100,
                             "m/s^2");
  WarnOfAngles(request, file, robot);
  if (file.Has("tendon_EA")) {
    statics::WarnIfImplausible(request, file.At("tendon_EA").Where(), robot.tendon_EA, 1, 1e7, "N");
  }
  if (robot.has_sections()) return WarnOfSections(request, file, robot);
  const auto check = [&](const char* key, double value, double low, double high, const char* unit) {
    statics::WarnIfImplausible(request, file.At(key).Where(), value, low, high, unit);
  };
  check("length", robot.length, 2e-3, 10, "m");
  check("diameter", robot.diameter, 1e-5, std::min(2 * robot.tendon_radius, robot.length / 2), "m");
  check("tendon_radius", robot.tendon_radius, 1e-4, robot.length / 2, "m");
  check("E", robot.E, 1e4, 1e12, "Pa");
  check("density", robot.density, 50, 25e3, "kg/m^3");
  check("disk_mass", robot.disk_mass, 1e-7, 1, "kg");
  if (file.Has("precurvature")) {
    check("precurvature", robot.natural.norm(), 1e-3, 20 / robot.length, "1/m");
  }
}

void WarnOfImplausibleCases(const SolveRequest& request, const CsvTable& table, const Robot& robot,
                            const std::vector<Case>& cases) {
  constexpr double kMostBend = 20;  // rad: three turns
  const double force = kMostBend * robot.moment() / robot.length;
  const double tension = kMostBend * robot.tension();
  for (std::size_t row = 0; row < cases.size(); ++row) {
    const auto check_range = [&](const std::string& column, double value, double low, double high,
                                 const char* unit) {
      statics::WarnIfImplausible(request, table.Where(row) + ", column '" + column + "'", value,
                                 low, high, unit);
    };
    const auto check = [&](const std::string& column, double value, double high, const char* unit) {
      check_range(column, value, 0, high, unit);
    };
    const Loads& loads = cases[row].loads;
    for (std::size_t k = 0; k < loads.tension.size(); ++k) {
      check("T" + std::to_string(k + 1), loads.tension[k], tension, "N");
    }
    for (Eigen::Index k = 0; k < loads.length.size(); ++k) {
      check_range("L" + std::to_string(k + 1), loads.length[k], 0.2 * robot.length,
                  3 * robot.length, "m");
    }
    for (Eigen::Index i = 0; i < loads.disk_force.size(); ++i) {
      const std::string column = std::string("f") + "xyz"[i % 3] + "_" + std::to_string(i / 3 + 1);
      if (table.Has(column)) check(column, loads.disk_force.reshaped()[i], 3 * force, "N");
    }
    for (Eigen::Index i = 0; i < loads.disk_moment.size(); ++i) {
      const std::string column = std::string("m") + "xyz"[i % 3] + "_" + std::to_string(i / 3 + 1);
      if (!table.Has(column)) continue;
      check(column, loads.disk_moment.reshaped()[i], kMostBend * robot.moment(), "N m");
    }
    for (int i = 0; i < 3; ++i) {
      check(std::string("f") + "xyz"[i], loads.tip_force[i], 3 * force, "N");
      const std::string moment = std::string("m") + "xyz"[i];
      if (table.Has(moment)) {
        check(moment, table.Number(row, moment), kMostBend * robot.moment(), "N m");
      }
      if (table.Has("gx")) check(std::string("g") + "xyz"[i], loads.gravity[i], 100, "m/s^2");
    }
  }
}

}  // namespace continuum::tdcr
