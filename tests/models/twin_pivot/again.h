#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "models/twin_pivot/twin_pivot.h"

/// The robot again, from transforms as the paper writes them and without recursion.
namespace continuum::twin_pivot::again {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::VectorXd;

inline Matrix4d Along(double x) {
  Matrix4d t = Matrix4d::Identity();
  t(0, 3) = x;
  return t;
}

inline Matrix4d Turn(double angle, const Vector3d& axis) {
  Matrix4d t = Matrix4d::Identity();
  t.topLeftCorner<3, 3>() = Eigen::AngleAxisd(angle, axis).matrix();
  return t;
}

// Section of disc m, counted by its discs; the fixed disc is of the first one.
inline int SectionOfDisc(const Robot& robot, int m) {
  int section = 0;
  for (int last = robot.discs[0]; m > last; last += robot.discs[++section]) continue;
  return section;
}

// Discs 0..n; no angle may be 0.
inline std::vector<Matrix4d> Discs(const Robot& robot, const VectorXd& beta) {
  std::vector<Matrix4d> disc = {Matrix4d::Identity()};
  for (int m = 1; m <= beta.size(); ++m) {
    const double b = beta[m - 1];
    const int section = SectionOfDisc(robot, m);
    const double t = robot.L[section] / b * std::tan(b / 2);
    disc.push_back(disc.back() * Along(t + robot.h[SectionOfDisc(robot, m - 1)] / 2) *
                   Turn(b, Vector3d::UnitZ()) * Turn(m % 2 ? M_PI_2 : -M_PI_2, Vector3d::UnitX()) *
                   Along(t + robot.h[section] / 2));
  }
  return disc;
}

inline Vector3d At(const Matrix4d& frame, const Vector3d& p) {
  return (frame * p.homogeneous()).head<3>();
}

inline Vector3d Hole(const Robot& robot, const std::vector<Matrix4d>& disc, int m, int j,
                     bool distal) {
  const double y = robot.r[j] * std::cos(robot.phi[j]);
  const double z = robot.r[j] * std::sin(robot.phi[j]);
  const double x = (distal ? 0.5 : -0.5) * robot.h[SectionOfDisc(robot, m)];
  return At(disc[m], m % 2 ? Vector3d(x, z, -y) : Vector3d(x, y, z));
}

inline double CableLength(const Robot& robot, const std::vector<Matrix4d>& disc, int m, int j) {
  return (Hole(robot, disc, m, j, false) - Hole(robot, disc, m - 1, j, true)).norm();
}

struct Body {
  int joint;  ///< the last joint (counted from 1) that moves it
  double mass;
  Vector3d place;
};

inline std::vector<Body> Bodies(const Robot& robot, const VectorXd& beta) {
  const std::vector<Matrix4d> disc = Discs(robot, beta);
  std::vector<Body> bodies;
  for (int m = 1; m <= beta.size(); ++m) {
    const double b = beta[m - 1];
    const int section = SectionOfDisc(robot, m);
    const double L = robot.L[section], half = robot.h[SectionOfDisc(robot, m - 1)] / 2;
    const Vector3d centroid(half + L * (1 - std::cos(b)) / (b * b), L * (b - std::sin(b)) / (b * b),
                            0);
    bodies.push_back({m, robot.m_NiTi[section], At(disc[m - 1], centroid)});
    bodies.push_back({m, robot.m_D[section], disc[m].topRightCorner<3, 1>()});
    for (int j = 0; j < robot.Cables(); ++j) {
      if (m > robot.Anchor(j)) continue;
      const Vector3d from = Hole(robot, disc, m - 1, j, true);
      const Vector3d to = Hole(robot, disc, m, j, false);
      const int end = SectionOfDisc(robot, robot.Anchor(j));
      bodies.push_back({m, robot.rho_cable[end] * (to - from).norm(), 0.5 * (from + to)});
      if (m != robot.Anchor(j)) continue;
      bodies.push_back({m, robot.m_CL[end], Hole(robot, disc, m, j, true)});
    }
  }
  return bodies;
}

// Elastic energy, work of the cables, of weights (given, not following the cables' lengths), of the
// payload and of a force at the tip.
inline double Energy(const Robot& robot, const Load& load, const VectorXd& beta,
                     const std::vector<Body>& weights) {
  const std::vector<Matrix4d> disc = Discs(robot, beta);
  double energy = 0;
  for (int m = 1; m <= beta.size(); ++m) {
    const int s = SectionOfDisc(robot, m);
    const double k = robot.rods[s] * robot.E[s] * robot.I_z[s] / robot.L[s];
    energy += 0.5 * k * beta[m - 1] * beta[m - 1];
  }
  for (int j = 0; j < robot.Cables(); ++j) {
    for (int m = 1; m <= robot.Anchor(j); ++m) {
      energy += load.tension[j] * CableLength(robot, disc, m, j);
    }
  }
  const std::vector<Body> now = Bodies(robot, beta);
  for (std::size_t i = 0; i < now.size(); ++i) {
    energy -= weights[i].mass * load.gravity.dot(now[i].place);
  }
  for (const DiscLoad& on_disc : load.on_discs) {
    energy -= on_disc.force.dot(disc[on_disc.disc].topRightCorner<3, 1>());
  }
  for (int m = 1; m <= load.disc_payload.size(); ++m) {
    energy -= load.disc_payload[m - 1] * load.gravity.dot(disc[m].topRightCorner<3, 1>());
  }
  const Vector3d tip = disc.back().topRightCorner<3, 1>();
  return energy - tip.dot(load.force + load.payload * load.gravity);
}

inline VectorXd EnergySlope(const Robot& robot, const Load& load, const VectorXd& beta) {
  const std::vector<Body> weights = Bodies(robot, beta);
  // Fourth order with h = 1e-3: truncation h^4 and rounding 1e-16/h are both near 1e-12 of U.
  const double h = 1e-3;
  VectorXd slope(beta.size());
  for (int m = 0; m < beta.size(); ++m) {
    const auto shifted = [&](double by) {
      VectorXd at = beta;
      at[m] += by;
      return Energy(robot, load, at, weights);
    };
    slope[m] = (8 * (shifted(h) - shifted(-h)) - (shifted(2 * h) - shifted(-2 * h))) / (12 * h);
  }
  return slope;
}

}  // namespace continuum::twin_pivot::again
