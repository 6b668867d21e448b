#include <cmath>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "hidden_effects/outside/signals.h"
#include "hidden_effects/robots.h"

namespace continuum::hidden {
namespace {

constexpr int kLinks = 4;                                       // of the chain in the model
constexpr double kLength = 0.12, kArm = 0.05, kChamber = 0.03;  // m: L0, d, r_ch
constexpr double kArea = 1.5e-4, kMass = 0.15;                  // m², kg
constexpr double kBend = 200, kBendDamping = 0.8;               // N/m, kg/s on Δ = d θ
constexpr double kStretch = 1500, kStretchDamping = 6;          // N/m, kg/s

/// A soft segment that hangs and bends in a plane: one arc of angle θ and length L, with its mass
/// spread along it; y = (θ, L − L0).
struct Soft : Outside {
  using Pair = Eigen::Vector2d;
  double payload = 0, off = 0, cubic = 0;          // kg, m, N m/rad³ of each hinge
  double creep = 0, creep_time = 0.5;              // N m/rad of each hinge, s
  double hysteresis = 0, hysteresis_angle = 0.02;  // N m, rad

  Columns Run(const Columns& u, int) const {
    Machine machine(*this);
    return Record(signals, machine, u);
  }

 private:
  struct Machine {
    explicit Machine(const Soft& soft) : p(soft), L0(kLength * soft.longer) {}

    void Step(const std::vector<double>& u, double h) {
      y += h / 2 * rate;
      const Pair force = Force(u);
      crept += (1 - std::exp(-h / p.creep_time)) * (y[0] - crept);
      if (p.hysteresis > 0) {
        const double turn = h * rate[0] / p.hysteresis_angle;
        loop += turn - std::abs(turn) * loop;
      }
      const Eigen::Matrix2d D = Pair(kBendDamping * kArm * kArm, kStretchDamping).asDiagonal();
      const auto [M, bias] = Inertia();
      rate += h * (M + h * D).inverse() * (force - bias - D * rate);
      y += h / 2 * rate;
    }

    std::vector<double> Outputs() const {
      const Pair tip = Place(y, 1);
      return {tip[0], -tip[1]};
    }

    // Aside and down of a point at the share s of the length.
    Pair Place(const Pair& at, double s) const {
      const double a = at[0], L = L0 + at[1];
      if (std::abs(a) < 1e-4) return {L * s * s * a / 2, L * s * (1 - s * s * a * a / 6)};
      return {L / a * (1 - std::cos(s * a)), L / a * std::sin(s * a)};
    }
    Eigen::Matrix2d Slope(const Pair& at, double s) const {
      const double a = at[0], L = L0 + at[1];
      Eigen::Matrix2d J;
      if (std::abs(a) < 1e-4) {
        J << L * s * s / 2, s * s * a / 2, -L * s * s * s * a / 3, s * (1 - s * s * a * a / 6);
        return J;
      }
      const double c = std::cos(s * a), n = std::sin(s * a);
      J << L / a * (s * n - (1 - c) / a), (1 - c) / a, L / a * (s * c - n / a), n / a;
      return J;
    }

   private:
    // Mass matrix, and what speeds and weight ask for.
    std::pair<Eigen::Matrix2d, Pair> Inertia() const {
      constexpr double kSmall = 1e-6;
      constexpr double kPoint[] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                   0.9305681557970263, 1};
      constexpr double kWeight[] = {0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
                                    0.17392742256872692};
      Eigen::Matrix2d M = Eigen::Matrix2d::Zero();
      Pair bias(0, 0);
      for (int i = 0; i < 5; ++i) {
        const double mass = i < 4 ? kWeight[i] * kMass * p.heavier : p.payload;
        if (mass == 0) continue;
        const Eigen::Matrix2d J = Slope(y, kPoint[i]);
        const Eigen::Matrix2d turn =
            (Slope(y + kSmall * rate, kPoint[i]) - Slope(y - kSmall * rate, kPoint[i])) /
            (2 * kSmall);
        M += mass * J.transpose() * J;
        bias += mass * J.transpose() * (turn * rate - Pair(0, 9.81));
      }
      return {M, bias};
    }

    // Of pressures, body and what is hidden.
    Pair Force(const std::vector<double>& pressure) const {
      const double places[] = {-kChamber - p.off, kChamber / 2 - p.off, kChamber / 2 - p.off};
      double push = 0, moment = 0;
      for (int i = 0; i < 3; ++i) {
        push += kArea * pressure[i];
        moment -= kArea * pressure[i] * places[i];
      }
      const double a = y[0], L = L0 + y[1];
      const Pair along(std::sin(a), std::cos(a));  // the arc's end
      const Pair end = Slope(y, 1).transpose() * along * push;
      // Of N + 1 hinges the two at the ends turn by half of a/N.
      constexpr double n = kLinks, squares = (n - 0.5) / (n * n);
      constexpr double fourths = (n - 1 + 0.125) / (n * n * n * n);
      double bend = moment - kBend * kArm * kArm * a - squares * p.creep * (a - crept) -
                    fourths * p.cubic * a * a * a - p.hysteresis * loop;
      return {end[0] + bend, end[1] - kStretch * (L - L0)};
    }

