#include "models/spa/response.h"

#include <fmt/format.h>

#include "error.h"
#include "models/spa/follow_inputs.h"
#include "models/spa/statics.h"

namespace continuum {
namespace {

// Scaled so that one tolerance serves all: δ [mm], rates [mm per 10 ms], work [mJ].
constexpr double kLength = 1e-3, kRate = 0.1, kWork = 1e-3;
using Scaled = std::vector<double>;  // 7

SpaState<double> State(const Scaled& y) {
  return {kLength * Eigen::Vector3d(y[0], y[1], y[2]), kRate * Eigen::Vector3d(y[3], y[4], y[5])};
}

struct Rates {
  const Spa<double>& spa;
  const SpaBaseMotion& base;
  Eigen::Vector3d pressure, input;  // at the beginning of the period
  double begin;

  Eigen::Vector3d Pressure(double t) const {
    Eigen::Vector3d p;
    for (int i = 0; i < 3; ++i) {
      p[i] = SpaLag(pressure[i], input[i], t - begin, spa.parameters().T_PT1);
    }
    return p;
  }

  void operator()(const Scaled& y, Scaled& dy, double t) const {
    const SpaState<double> state = State(y);
    const SpaBase<double> motion = base(t);
    const Eigen::Vector3d p = Pressure(t);
    const Eigen::Vector3d acceleration = spa.Acceleration(state, motion, p);
    const auto wrench = spa.BaseWrench(state, acceleration, motion);
    for (int i = 0; i < 3; ++i) {
      dy[i] = state.rate[i] / kLength;
      dy[3 + i] = acceleration[i] / kRate;
    }
    dy[6] = (wrench.head<3>().dot(motion.velocity) + wrench.tail<3>().dot(motion.angular_velocity) +
             Power(state, p)) /
            kWork;
  }

  double Power(const SpaState<double>& state, const Eigen::Vector3d& p) const {
    const auto& damping = spa.parameters();
    return spa.Actuation(state.delta, p).dot(state.rate) -
           damping.d_theta * state.rate.head<2>().squaredNorm() -
           damping.d_dL * state.rate[2] * state.rate[2];
  }
};

void CheckMotion(const Spa<double>& spa, const Scaled& y, double t) {
  const Eigen::Vector3d delta = State(y).delta;
  const double L0 = spa.parameters().L0;
  if (delta.norm() < 3 * L0 && delta[2] > -L0) return;
  throw Error::Job(
      fmt::format("soft actuator: diverged at t = {:.6g} s, δ = {:.6g}, {:.6g}, {:.6g} m", t,
                  delta[0], delta[1], delta[2]));
}

SpaSample Sample(const Rates& rates, const Scaled& y, double t) {
  const SpaState<double> state = State(y);
  const SpaBase<double> motion = rates.base(t);
  SpaSample sample;
  sample.time = t;
  sample.delta = state.delta;
  sample.rate = state.rate;
  sample.pressure = rates.Pressure(t);
  sample.acceleration = rates.spa.Acceleration(state, motion, sample.pressure);
  sample.wrench = rates.spa.BaseWrench(state, sample.acceleration, motion);
  const auto tip = rates.spa.Tip(state.delta).position;
  sample.tip = {tip[0], tip[1], tip[2]};
  sample.work = kWork * y[6];
  return sample;
}

}  // namespace

SpaStart SpaAtRest(const Spa<double>& spa, const Eigen::Vector3d& pressure,
                   const SpaBase<double>& base) {
  SpaStart start;
  start.state.delta = SpaEquilibrium(spa, pressure, base);
  start.pressure = pressure;
  return start;
}

std::vector<SpaSample> SpaRespond(const Spa<double>& spa, const SpaStart& start,
                                  const std::vector<Eigen::Vector3d>& input, double period,
                                  const SpaBaseMotion& base, double tolerance) {
  Scaled y(7);
  for (int i = 0; i < 3; ++i) {
    y[i] = start.state.delta[i] / kLength;
    y[3 + i] = start.state.rate[i] / kRate;
  }
  std::vector<SpaSample> samples;
  samples.reserve(input.size());
  Rates rates{spa, base, start.pressure, Eigen::Vector3d::Zero(), 0};
  FollowInputs(
      rates, y, input, period, tolerance, [&](double t) { samples.push_back(Sample(rates, y, t)); },
      [&](double t) { CheckMotion(spa, y, t); });
  return samples;
}

}  // namespace continuum
