#include "sim/simulation/critical_damping.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "sim/simulation/force_probe.h"

namespace continuum {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kSlowest = 5;  // s; a mode slower than this is a free one

MatrixXd Symmetric(const MatrixXd& A) { return 0.5 * (A + A.transpose()); }

// The slower root of s² + damping s + omega² = 0 as a time constant.
double TimeConstant(double omega, double damping) {
  const double half = 0.5 * damping;
  return 1 / (half > omega ? omega * omega / (half + std::sqrt(half * half - omega * omega))
                           : std::max(half, 0.1 * omega));
}

}  // namespace

CriticalDamping::CriticalDamping(mjModel& m, mjData& d) : damping_(m.nv, m.nv) {
  // From 1 to 2 (rad/s or m/s), forward and back: what dry friction gives cancels, and so does
  // what is even in v.
  ForceProbe at(m, d);
  for (int i = 0; i < m.nv; ++i) {
    damping_.col(i) =
        0.5 * (at.Moving(i, 1) - at.Moving(i, 2) - at.Moving(i, -1) + at.Moving(i, -2));
  }
  damping_ = Symmetric(damping_);
}

void CriticalDamping::Update(mjModel& m, mjData& d) {
  const auto nv = static_cast<int>(m.nv);
  MatrixXd stiffness(nv, nv), mass(nv, nv);
  {
    constexpr double kMove = 1e-6;  // rad or m
    ForceProbe at(m, d);
    for (int i = 0; i < nv; ++i) {
      const VectorXd move = kMove * VectorXd::Unit(nv, i);
      stiffness.col(i) = (at.Moved(-move) - at.Moved(move)) / (2 * kMove);
    }
  }
  mj_forward(&m, &d);
  VectorXd column(nv);
  for (int i = 0; i < nv; ++i) {
    const VectorXd unit = VectorXd::Unit(nv, i);
    mj_mulM(&m, &d, column.data(), unit.data());
    mass.col(i) = column;
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(Symmetric(stiffness),
                                                                 Symmetric(mass));
  const MatrixXd& V = modes.eigenvectors();
  const double h = m.opt.timestep;
  VectorXd lack(nv);
  slowest_ = 0;
  for (int i = 0; i < nv; ++i) {
    const double omega = std::max(std::sqrt(std::abs(modes.eigenvalues()[i])), 1 / kSlowest);
    const double own = V.col(i).dot(damping_ * V.col(i));
    const double turn = std::min(omega * h, 2.0);  // (1); a step at most stops a mode
    lack[i] = std::max(0.0, turn * (2 - turn) / h - own);
    slowest_ = std::max(slowest_, std::min(TimeConstant(omega, own + lack[i]), kSlowest));
  }
  critical_ = mass * V * lack.asDiagonal() * V.transpose() * mass;
}

VectorXd CriticalDamping::Force(const mjData& d) const {
  return -critical_ * VectorXd::Map(d.qvel, critical_.cols());
}

}  // namespace continuum