    const Soft& p;
    double L0, crept = 0, loop = 0;
    Pair y = Pair::Zero(), rate = Pair::Zero();
  };
};

// Nodes at k/N of the length with Simpson's weights; hinges share the bend, half of it at the ends.
std::string Model() {
  std::string bodies, ends, equal;
  for (int k = 0; k <= kLinks; ++k) {
    const bool outer = k == 0 || k == kLinks;
    const double mass = kMass / (3 * kLinks) * (outer ? 1 : k % 2 ? 4 : 2);
    bodies += fmt::format(
        "<body name=\"link{0}\" pos=\"0 0 {1}\"><inertial pos=\"0 0 0\" "
        "mass=\"{2}\" diaginertia=\"1e-7 1e-7 1e-7\"/>\n",
        k, k == 0 ? 0 : kLength / kLinks, mass);
    if (k > 0)
      bodies += fmt::format("<joint name=\"stretch{}\" type=\"slide\" axis=\"0 0 1\"/>", k);
    bodies += fmt::format("<joint name=\"bend{}\" axis=\"0 1 0\" armature=\"2.5e-6\"/>\n", k);
    ends += "</body>";
    constexpr const char* kHard = "solref=\"0.0001\" solimp=\"0.9999 0.9999\"";
    if (k != 1) {
      equal +=
          fmt::format("<joint joint1=\"bend{}\" joint2=\"bend1\" polycoef=\"0 {} 0 0 0\" {}/>\n", k,
                      outer ? 0.5 : 1.0, kHard);
    }
    if (k > 1)
      equal += fmt::format("<joint joint1=\"stretch{}\" joint2=\"stretch1\" {}/>\n", k, kHard);
  }
  std::string law;
  const auto key = [&](const char* name, const auto& value) {
    law += fmt::format("<config key=\"{}\" value=\"{}\"/>", name, value);
  };
  key("body", "base link" + std::to_string(kLinks)), key("actuator", "p1 p2 p3");
  key("actuation", "tip"), key("L0", kLength), key("d", kArm), key("r_ch", kChamber);
  key("x_m", 0), key("y_m", 0), key("A", kArea), key("d_theta", kBendDamping);
  key("d_dL", kStretchDamping), key("k_theta", kBend), key("k_theta3", 0);
  key("k_dL1", kStretch), key("k_dL3", 0);
  std::string chambers;
  for (const char* const p : {"p1", "p2", "p3"})
    chambers += fmt::format("<general name=\"{}\" joint=\"stretch1\" gear=\"0\"/>", p);
  return "<mujoco model=\"soft\">\n<extension><plugin plugin=\"continuum.pcc_segment\"><instance "
         "name=\"segment\">" +
         law + "</instance></plugin></extension>\n<compiler angle=\"radian\"/>\n" +
         "<option timestep=\"0.002\" integrator=\"implicitfast\"/>\n<worldbody><body name=\"base\" "
         "quat=\"0 1 0 0\">\n" +
         bodies + "<site name=\"tip\"/>" + ends + "</body></worldbody>\n<equality>\n" + equal +
         "</equality>\n<actuator>" + chambers +
         "</actuator>\n<sensor><framepos name=\"tip\" objtype=\"site\" objname=\"tip\"/></sensor>\n"
         "</mujoco>\n";
}

constexpr const char* kExperiment = R"(inputs:
  - {column: p1, unit: Pa, actuator: p1}
  - {column: p2, unit: Pa, actuator: p2}
  - {column: p3, unit: Pa, actuator: p3}
outputs:
  - {column: x, unit: m, sensor: "tip[0]"}
  - {column: z, unit: m, sensor: "tip[2]"}
parameters:
  - {name: k_theta, target: "plugin:segment", attribute: k_theta, initial: 190, lower: 50, upper: 800}
  - {name: d_theta, target: "plugin:segment", attribute: d_theta, initial: 0.9, lower: 0, upper: 20}
  - {name: k_dL1, target: "plugin:segment", attribute: k_dL1, initial: 1400, lower: 300, upper: 8000}
)";

const std::vector<Part<Soft>> kParts{
    {{"payload", "mass", 0.015, 0, {"link_mass"}}, [](Soft& s, double v) { s.payload = v; }},
    {{"maxwell", "k_m", 0.6}, [](Soft& s, double v) { s.creep = v; }},
    {{"chamber_asymmetry", "x_m", 0.002}, [](Soft& s, double v) { s.off = v; }},
    {{"cubic_stiffness", "k3", 20}, [](Soft& s, double v) { s.cubic = v; }},
    {{"dahl", "f", 0.02}, [](Soft& s, double v) { s.hysteresis = v; }},
    {{"input_gain", "gain", 0.04, 1}, [](Soft& s, double v) { s.signals.gain = 1 + v; }},
    {{"dead_time", "delay", 0.015, 0, {"sensor_delay"}},
     [](Soft& s, double v) { s.signals.dead_time = v; }},
    {{"pt1", "T", 0.02}, [](Soft& s, double v) { s.signals.lag = v; }},
};

}  // namespace

Robot SoftRobot() {
  Robot robot{"soft",     Model(),      kExperiment, {"p1", "p2", "p3"},
              {"x", "z"}, {3e-4, 3e-4}, kRowPeriod};
  robot.trials = 4;
  robot.drive = [rows = robot.rows](int trial, std::mt19937_64& rng) {
    const std::vector<double> bend = StepsAndSines(trial % 3, 5e4, rows, kRowPeriod, rng);
    Columns u(3);
    for (const double b : bend) {
      u[0].push_back(std::max(0.0, b));
      for (int i : {1, 2}) u[i].push_back(std::max(0.0, -b));
    }
    return u;
  };
  EquipOutside(robot, kParts);
  return robot;
}

}  // namespace continuum::hidden
