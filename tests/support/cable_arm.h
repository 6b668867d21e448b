#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace continuum::testing {

/// A chain of light discs with cables along it, as MJCF: sites c<cable>_<k>, k = 0 the lead, 1 the
/// base hole; a motor and a tension sensor at every site for each cable.
struct CableArm {
  int links = 10;
  double mass = 1e-3, mu = 0.3, stiffness = 0.1, damping = 5e-4;
  std::vector<double> bearings{0, 3.14159265358979};  ///< of the cables around the arm [rad]
  bool twisted = false;                               ///< every other joint bends sideways
  double radius = 0.007, pitch = 0.0073;
  std::string law = "exponential";

  std::string Mjcf(const std::string& integrator) const;
};

inline std::string CableArm::Mjcf(const std::string& integrator) const {
  const auto number = [](double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.12g", x);
    return std::string(text);
  };
  std::vector<std::string> paths(bearings.size());
  std::string sensors, motors;
  const auto sites = [&](int k, double z) {
    std::string all;
    for (std::size_t c = 0; c < bearings.size(); ++c) {
      const std::string name = "c" + std::to_string(c) + "_" + std::to_string(k);
      all += "<site name=\"" + name + "\" pos=\"" + number(radius * std::cos(bearings[c])) + " " +
             number(radius * std::sin(bearings[c])) + " " + number(z) + "\"/>";
      paths[c] += "<site site=\"" + name + "\"/>";
      sensors += "<plugin plugin=\"continuum.capstan\" instance=\"i\" objtype=\"site\" objname=\"" +
                 name + "\"/>";
    }
    return all;
  };
  std::string bodies = sites(0, -0.01), close;
  bodies += sites(1, 0);
  const std::string inertia = number(mass * radius * radius / 4);
  for (int i = 0; i < links; ++i) {
    bodies += "<body pos=\"0 0 " + number(i > 0 ? pitch : pitch / 2) + "\"><joint axis=\"" +
              (twisted && i % 2 ? "1 0 0" : "0 1 0") + "\" stiffness=\"" + number(stiffness) +
              "\" damping=\"" + number(damping) + "\"/><inertial pos=\"0 0 " + number(pitch / 2) +
              "\" mass=\"" + number(mass) + "\" diaginertia=\"" + inertia + " " + inertia + " " +
              inertia + "\"/>";
    bodies += sites(i + 2, pitch / 2);
    close += "</body>";
  }
  std::string tendons;
  for (std::size_t c = 0; c < bearings.size(); ++c) {
    const std::string name = "c" + std::to_string(c);
    tendons += "<spatial name=\"" + name + "\">" + paths[c] + "</spatial>";
    motors += "<motor tendon=\"" + name + "\" gear=\"-1\"/>";
  }
  return "<mujoco><option timestep=\"2e-3\" gravity=\"0 0 0\" integrator=\"" + integrator +
         "\"/><extension><plugin plugin=\"continuum.capstan\"><instance name=\"i\"><config "
         "key=\"tendon\" value=\"c*\"/><config key=\"mu\" value=\"" +
         number(mu) + "\"/><config key=\"law\" value=\"" + law +
         "\"/></instance></plugin></extension><worldbody>" + bodies + close +
         "</worldbody><tendon>" + tendons + "</tendon><actuator>" + motors + "</actuator><sensor>" +
         sensors + "</sensor></mujoco>";
}

}  // namespace continuum::testing
