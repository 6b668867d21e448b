#include <cmath>

#include "models/tdcr/disks.h"

namespace continuum::tdcr {
namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

bool TendonChord(const Arc& arc, const Eigen::Vector2d& a, bool derivatives, Chord& chord) {
  const auto& [A, B, C, dA, dB] = arc.bend;
  const Eigen::Vector2d& v = arc.v;
  const double r2 = a.squaredNorm();
  const Eigen::Vector2d t(arc.cos_psi * a.x() - arc.sin_psi * a.y(),
                          arc.sin_psi * a.x() + arc.cos_psi * a.y());
  const double alpha = v.dot(a), beta = v.dot(t), gamma = Cross(t, v);  // gamma = dbeta/dpsi
  const double h = arc.l - alpha, g = arc.l - beta;
  const double square = 2 * B * g * h + 2 * r2 * (1 - arc.cos_psi);
  if (!(square > 1e-12 * arc.l * arc.l)) return false;
  chord.length = std::sqrt(square);
  const double inverse = 1 / chord.length;
  const Eigen::Vector2d delta = t - a;
  const Eigen::Vector2d b = arc.l * a - alpha * t;
  const Eigen::Vector3d lever(A * b.y(), -A * b.x(), B * Cross(v, b) + r2 * arc.sin_psi);
  const Eigen::Vector2d from = B * g * v + delta;  // c and Q^T c without z
  const Eigen::Vector2d to = delta - B * h * v;
  const auto untwist = [&](const Eigen::Vector2d& y) {
    return Eigen::Vector2d(arc.cos_psi * y.x() + arc.sin_psi * y.y(),
                           arc.cos_psi * y.y() - arc.sin_psi * y.x());
  };
  chord.moment = -inverse * lever;
  chord.start = inverse * from;
  chord.end = inverse * untwist(to);
  if (!derivatives) return true;

  const Eigen::Vector2d t_psi(-t.y(), t.x());
  const Eigen::Vector2d square_v = 2 * dB * g * h * v - 2 * B * (h * t + g * a);
  const double square_psi = -2 * B * h * gamma + 2 * r2 * arc.sin_psi;
  const double scale = -0.5 * inverse * inverse;  // d(inverse)/inverse per d(square)
  for (int j = 0; j < 2; ++j) {
    const Eigen::Vector2d unit = Eigen::Vector2d::Unit(j);
    const Eigen::Vector2d b_j = -a[j] * t;
    const double relative = scale * square_v[j];
    const Eigen::Vector3d lever_j(dA * v[j] * b.y() + A * b_j.y(), -dA * v[j] * b.x() - A * b_j.x(),
                                  dB * v[j] * Cross(v, b) + B * (Cross(unit, b) + Cross(v, b_j)));
    const Eigen::Vector2d from_j = (dB * v[j] * g - B * t[j]) * v + B * g * unit;
    const Eigen::Vector2d to_j = (B * a[j] - dB * v[j] * h) * v - B * h * unit;
    chord.d_moment.col(j) = -inverse * lever_j + relative * chord.moment;
    chord.d_start.col(j) = inverse * from_j + relative * chord.start;
    chord.d_end.col(j) = inverse * untwist(to_j) + relative * chord.end;
  }
  chord.d_length << square_v.transpose(), square_psi;
  chord.d_length *= 0.5 * inverse;
  const double relative = scale * square_psi;
  const Eigen::Vector3d lever_psi(-alpha * A * t_psi.y(), alpha * A * t_psi.x(),
                                  -B * alpha * beta + r2 * arc.cos_psi);
  const Eigen::Vector2d from_psi = t_psi - B * gamma * v;
  const Eigen::Vector2d to_psi = t_psi - Eigen::Vector2d(-to.y(), to.x());
  chord.d_moment.col(2) = -inverse * lever_psi + relative * chord.moment;
  chord.d_start.col(2) = inverse * from_psi + relative * chord.start;
  chord.d_end.col(2) = inverse * untwist(to_psi) + relative * chord.end;
  return true;
}

FrictionRatio::FrictionRatio(const Eigen::Vector2d& end, const Eigen::Vector2d& start, double mu,
                             int s) {
  // (1 - mu^2 b.b) x^2 - 2 (1 + mu^2 a.b) x + (1 - mu^2 a.a) = 0; its discriminant written with the
  // difference start - end, which vanishes at the kink.
  const double square = mu * mu;
  const Eigen::Vector2d difference = start - end;
  const double cross = Cross(end, start);
  const double leading = 1 - square * start.squaredNorm();
  const double discriminant = square * difference.squaredNorm() - square * square * cross * cross;
  const double root = std::sqrt(std::max(discriminant, 0.0));
  x = (1 - square * end.dot(start) - s * root) / leading;
  const double slope = root > 1e-14 ? s / (2 * root) : 0;  // at the kink: the mean of both sides
  const Eigen::Vector2d by_end =
      -2 * square * difference -
      2 * square * square * cross * Eigen::Vector2d(start.y(), -start.x());
  const Eigen::Vector2d by_start =
      2 * square * difference - 2 * square * square * cross * Eigen::Vector2d(-end.y(), end.x());
  d_end = (-square * start - slope * by_end) / leading;
  d_start = (-square * end - slope * by_start + 2 * square * x * start) / leading;
}

double FrictionRatio::ByMu(const Eigen::Vector2d& end, const Eigen::Vector2d& start, double mu,
                           int s) const {
  const double square = mu * mu;
  const double cross = Cross(end, start);
  const double across =
      std::sqrt(std::max((start - end).squaredNorm() - square * cross * cross, 0.0));
  const double falling = across > 1e-14 ? square * cross * cross / across : 0;
  return (-2 * mu * end.dot(start) - s * (across - falling) + 2 * mu * start.squaredNorm() * x) /
         (1 - square * start.squaredNorm());
}

}  // namespace continuum::tdcr
