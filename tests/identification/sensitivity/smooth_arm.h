#pragma once

#include <cmath>
#include <string>

#include <fmt/format.h>

namespace continuum::testing {

/// Three links with two cables, a lagged motor and a ball joint at the tip: everything that the
/// smooth path has to follow.
inline std::string SmoothArm(const std::string& extension = "", double timestep = 1e-3) {
  std::string bodies, close;
  for (int i = 0; i < 3; ++i) {
    bodies += fmt::format(
        "<body name='link{0}' pos='0 0 {1}'><joint name='x{0}' axis='1 0 0' stiffness='0.8' "
        "damping='0.02' armature='2e-4'/><joint name='y{0}' axis='0 1 0' stiffness='0.6' "
        "damping='0.015'/><inertial pos='0.003 0 -0.05' mass='0.1' diaginertia='1e-4 1.2e-4 4e-5'/>"
        "<site name='a{0}' pos='0.03 0.01 -0.1'/><site name='b{0}' pos='-0.01 0.03 -0.1'/>",
        i, i ? -0.1 : 0);
    close += "</body>";
  }
  return fmt::format(
      "<mujoco><option timestep='{}' integrator='implicitfast'/>{}<worldbody>"
      "<site name='a' pos='0.03 0.01 0'/><site name='b' pos='-0.01 0.03 0'/>{}"
      "<body name='tip' pos='0 0 -0.1'><joint name='ball' type='ball' stiffness='0.2' "
      "damping='0.004'/><inertial pos='0 0.004 -0.03' mass='0.03' diaginertia='4e-5 3e-5 2e-5'/>"
      "<site name='end' pos='0 0 -0.06'/></body>{}</worldbody>"
      "<tendon><spatial name='ta' damping='0.5'><site site='a'/><site site='a0'/><site site='a1'/>"
      "<site site='a2'/></spatial><spatial name='tb' stiffness='20'><site site='b'/>"
      "<site site='b0'/><site site='b1'/></spatial></tendon>"
      "<actuator><general name='pull' tendon='ta' gainprm='-1'/><general name='lagged' joint='y0' "
      "dyntype='filterexact' dynprm='0.04' gainprm='0.3' gear='1.5'/></actuator>"
      "<sensor><jointpos name='x0' joint='x0'/><jointvel name='y2' joint='y2'/>"
      "<framepos name='end' objtype='site' objname='end'/><framequat name='turn' objtype='site' "
      "objname='end'/><tendonpos name='length' tendon='tb'/><gyro name='gyro' site='end'/></sensor>"
      "</mujoco>",
      timestep, extension, bodies, close);
}

/// A log of rows every 10 ms: the cable steps, the motor swings; measured values are zero.
inline std::string SmoothLog(int rows) {
  std::string csv = "time,pull,swing,x0,y2,ex,ey,ez,qw,qx,qy,qz,length,gx\n";
  for (int k = 0; k < rows; ++k) {
    csv += fmt::format("{:.2f},{},{:.6f},0,0,0,0,0,1,0,0,0,0,0\n", 0.01 * k,
                       k < 5    ? 0
                       : k < 35 ? 6
                                : 2,
                       std::sin(0.12 * k));
  }
  return csv;
}

inline const char* const kSmoothExperiment = R"(format: 1
model: model.xml
time: {column: time, unit: s}
start: rest
inputs:
  - {column: pull, unit: N, actuator: pull}
  - {column: swing, unit: "1", actuator: lagged, interpolate: linear}
outputs:
  - {column: x0, unit: rad, sensor: x0, sigma: 0.001}
  - {column: y2, unit: rad/s, sensor: y2, sigma: 0.01}
  - {column: ex, unit: m, sensor: "end[0]", sigma: 0.001}
  - {column: ey, unit: m, sensor: "end[1]", sigma: 0.001}
  - {column: ez, unit: m, sensor: "end[2]", sigma: 0.001}
  - {columns: [qw, qx, qy, qz], sensor: turn, sigma: 0.001}
  - {column: length, unit: m, sensor: length, sigma: 0.001}
  - {column: gx, unit: rad/s, sensor: "gyro[0]", sigma: 0.01}
logs:
  - {file: log.csv, use: train}
)";

}  // namespace continuum::testing
