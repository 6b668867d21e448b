#include "models/twin_pivot/plausible.h"

#include <string>

#include "models/statics/plausible.h"
#include "sim/io/yaml.h"

namespace continuum::twin_pivot {

void WarnOfImplausibleRobot(const SolveRequest& request, const Robot& robot) {
  const Yaml file = Yaml::Read(request.robot);
  const auto check = [&](const char* key, double value, double low, double high, const char* unit) {
    statics::WarnIfImplausible(request, file.At(key).Where(), value, low, high, unit);
  };
  const auto each = [&](const char* key, const PerSection& values, double low, double high,
                        const char* unit) {
    for (const double value : values.values()) check(key, value, low, high, unit);
  };
  const double pitch = robot.L[0] + robot.h[0];
  each("L", robot.L, 1e-4, 0.5, "m");
  each("h", robot.h, 1e-5, 0.5, "m");
  each("E", robot.E, 1e6, 1e12, "Pa");
  each("I_z", robot.I_z, 1e-20, 1e-6, "m^4");
  each("m_D", robot.m_D, 1e-7, 5, "kg");
  each("m_NiTi", robot.m_NiTi, 1e-8, 5, "kg");
  each("rho_cable", robot.rho_cable, 1e-7, 5, "kg/m");
  each("m_CL", robot.m_CL, 1e-8, 5, "kg");
  check("gravity", robot.gravity.norm(), 0.1, 100, "m/s^2");
  for (const double r : robot.r) check("r", r, pitch / 100, 5 * pitch, "m");
  for (const double phi : robot.phi) {
    statics::WarnIfDegrees(request, file.At("phi").Where(), phi);
  }
}

namespace {

// A tension is judged by the angle that it alone would bend a joint by, a length by the straight
// robot's.
void WarnOfImplausibleCables(const SolveRequest& request, const Robot& robot,
                             const std::vector<Case>& cases) {
  constexpr double kMostBend = 3;  // rad in one joint
  for (const Case& row : cases) {
    for (int j = 0; j < robot.Cables(); ++j) {
      const auto check = [&](double value, double low, double high, const char* unit) {
        const std::string cable = "', cable " + std::to_string(j + 1);
        statics::WarnIfImplausible(request, request.input.string() + ": case '" + row.label + cable,
                                   value, low, high, unit);
      };
      const auto at = static_cast<std::size_t>(j);
      check(row.load.tension[at], 0, kMostBend * robot.Stiffness() / robot.r[at], "N");
      const double straight = robot.LengthOfCable(j);
      if (row.load.length.size() > 0) check(row.load.length[j], 0.2 * straight, 3 * straight, "m");
    }
  }
}

// Dead loads are judged by the angle that they alone, across the straight robot, would bend it by.
void WarnOfImplausibleLoads(const SolveRequest& request, const Robot& robot,
                            const std::vector<Case>& cases) {
  constexpr double kMostBend = 20;  // rad: three turns
  const double moment = kMostBend * robot.Stiffness() / (0.5 * robot.Joints());
  const double force = moment / robot.Length();
  for (const Case& row : cases) {
    const auto check = [&](const std::string& what, double value, double most, const char* unit) {
      const std::string where = request.input.string() + ": case '" + row.label + "', " + what;
      statics::WarnIfImplausible(request, where, value, 0, most, unit);
    };
    const Load& load = row.load;
    check("payload", load.payload, force / 9.81, "kg");
    check("force", load.force.norm(), force, "N");
    check("moment", load.moment.norm(), moment, "N m");
    check("gravity", load.gravity.norm(), 100, "m/s^2");
    for (const DiscLoad& at : load.on_discs) {
      const std::string disc = " on disc " + std::to_string(at.disc);
      check("force" + disc, at.force.norm(), force, "N");
      check("moment" + disc, at.moment.norm(), moment, "N m");
    }
    for (const double mass : load.disc_payload) {
      check("payload on a disc", mass, force / 9.81, "kg");
    }
  }
}

}  // namespace

void WarnOfImplausibleCases(const SolveRequest& request, const Robot& robot,
                            const std::vector<Case>& cases) {
  WarnOfImplausibleCables(request, robot, cases);
  WarnOfImplausibleLoads(request, robot, cases);
}

}  // namespace continuum::twin_pivot
