#include "models/tdcr/plausible.h"

#include "models/statics/plausible.h"

namespace continuum::tdcr {

void WarnOfImplausibleRobot(const SolveRequest& request, const Yaml& file, const Robot& robot) {
  const auto check = [&](const char* key, double value, double low, double high, const char* unit) {
    statics::WarnIfImplausible(request, file.At(key).Where(), value, low, high, unit);
  };
  check("length", robot.length, 2e-3, 10, "m");
  check("diameter", robot.diameter, 1e-5, std::min(2 * robot.tendon_radius, robot.length / 2), "m");
  check("tendon_radius", robot.tendon_radius, 1e-4, robot.length / 2, "m");
  check("E", robot.E, 1e4, 1e12, "Pa");
  check("density", robot.density, 50, 25e3, "kg/m^3");
  check("disk_mass", robot.disk_mass, 1e-7, 1, "kg");
  check("gravity", robot.gravity.norm(), 0.1, 100, "m/s^2");
  for (const double angle : robot.base_rotation) {
    if (file.Find("base_rotation")) {
      statics::WarnIfDegrees(request, file.At("base_rotation").Where(), angle);
    }
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
    for (int i = 0; i < 3; ++i) {
      check(std::string("f") + "xyz"[i], loads.tip_force[i], 3 * force, "N");
      if (table.Has("gx")) check(std::string("g") + "xyz"[i], loads.gravity[i], 100, "m/s^2");
    }
  }
}

}  // namespace continuum::tdcr
