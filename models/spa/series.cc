#include "models/spa/series.h"

#include <ceres/jet.h>
#include <fmt/format.h>

#include "error.h"
#include "models/spa/follow_inputs.h"
#include "sim/numerics/decompositions.h"

namespace continuum {
namespace {

using Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Matrix3d Rows(const Mat3<double>& m) {
  Matrix3d e;
  for (int i = 0; i < 3; ++i) e.row(i) << m[i][0], m[i][1], m[i][2];
  return e;
}

Vec<double, 3> Array(const Vector3d& v) { return {v[0], v[1], v[2]}; }

// Pose of a tip, how it moves with δ, and the rates of that.
struct Tip {
  Vector3d p;
  Matrix3d R, J, J_rate, W, W_rate;
};

Tip TipOf(const Spa<double>& spa, const Vector3d& delta, const Vector3d& rate) {
  using Dual = ceres::Jet<double, 1>;
  const auto segment = spa.parameters().Segment();
  const PccPoint<double> point = PccCentreLine(segment, 1, Array(delta), Array(rate));
  const PccSegment<Dual> dual{Dual(segment.L0), Dual(segment.d)};
  Vec<Dual, 3> moving;
  for (std::size_t i = 0; i < 3; ++i) {
    moving[i] = Dual(delta[static_cast<Eigen::Index>(i)]);
    moving[i].v[0] = rate[static_cast<Eigen::Index>(i)];
  }
  const PccTip<Dual> pose = PccTipPose(dual, moving);
  Tip tip;
  tip.p = Eigen::Map<const Vector3d>(point.position.data());
  tip.J = Rows(point.jacobian), tip.J_rate = Rows(point.jacobian_rate);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      tip.R(i, j) = pose.rotation[i][j].a;
      tip.W(i, j) = pose.turning[i][j].a;
      tip.W_rate(i, j) = pose.turning[i][j].v[0];
    }
  }
  return tip;
}

SpaBase<double> Carried(const SpaBase<double>& base, const Tip& tip, const Vector3d& rate,
                        const Vector3d& acceleration) {
  const Vector3d& omega = base.angular_velocity;
  const Vector3d relative = tip.J * rate, turning = tip.W * rate;
  const Matrix3d back = tip.R.transpose();
  SpaBase<double> next;
  next.R_WB = base.R_WB * tip.R;
  next.p_WB = base.p_WB + base.R_WB * tip.p;
  next.angular_velocity = back * omega + turning;
  next.angular_acceleration = back * base.angular_acceleration + tip.W * acceleration +
                              tip.W_rate * rate - turning.cross(Vector3d(back * omega));
  next.velocity = back * (base.velocity + omega.cross(tip.p) + relative);
  next.acceleration = back * (base.acceleration + base.angular_acceleration.cross(tip.p) +
                              omega.cross(Vector3d(omega.cross(tip.p) + 2 * relative)) +
                              tip.J * acceleration + tip.J_rate * rate);
  return next;
}

}  // namespace

SpaSeries::SpaSeries(const Spa<double>& segment, int segments)
    : segment_(segment), segments_(segments) {
  if (segments >= 1) return;
  throw Error::Input("soft actuator: segments", "at least one", std::to_string(segments));
}

std::vector<SpaBase<double>> SpaSeries::Bases(const VectorXd& delta, const VectorXd& rate,
                                              const VectorXd& acceleration,
                                              const SpaBase<double>& base) const {
  std::vector<SpaBase<double>> bases{base};
  for (int k = 0; k < segments_; ++k) {
    const Vector3d v = rate.segment<3>(3 * k);
    bases.push_back(Carried(bases.back(), TipOf(segment_, delta.segment<3>(3 * k), v), v,
                            acceleration.segment<3>(3 * k)));
  }
  return bases;
}

