#include "models/statics/fit_spread.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <boost/math/distributions/students_t.hpp>

#include "models/statics/box_least_squares.h"
#include "sim/numerics/portable_random.h"

namespace continuum::statics {
namespace {

constexpr int kDraws = 1000;
constexpr double kTail = 0.025;
constexpr double kRidge = 1e-12;  // of the diagonal: draws that leave a direction undetermined

// J_i^T J_i and J_i^T f_i of every shape.
struct Normal {
  std::vector<Eigen::MatrixXd> matrix;
  std::vector<Eigen::VectorXd> vector;

  explicit Normal(const FittedShapes& fit) {
    for (std::size_t i = 0; i < fit.count(); ++i) {
      const Eigen::Index rows = fit.begin[i + 1] - fit.begin[i];
      const auto J = fit.J.middleRows(fit.begin[i], rows);
      matrix.emplace_back(J.transpose() * J);
      vector.emplace_back(J.transpose() * fit.f.segment(fit.begin[i], rows));
    }
  }
};

void Stiffen(Eigen::MatrixXd& A) {
  const double least = kRidge * std::max(A.diagonal().maxCoeff(), 1e-300);
  for (Eigen::Index i = 0; i < A.rows(); ++i) A(i, i) += kRidge * A(i, i) + least;
}

// The step of a sum of shapes, within the limits.
Eigen::VectorXd Step(const FittedShapes& fit, Eigen::MatrixXd A, const Eigen::VectorXd& g) {
  Stiffen(A);
  return WithinLimits(A, -g, fit.low - fit.x, fit.high - fit.x);
}

Eigen::VectorXd Standard(const FittedShapes& fit, const std::vector<bool>& free) {
  Eigen::VectorXd standard =
      Eigen::VectorXd::Constant(fit.x.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<Eigen::Index> used;
  for (Eigen::Index i = 0; i < fit.x.size(); ++i) {
    if (free[static_cast<std::size_t>(i)] && fit.J.col(i).norm() > 0) used.push_back(i);
  }
  const Eigen::Index spare = fit.J.rows() - static_cast<Eigen::Index>(used.size());
  if (spare <= 0 || used.empty()) return standard;
  const Eigen::MatrixXd J = fit.J(Eigen::all, used);
  const Eigen::MatrixXd covariance =
      (J.transpose() * J).ldlt().solve(Eigen::MatrixXd::Identity(J.cols(), J.cols())) *
      fit.f.squaredNorm() / static_cast<double>(spare);
  for (std::size_t k = 0; k < used.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    standard[used[k]] = std::sqrt(covariance(i, i));
  }
  return standard;
}

Eigen::MatrixX2d ByShapes(const FittedShapes& fit, const Normal& normal) {
  const std::size_t count = fit.count();
  Eigen::MatrixXd drawn(fit.x.size(), kDraws);
  Random random(33);
  for (int draw = 0; draw < kDraws; ++draw) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(fit.x.size(), fit.x.size());
    Eigen::VectorXd g = Eigen::VectorXd::Zero(fit.x.size());
    for (std::size_t i = 0; i < count; ++i) {
      const auto one = static_cast<std::size_t>(random.Uniform() * static_cast<double>(count));
      A += normal.matrix[one];
      g += normal.vector[one];
    }
    drawn.col(draw) = fit.x + Step(fit, A, g);
  }
  Eigen::MatrixX2d interval(fit.x.size(), 2);
  for (Eigen::Index i = 0; i < fit.x.size(); ++i) {
    Eigen::VectorXd sorted = drawn.row(i).transpose();
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double share) {
      return sorted[static_cast<Eigen::Index>(std::lround(share * (kDraws - 1)))];
    };
    interval.row(i) << at(kTail), at(1 - kTail);
  }
  return interval;
}

// (1), within the limits, and no narrower than by shapes.
Eigen::MatrixX2d ByModel(const FittedShapes& fit, const Normal& normal, Eigen::MatrixXd A,
                         const Eigen::MatrixX2d& shapes) {
  const auto n = static_cast<double>(fit.count());
  if (fit.count() < 2) {
    Eigen::MatrixX2d all(fit.x.size(), 2);
    all << fit.low, fit.high;
    return all;
  }
  Stiffen(A);
  const auto solver = A.ldlt();
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(fit.x.size());
  for (const Eigen::VectorXd& g : normal.vector) squares += solver.solve(n * g).cwiseAbs2();
  const double t = boost::math::quantile(boost::math::students_t(n - 1), 1 - kTail);
  const Eigen::VectorXd half = t * (squares / n).cwiseSqrt();
  Eigen::MatrixX2d interval(fit.x.size(), 2);
  interval << (fit.x - half).cwiseMax(fit.low).cwiseMin(shapes.col(0)),
      (fit.x + half).cwiseMin(fit.high).cwiseMax(shapes.col(1));
  return interval;
}

Eigen::VectorXd LeftOut(const FittedShapes& fit, const Normal& normal, const Eigen::MatrixXd& A,
                        const Eigen::VectorXd& g) {
  Eigen::VectorXd left_out = fit.f;
  for (std::size_t i = 0; i < fit.count(); ++i) {
    const Eigen::Index rows = fit.begin[i + 1] - fit.begin[i];
    const Eigen::VectorXd step = Step(fit, A - normal.matrix[i], g - normal.vector[i]);
    left_out.segment(fit.begin[i], rows) += fit.J.middleRows(fit.begin[i], rows) * step;
  }
  return left_out;
}

}  // namespace

FitSpread SpreadOf(const FittedShapes& fit, const std::vector<bool>& free) {
  const Normal normal(fit);
  const Eigen::MatrixXd A = fit.J.transpose() * fit.J;
  const Eigen::VectorXd g = fit.J.transpose() * fit.f;
  const Eigen::MatrixX2d shapes = ByShapes(fit, normal);
  return {Standard(fit, free), shapes, ByModel(fit, normal, A, shapes), LeftOut(fit, normal, A, g)};
}

double WithinOf(std::vector<double> distances, double& level) {
  if (distances.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(distances.begin(), distances.end());
  const auto n = static_cast<double>(distances.size());
  const double rank = std::ceil(level * (n + 1) - 1e-9);
  if (rank > n) {
    level = n / (n + 1);
    return distances.back();
  }
  return distances[static_cast<std::size_t>(rank) - 1];
}

}  // namespace continuum::statics
