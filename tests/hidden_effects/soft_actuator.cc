#include <cmath>

#include <Eigen/Dense>

#include "hidden_effects/robots.h"
#include "models/spa/chain.h"

namespace continuum::hidden {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPeriod = 0.01;  // s
constexpr int kLinks = 10;        // of the chain that is to explain the arc

const SpaFile& Actuator() {
  static const SpaFile file = [] {
    SpaFile read = ReadSpa(CONTINUUM_SOURCE "/models/spa/spa.yaml");
    read.parameters.T_PT1 = 0;  // an actuator has room for one lag, and that may be hidden
    return read;
  }();
  return file;
}

Vector3d ToEigen(const Vec<double, 3>& v) { return {v[0], v[1], v[2]}; }
Matrix3d ToEigen(const Mat3<double>& m) {
  Matrix3d e;
  for (int i = 0; i < 3; ++i) e.row(i) << m[i][0], m[i][1], m[i][2];
  return e;
}

/// The hanging soft actuator as one arc with its mass on the arc, δ = (Δx, Δy, δL) [m], by the
/// equations of motion of models/spa and what is hidden beside them, without a lag of the chambers;
/// classical Runge-Kutta at 0.5 ms.
struct SoftActuator {
  SpaParameters<double> p = Actuator().parameters;
  double payload = 0, tilt = 0, push = 0;        // kg, rad, N at the tip along x
  double gain = 1, offset = 0, dead_time = 0;    // 1, Pa, s
  double stiffness = 0, viscous = 0, cubic = 0;  // of each joint of the chain, in its units

  Columns Run(const Columns& u, int) const {
    constexpr long kSteps = 20;
    constexpr double h = kPeriod / kSteps;
    const Plant plant(*this);
    const long late = std::lround(dead_time / h);
    SpaState<double> state;
    Vector3d pressure = Vector3d::Zero();
    Columns out(3);
    for (std::size_t row = 0; row < u[0].size(); ++row) {
      const Vector3d tip = plant.base.R_WB * ToEigen(plant.spa.Tip(state.delta).position);
      for (int i = 0; i < 3; ++i) out[i].push_back(tip[i]);
      for (long s = 0; s < kSteps; ++s) {
        Vector3d line, middle, end;
        for (int i = 0; i < 3; ++i) {
          line[i] = gain * Held(u[i], static_cast<long>(row) * kSteps + s, late, kSteps) + offset;
          middle[i] = SpaLag(pressure[i], line[i], h / 2, p.T_PT1);
          end[i] = SpaLag(pressure[i], line[i], h, p.T_PT1);
        }
        plant.Step(state, {pressure, middle, end}, h);
        pressure = end;
      }
    }
    return out;
  }

 private:
  struct Plant {
    explicit Plant(const SoftActuator& a)
        : actuator(a),
          spa(a.WithJoints(), {SpaMass::kArc, SpaActuation::kTip,
                               9.81 * Vector3d(-std::sin(a.tilt), 0, -std::cos(a.tilt))}),
          base(SpaBase<double>::Hanging()) {}

    Vector3d Acceleration(const SpaState<double>& state, const Vector3d& pressure) const {
      Matrix3d inertia = spa.MassMatrix(state.delta).bottomRightCorner<3, 3>();
      Vector3d net = spa.Actuation(state.delta, pressure) -
                     spa.InverseDynamics(state, Vector3d::Zero(), base).tail<3>();
      const auto array = [](const Vector3d& v) { return Vec<double, 3>{v[0], v[1], v[2]}; };
      const auto tip =
          PccCentreLine(spa.parameters().Segment(), 1, array(state.delta), array(state.rate));
      const Matrix3d J = ToEigen(tip.jacobian);
      const Vector3d apparent =
          ToEigen(tip.jacobian_rate) * state.rate - base.R_WB.transpose() * spa.options().gravity;
      inertia += actuator.payload * J.transpose() * J;
      net += J.transpose() *
             (base.R_WB.transpose() * Vector3d(actuator.push, 0, 0) - actuator.payload * apparent);
      return inertia.ldlt().solve(net);
    }

