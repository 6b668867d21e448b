#pragma once

#include <cmath>

#include <Eigen/Dense>

#include "hidden_effects/outside/dry_friction.h"

namespace continuum::hidden {

/// N joints with dry friction, integrated by position Verlet; damping, tanh and bristles are
/// implicit in the speed, and impulses stop a joint exactly.
template <int N>
struct Joints {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  Vector q = Vector::Zero(), v = Vector::Zero();
  Vector bristle = Vector::Zero();  ///< rad or m, within ±kGive
  std::array<DryFriction, N> friction = {};
  Law law = Law::kStick;

  /// Speeds a step later, by M v̇ + D v = torque − friction; load: that each joint's friction grows
  /// with. The caller moves q by half a step before and after.
  void Push(const Matrix& M, const Vector& torque, const Vector& damping, const Vector& load,
            double h) {
    Vector D = damping, level, push = torque;
    for (int j = 0; j < N; ++j) {
      level[j] = friction[j].Level(v[j], load[j]);
      if (law == Law::kTanh) AddTanh(j, level[j], D, push);
      if (law == Law::kBristles) AddBristle(j, level[j], h, D, push);
    }
    push -= damping.cwiseProduct(v);
    Matrix A = M;
    A.diagonal() += h * D;
    const Matrix inverse = A.inverse();
    v += h * inverse * push;
    if (law == Law::kStick) Stick(inverse, h * level);
    for (int j = 0; j < N; ++j) {
      if (law == Law::kBristles)
        bristle[j] = level[j] > 0 ? std::clamp(bristle[j] + h * v[j], -kGive, kGive) : 0;
    }
  }

 private:
  void AddTanh(int j, double level, Vector& D, Vector& push) const {
    const double x = v[j] / kTanhSpeed, c = std::cosh(std::min(std::abs(x), 300.0));
    push[j] -= level * std::tanh(x);
    D[j] += level / kTanhSpeed / (c * c);
  }

  // A spring of stiffness level/kGive with a little damping, as long as it does not slide.
  void AddBristle(int j, double level, double h, Vector& D, Vector& push) const {
    constexpr double kSettling = 5e-4;  // s, of damping over stiffness
    const double stiffness = level / kGive;
    push[j] -= stiffness * bristle[j];
    if (std::abs(bristle[j] + h * v[j]) >= kGive) return;
    const double d = (kSettling + h) * stiffness;
    push[j] -= d * v[j];
    D[j] += d;
  }

  // Projected Gauss-Seidel over the impulses that oppose each joint's motion.
  void Stick(const Matrix& inverse, const Vector& most) {
    if (most.isZero(0)) return;
    const Vector free = v;
    Vector p = Vector::Zero();
    for (int iteration = 0; iteration < 40; ++iteration) {
      double moved = 0;
      for (int j = 0; j < N; ++j) {
        const double now = free[j] + inverse.row(j).dot(p);
        const double next = std::clamp(p[j] - now / inverse(j, j), -most[j], most[j]);
        moved = std::max(moved, std::abs(next - p[j]) * inverse(j, j));
        p[j] = next;
      }
      if (moved < 1e-12) break;
    }
    v = free + inverse * p;
  }
};

}  // namespace continuum::hidden