VectorXd SpaSeries::InverseDynamics(const VectorXd& delta, const VectorXd& rate,
                                    const VectorXd& acceleration, const SpaBase<double>& base,
                                    Vector6* wrench) const {
  const auto bases = Bases(delta, rate, acceleration, base);
  VectorXd forces(3 * segments_);
  Vector6 above = Vector6::Zero();  // what the base of the next segment needs, in its axes
  for (int k = segments_ - 1; k >= 0; --k) {
    const SpaState<double> state{delta.segment<3>(3 * k), rate.segment<3>(3 * k)};
    const auto own = segment_.InverseDynamics(state, acceleration.segment<3>(3 * k),
                                              bases[static_cast<std::size_t>(k)]);
    const Tip tip = TipOf(segment_, state.delta, state.rate);
    const Vector3d force = tip.R * above.head<3>(), torque = tip.R * above.tail<3>();
    forces.segment<3>(3 * k) =
        own.tail<3>() + tip.J.transpose() * force + tip.W.transpose() * above.tail<3>();
    above.head<3>() = own.head<3>() + force;
    above.tail<3>() = own.segment<3>(3) + torque + tip.p.cross(force);
  }
  if (wrench) *wrench = above;
  return forces;
}

VectorXd SpaSeries::Actuation(const VectorXd& delta, const VectorXd& pressure) const {
  VectorXd forces(3 * segments_);
  for (int k = 0; k < segments_; ++k) {
    forces.segment<3>(3 * k) =
        segment_.Actuation(delta.segment<3>(3 * k), pressure.segment<3>(3 * k));
  }
  return forces;
}

VectorXd SpaSeries::Acceleration(const VectorXd& delta, const VectorXd& rate,
                                 const SpaBase<double>& base, const VectorXd& pressure) const {
  const Eigen::Index n = 3 * segments_;
  const VectorXd none = VectorXd::Zero(n);
  const VectorXd bias = InverseDynamics(delta, rate, none, base);
  MatrixXd mass(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    mass.col(i) = InverseDynamics(delta, rate, VectorXd::Unit(n, i), base) - bias;
  }
  return mass.llt().solve(Actuation(delta, pressure) - bias);
}

SpaEnergy<double> SpaSeries::Energy(const VectorXd& delta, const VectorXd& rate,
                                    const SpaBase<double>& base) const {
  const auto bases = Bases(delta, rate, VectorXd::Zero(3 * segments_), base);
  SpaEnergy<double> sum{0, 0, 0};
  for (int k = 0; k < segments_; ++k) {
    const auto one = segment_.Energy({delta.segment<3>(3 * k), rate.segment<3>(3 * k)},
                                     bases[static_cast<std::size_t>(k)]);
    sum.kinetic += one.kinetic, sum.gravity += one.gravity, sum.elastic += one.elastic;
  }
  return sum;
}

namespace {

// Forces out of balance at rest, by δ, under a share of pressures and weight; and their slope.
struct Balance {
  const SpaSeries& series;
  const VectorXd& pressure;
  const SpaBase<double>& base;
  double share;

  VectorXd At(const VectorXd& delta) const {
    SpaBase<double> rest;
    rest.R_WB = base.R_WB;
    // Lighter by an acceleration of the base downwards.
    rest.acceleration = (1 - share) * (base.R_WB.transpose() * series.segment().options().gravity);
    const VectorXd none = VectorXd::Zero(delta.size());
    return series.InverseDynamics(delta, none, none, rest) -
           series.Actuation(delta, share * pressure);
  }
  MatrixXd Slope(const VectorXd& delta) const {
    const double step = 1e-6 * series.segment().parameters().L0;
    MatrixXd slope(delta.size(), delta.size());
    for (Eigen::Index i = 0; i < delta.size(); ++i) {
      const VectorXd by = step * VectorXd::Unit(delta.size(), i);
      slope.col(i) = (At(delta + by) - At(delta - by)) / (2 * step);
    }
    return slope;
  }
};

// As statics.cc: stable where the symmetric part is definite.
bool Holds(const MatrixXd& slope) {
  return MatrixXd(0.5 * (slope + slope.transpose())).llt().info() == Eigen::Success;
}

// Newton's method from x, false where it leaves the neighbourhood or ends at a saddle.
bool Settle(const Balance& balance, VectorXd& x) {
  const double length = balance.series.segment().parameters().L0;
  const VectorXd start = x;
  for (int i = 0; i < 30; ++i) {
    const MatrixXd slope = balance.Slope(x);
    if (!Holds(slope)) return false;
    const VectorXd step = slope.partialPivLu().solve(balance.At(x));
    x -= step;
    if (!((x - start).norm() < 0.2 * length)) return false;
    if (step.norm() < 1e-12 * length) return true;
  }
  return false;
}

}  // namespace