    // Pressures at the step's beginning, middle and end.
    void Step(SpaState<double>& state, const std::array<Vector3d, 3>& pressure, double h) const {
      const auto along = [&](double t, const Vector3d& rate, const Vector3d& acceleration) {
        return SpaState<double>{state.delta + t * rate, state.rate + t * acceleration};
      };
      const Vector3d a = Acceleration(state, pressure[0]);
      const auto second = along(h / 2, state.rate, a);
      const Vector3d b = Acceleration(second, pressure[1]);
      const auto third = along(h / 2, second.rate, b);
      const Vector3d c = Acceleration(third, pressure[1]);
      const auto fourth = along(h, third.rate, c);
      const Vector3d d = Acceleration(fourth, pressure[2]);
      state = along(h / 6, state.rate + 2 * second.rate + 2 * third.rate + fourth.rate,
                    a + 2 * b + 2 * c + d);
    }

    const SoftActuator& actuator;
    Spa<double> spa;
    SpaBase<double> base;
  };

  // What a spring, a damper or a cubic spring at every joint of the chain adds: of N + 1 bends the
  // outer two turn by half of Δ/(d N), and each of N links is δL/N longer.
  SpaParameters<double> WithJoints() const {
    SpaParameters<double> all = p;
    const double n = kLinks, share = 1 / (n * p.d);
    const double squares = (n - 1 + 2 * 0.25) * share * share;
    all.k_theta += squares * stiffness, all.k_dL1 += stiffness / n;
    all.d_theta += squares * viscous, all.d_dL += viscous / n;
    all.k_theta3 += (n - 1 + 2 * 0.0625) * std::pow(share, 4) * cubic;
    all.k_dL3 += cubic / (n * n * n);
    return all;
  }
};

constexpr const char* kExperiment = R"(inputs:
  - {column: p1, unit: Pa, actuator: p1}
  - {column: p2, unit: Pa, actuator: p2}
  - {column: p3, unit: Pa, actuator: p3}
outputs:
  - {column: x, unit: m, sensor: "tip_pos[0]"}
  - {column: y, unit: m, sensor: "tip_pos[1]"}
  - {column: z, unit: m, sensor: "tip_pos[2]"}
parameters:
  - {name: k_dL1, target: "plugin:segment", attribute: k_dL1, initial: 240, lower: 50, upper: 1000}
  - {name: d_dL, target: "plugin:segment", attribute: d_dL, initial: 2, lower: 0, upper: 20}
)";

const std::vector<Part<SoftActuator>> kParts{
    {{"payload", "mass", 0.01}, [](SoftActuator& a, double v) { a.payload = v; }},
    {{"gravity_tilt", "pitch", 0.05}, [](SoftActuator& a, double v) { a.tilt = v; }},
    {{"external_force", "fx", 0.05}, [](SoftActuator& a, double v) { a.push = v; }},
    {{"input_gain", "gain", 0.02, 1}, [](SoftActuator& a, double v) { a.gain = 1 + v; }},
    {{"input_offset", "offset", 1500}, [](SoftActuator& a, double v) { a.offset = v; }},
    {{"dead_time", "delay", 0.005}, [](SoftActuator& a, double v) { a.dead_time = v; }},
    {{"pt1", "T", 0.005}, [](SoftActuator& a, double v) { a.p.T_PT1 = v; }},
    {{"stiffness", "k", 0.15}, [](SoftActuator& a, double v) { a.stiffness = v; }},
    {{"viscous", "b", 0.0006}, [](SoftActuator& a, double v) { a.viscous = v; }},
    {{"chamber_asymmetry", "x_m", 0.001}, [](SoftActuator& a, double v) { a.p.x_m += v; }},
    {{"cubic_stiffness", "k3", 500}, [](SoftActuator& a, double v) { a.cubic = v; }},
};

}  // namespace

Robot SoftActuatorRobot() {
  Robot robot{"spa",           SpaMjcf(Actuator(), {kLinks, 1, 1}),
              kExperiment,     {"p1", "p2", "p3"},
              {"x", "y", "z"}, {3e-4, 3e-4, 3e-4},
              kPeriod,         200};
  robot.drive = [rows = robot.rows](int trial, std::mt19937_64& rng) {
    Columns u;
    for (int i = 0; i < 3; ++i) {
      u.push_back(StepsAndSines(trial, 4e4, rows, kPeriod, rng));
      for (double& p : u.back()) p = std::abs(p);
    }
    return u;
  };
  Equip(robot, kParts);
  return robot;
}

}  // namespace continuum::hidden
