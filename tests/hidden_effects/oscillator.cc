#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "hidden_effects/robots.h"

namespace continuum::hidden {
namespace {

/// A mass on a spring: position y [m], force u [N] held between rows, restoring force z [N]:
///
///   m y'' + c y' + k y + k3 y³ + z = u
///   z' = α y' − b β (γ |y'| |z|^(ν−1) z + δ y' |z|^ν)
///
/// Classical Runge-Kutta, 24 steps per row.
struct Oscillator {
  double m, c, k, alpha;  // kg, N s/m, N/m, N/m
  double period;          // s
  double k3 = 0;          // N/m³
  double bend = 0;        // b: 1 as published, 0 makes z a linear spring
  double beta = 1e3, gamma = 0.8, delta = -1.1, nu = 1;

  using State = std::array<double, 3>;  // y, y', z

  Columns Run(const Columns& u, int) const {
    constexpr int kSteps = 24;
    const double h = period / kSteps;
    State x{0, 0, 0};
    Columns out(1);
    for (const double force : u[0]) {
      out[0].push_back(x[0]);
      for (int s = 0; s < kSteps; ++s) x = Step(x, force, h);
    }
    return out;
  }

 private:
  static State Along(const State& x, double h, const State& slope) {
    return {x[0] + h * slope[0], x[1] + h * slope[1], x[2] + h * slope[2]};
  }
  State Slope(const State& x, double force) const {
    const auto& [y, v, z] = x;
    const double power = std::pow(std::abs(z), nu);
    const double hysteresis =
        beta * (gamma * std::abs(v) * std::copysign(power, z) + delta * v * power);
    return {v, (force - c * v - k * y - k3 * y * y * y - z) / m, alpha * v - bend * hysteresis};
  }
  State Step(const State& x, double force, double h) const {
    const State a = Slope(x, force), b = Slope(Along(x, h / 2, a), force),
                d = Slope(Along(x, h / 2, b), force), e = Slope(Along(x, h, d), force);
    State next = x;
    for (int i = 0; i < 3; ++i) next[i] += h / 6 * (a[i] + 2 * b[i] + 2 * d[i] + e[i]);
    return next;
  }
};

// The published Bouc-Wen benchmark: values, band and amplitude of its input, rate and noise.
struct BoucWenBenchmark : Oscillator {
  BoucWenBenchmark() : Oscillator{2, 10, 5e4, 5e4, 1.0 / 750} {}
};

// The Silverbox: a resonance near 68 Hz sampled at 610 Hz, lightly damped, whose spring stiffens by
// k3 y² = 3.9 k (y/V)². It is a circuit; here 1 V is 0.1 m and k 1 kN/m, the damping 3 % of
// critical.
constexpr double kSilverboxRate = 1e7 / 16384;  // Hz
struct SilverboxBenchmark : Oscillator {
  SilverboxBenchmark()
      : Oscillator{1000 / (kOmega * kOmega), 2 * 0.03 * 1000 / kOmega, 1000, 0,
                   1 / kSilverboxRate} {}
  static constexpr double kOmega = 2 * std::numbers::pi * 68;
};

// Equal amplitudes from low to high [Hz], random phases, with a root mean square of size [N].
Columns Multisine(double low, double high, double size, std::size_t rows, double period,
                  std::mt19937_64& rng) {
  std::uniform_real_distribution<double> phase(0, 2 * std::numbers::pi);
  std::vector<double> u(rows, 0);
  const double whole = period * static_cast<double>(rows);
  const long first = std::lround(std::ceil(low * whole)), last = std::lround(high * whole);
  const double amplitude = size * std::sqrt(2.0 / static_cast<double>(last - first + 1));
  for (long n = first; n <= last; ++n) {
    const double start = phase(rng),
                 turn = 2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(rows);
    for (std::size_t k = 0; k < rows; ++k)
      u[k] += amplitude * std::sin(turn * static_cast<double>(k) + start);
  }
  return {u};
}

std::string ModelOf(const Oscillator& o) {
  return fmt::format(R"(<mujoco model="oscillator">
  <option timestep="{:.17g}" integrator="RK4" gravity="0 0 0"/>
  <worldbody>
    <body name="mass">
      <joint name="y" type="slide" axis="1 0 0" stiffness="{:.17g}" damping="{:.17g}"/>
      <inertial pos="0 0 0" mass="{:.17g}" diaginertia="1e-3 1e-3 1e-3"/>
    </body>
  </worldbody>
  <actuator>
    <motor name="force" joint="y"/>
  </actuator>
  <sensor>
    <jointpos name="y" joint="y"/>
  </sensor>
</mujoco>
)",
                     o.period / 4, o.k + o.alpha, o.c, o.m);
}

std::string ExperimentOf(const Oscillator& o) {
  const double k = o.k + o.alpha;
  return fmt::format(R"(inputs:
  - {{column: u, unit: N, actuator: force}}
outputs:
  - {{column: y, unit: m, sensor: y}}
parameters:
  - {{name: k, target: "joint:y", attribute: stiffness, initial: {}, lower: {}, upper: {}}}
  - {{name: c, target: "joint:y", attribute: damping, initial: {}, lower: 0, upper: {}}}
)",
                     0.95 * k, 0.1 * k, 10 * k, 1.2 * o.c, 20 * o.c);
}

template <class Plant>
Robot OscillatorRobot(const std::string& name, double low, double high, double force, double sigma,
                      const Part<Plant>& part) {
  const Plant o;
  Robot robot{name, ModelOf(o), ExperimentOf(o), {"u"}, {"y"}, {sigma}, o.period, 1024};
  robot.drive = [=, period = o.period, rows = robot.rows](int, std::mt19937_64& rng) {
    return Multisine(low, high, force, rows, period, rng);
  };
  Equip<Plant>(robot, {part});
  return robot;
}

}  // namespace

Robot SilverboxRobot() {
  return OscillatorRobot<SilverboxBenchmark>(
      "silverbox", 1, 200, 2, 2e-5,
      {{"cubic_stiffness", "k3", 3.9e5}, [](SilverboxBenchmark& o, double v) { o.k3 = v; }});
}

Robot BoucWenRobot() {
  return OscillatorRobot<BoucWenBenchmark>(
      "bouc_wen", 5, 150, 50, 8e-6,
      {{"bouc_wen", "", 1}, [](BoucWenBenchmark& o, double v) { o.bend = v; }});
}

}  // namespace continuum::hidden
