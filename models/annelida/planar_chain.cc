#include "models/annelida/planar_chain.h"

#include <algorithm>
#include <cmath>

namespace continuum {
namespace {

constexpr int kN = kAnnelidaLinks;
constexpr double kJointBristle = 5e-6;  // [rad]
constexpr double kCableBristle = 1e-6;  // [m]

using Eigen::Vector2d;

// Along the arm at angle φ from hanging, in the plane (x, down), and its derivative.
Vector2d Along(double phi) { return {std::sin(phi), std::cos(phi)}; }
Vector2d Across(double phi) { return {std::cos(phi), -std::sin(phi)}; }

}  // namespace

Eigen::Matrix<double, 2, kN + 2> PlanarChain::Points(const PlanarJoints& q) const {
  Eigen::Matrix<double, 2, kN + 2> points;
  Vector2d at{0, 0};
  double phi = 0;
  for (int i = 0; i < kN + 2; ++i) {
    points.col(i) = Vector2d(at.x(), -at.y());
    if (i > 0 && i <= kN) phi += q[i - 1];
    at += (i == 0 ? p_.b1 : i < kN ? p_.Pitch() : p_.b1 + p_.b2) * Along(phi);
  }
  return points;
}

Vector2d PlanarChain::Tip(const PlanarJoints& q) const { return Points(q).col(kN + 1); }

// Masses at distances along the links: each contributes m JᵀJ to M and m Jᵀ(acceleration at q̈ = 0
// minus gravity) to the bias.
PlanarChain::Equations PlanarChain::At(const PlanarJoints& q, const PlanarJoints& v) const {
  Equations e{Eigen::Matrix<double, kN, kN>::Zero(), PlanarJoints::Zero()};
  Eigen::Matrix<double, 2, kN> joint;  // velocity of link k's joint per unit velocity of joint i
  joint.setZero();
  Vector2d acceleration = p_.gravity * Vector2d(std::sin(tilt_), -std::cos(tilt_));
  double phi = 0, rate = 0;
  const auto add = [&](double mass, double distance, int k) {
    Eigen::Matrix<double, 2, kN> J = joint;
    for (int i = 0; i <= k; ++i) J.col(i) += distance * Across(phi);
    e.M += mass * J.transpose() * J;
    e.bias += mass * J.transpose() * (acceleration - distance * rate * rate * Along(phi));
  };
  for (int k = 0; k < kN; ++k) {
    phi += q[k];
    rate += v[k];
    const bool last = k == kN - 1;
    add(last ? p_.m_last : p_.m, p_.b1 + p_.b2 / 2, k);
    if (last && payload_ > 0) add(payload_, p_.b1 + p_.b2, k);
    e.M.topLeftCorner(k + 1, k + 1).array() += last ? p_.I_last : p_.I;
    for (int i = 0; i <= k; ++i) joint.col(i) += p_.Pitch() * Across(phi);
    acceleration -= p_.Pitch() * rate * rate * Along(phi);
  }
  return e;
}

// The cable's spans shorten toward its own side. A contact before span i slides with everything
// distal of it; disc i − 1 turns the cable by half of either neighbouring joint.
PlanarJoints PlanarChain::CableTorque(PlanarState& state, int cable, double tension,
                                      double h) const {
  const double side = cable == 0 ? 1 : -1;
  PlanarJoints slope;
  for (int i = 0; i < kN; ++i) {
    const double half = state.q[i] / 2;
    slope[i] = -p_.b1 * std::sin(half) - side * p_.a * std::cos(half);
  }
  PlanarJoints torque;
  double T = tension, before = 0;
  for (int i = 0; i < kN; ++i) {
    double slip = 0;
    for (int k = i; k < kN; ++k) slip -= slope[k] * state.v[k];
    double& grip = state.grip[cable][i];
    grip = std::clamp(grip + h * slip, -kCableBristle, kCableBristle);
    const double wrap = (std::abs(before) + std::abs(state.q[i])) / 2;
    T *= std::exp(-p_.mu * wrap * grip / kCableBristle);
    torque[i] = -T * slope[i];
    before = state.q[i];
  }
  return torque;
}

PlanarJoints PlanarChain::Friction(PlanarState& state, double h) const {
  const double stiffness = p_.tau_c * (1 + p_.S) / kJointBristle;
  PlanarJoints torque;
  for (int i = 0; i < kN; ++i) {
    const double ratio = state.v[i] / p_.v_d;
    const double level = p_.tau_c * (1 + p_.S * std::exp(-ratio * ratio));
    const double most = level / stiffness;
    state.bristle[i] = std::clamp(state.bristle[i] + h * state.v[i], -most, most);
    torque[i] = stiffness * state.bristle[i];
  }
  return torque;
}

void PlanarChain::Step(PlanarState& state, const std::array<double, 2>& tension, double h) const {
  const Equations e = At(state.q, state.v);
  PlanarJoints force = -e.bias - p_.K * state.q - p_.tau_mu * state.v;
  if (p_.tau_c > 0) force -= Friction(state, h);
  for (int cable = 0; cable < 2; ++cable) {
    if (tension[cable] > 0) force += CableTorque(state, cable, tension[cable], h);
  }
  state.v += h * e.M.llt().solve(force);
  state.q += h * state.v;
}

double PlanarChain::Energy(const PlanarState& state) const {
  const Equations e = At(state.q, state.v);
  double energy = 0.5 * state.v.dot(e.M * state.v) + 0.5 * p_.K * state.q.squaredNorm();
  const auto points = Points(state.q);
  for (int k = 0; k < kN; ++k) {
    const bool last = k == kN - 1;
    const double length = last ? p_.b1 + p_.b2 : p_.Pitch();
    const double share = (p_.b1 + p_.b2 / 2) / length;
    const double z = (1 - share) * points(1, k + 1) + share * points(1, k + 2);
    energy += (last ? p_.m_last : p_.m) * p_.gravity * z;
  }
  return energy + payload_ * p_.gravity * points(1, kN + 1);
}

}  // namespace continuum