VectorXd SpaSeriesEquilibrium(const SpaSeries& series, const VectorXd& pressure,
                              const SpaBase<double>& base) {
  constexpr double kLeast = 1e-5;
  VectorXd delta = VectorXd::Zero(3 * series.segments());
  double share = 0, step = 0.1;
  while (share < 1) {
    const double next = std::min(1.0, share + step);
    VectorXd trial = delta;
    if (Settle({series, pressure, base, next}, trial)) {
      delta = trial, share = next, step *= 1.5;
    } else if ((step /= 2) < kLeast) {
      throw Error::Job(fmt::format(
          "soft actuators on end: no stable equilibrium beyond {:.4g} of weight and pressure",
          share));
    }
  }
  return delta;
}

namespace {

// Scaled as in response.cc: δ [mm], rates [mm per 10 ms].
constexpr double kLength = 1e-3, kRate = 0.1;
using Scaled = std::vector<double>;

struct Motion {
  VectorXd delta, rate;
};

Motion MotionOf(const Scaled& y) {
  const auto n = static_cast<Eigen::Index>(y.size() / 2);
  const Eigen::Map<const VectorXd> all(y.data(), 2 * n);
  return {kLength * all.head(n), kRate * all.tail(n)};
}

struct Rates {
  const SpaSeries& series;
  const SpaBaseMotion& base;
  VectorXd pressure, input;  // at the beginning of the period
  double begin;

  VectorXd Pressure(double t) const {
    VectorXd p(pressure.size());
    for (Eigen::Index i = 0; i < p.size(); ++i) {
      p[i] = SpaLag(pressure[i], input[i], t - begin, series.segment().parameters().T_PT1);
    }
    return p;
  }
  void operator()(const Scaled& y, Scaled& dy, double t) const {
    const auto [delta, rate] = MotionOf(y);
    const VectorXd acceleration = series.Acceleration(delta, rate, base(t), Pressure(t));
    Eigen::Map<VectorXd> slope(dy.data(), 2 * delta.size());
    slope << rate / kLength, acceleration / kRate;
  }
};

SpaSeriesSample Sample(const Rates& rates, const Scaled& y, double t) {
  const auto [delta, rate] = MotionOf(y);
  const SpaBase<double> base = rates.base(t);
  SpaSeriesSample sample{t, delta, rate, Vector6::Zero(), Vector3d::Zero()};
  const VectorXd acceleration = rates.series.Acceleration(delta, rate, base, rates.Pressure(t));
  rates.series.InverseDynamics(delta, rate, acceleration, base, &sample.wrench);
  const auto bases = rates.series.Bases(delta, rate, acceleration, base);
  sample.tip = base.R_WB.transpose() * (bases.back().p_WB - base.p_WB);
  return sample;
}

}  // namespace

std::vector<SpaSeriesSample> SpaSeriesRespond(const SpaSeries& series,
                                              const std::vector<VectorXd>& input, double period,
                                              const SpaBaseMotion& base, double tolerance) {
  const double length = series.segment().parameters().L0;
  const Eigen::Index n = 3 * series.segments();
  Scaled y(2 * static_cast<std::size_t>(n));
  std::vector<SpaSeriesSample> samples;
  Rates rates{series, base, VectorXd::Zero(n), VectorXd::Zero(n), 0};
  const auto check = [&](double t) {
    if (MotionOf(y).delta.cwiseAbs().maxCoeff() < 3 * length) return;
    throw Error::Job(fmt::format("soft actuators on end: diverged at t = {:.6g} s", t));
  };
  FollowInputs(
      rates, y, input, period, tolerance, [&](double t) { samples.push_back(Sample(rates, y, t)); },
      check);
  return samples;
}

}  // namespace continuum
