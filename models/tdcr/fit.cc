#include "models/tdcr/fit.h"

#include <cmath>
#include <vector>

#include "models/tdcr/disks.h"
#include "sim/numerics/levenberg_marquardt.h"
#include "sim/numerics/newton.h"
#include "sim/numerics/solver.h"

namespace continuum::tdcr {
namespace {

using Ends = Eigen::Matrix<double, 6, 1>;

// Residuals of (8) over L, by L u: three rows per point and six for the penalty.
struct ShapeProblem {
  const Robot& robot;
  const Eigen::Matrix3Xd& points;
  std::vector<int> measured;
  double penalty;  // sqrt(lambda)/L^2

  Eigen::Index equations() const { return static_cast<Eigen::Index>(3 * measured.size() + 6); }

  bool operator()(const double* x, double* f) const {
    const Ends ends(x);
    const Eigen::Matrix3Xd disks = Positions(robot.arc(), Linear(ends / robot.length, robot.disks));
    (Eigen::Map<Ends>(f)) = penalty * ends;
    for (std::size_t k = 0; k < measured.size(); ++k) {
      Eigen::Map<Eigen::Vector3d>(f + 6 + 3 * k) =
          (disks.col(measured[k]) - points.col(measured[k])) / robot.length;
    }
    return true;
  }

  bool Jacobian(const Ends& x, Eigen::VectorXd& f, Eigen::Matrix<double, -1, 6>& jacobian) const {
    (*this)(x.data(), f.data());
    const auto gradient = LinearGradient(robot.arc(), x / robot.length, robot.disks);
    jacobian.topRows<6>() = penalty * Eigen::Matrix<double, 6, 6>::Identity();
    for (std::size_t k = 0; k < measured.size(); ++k) {
      jacobian.middleRows<3>(static_cast<Eigen::Index>(6 + 3 * k)) =
          gradient[static_cast<std::size_t>(measured[k])] / (robot.length * robot.length);
    }
    return true;
  }
};

// The arc of constant curvature from the base through a point: the chord makes half its angle.
Ends ArcThrough(const Robot& robot, const Eigen::Vector3d& point, int disk) {
  Ends ends = Ends::Zero();
  const double side = point.head<2>().norm();
  if (side == 0) return ends;
  const double curvature = 2 * std::atan2(side, point.z()) / ((disk + 1) * robot.arc());
  ends.head<2>() = ends.segment<2>(3) = robot.length * curvature * point.head<2>() / side;
  return ends;
}

// Half the gradient of (8) over L^2 by L u, with its Gauss-Newton derivative: a root is sought
// where the sum of squares itself has stopped to change, when the gradient is still at the root of
// the rounding.
struct HalfGradient {
  using Matrix = Eigen::Matrix<double, 6, 6>;
  const ShapeProblem& problem;

  bool operator()(const double* x, double* gradient) const {
    Ends g;
    Matrix curvature;
    if (!Jacobian(Ends(x), g, curvature)) return false;
    (Eigen::Map<Ends>(gradient)) = g;
    return true;
  }

  bool Jacobian(const Ends& x, Ends& gradient, Matrix& curvature) const {
    Eigen::VectorXd f(problem.equations());
    Eigen::Matrix<double, -1, 6> slope(problem.equations(), 6);
    if (!problem.Jacobian(x, f, slope)) return false;
    gradient = slope.transpose() * f;
    curvature = slope.transpose() * slope;
    return true;
  }
};

// Full steps as long as each halves the gradient. @returns the gradient's norm.
double Polish(const ShapeProblem& problem, Ends& x) {
  numerics::Options options;
  options.tolerance = 0;
  options.damped = false;
  return 2 * numerics::Newton(HalfGradient{problem}, x, options).residual;
}

}  // namespace

Solution FitShape(const Robot& robot, const Eigen::Matrix3Xd& points, double lambda) {
  ShapeProblem problem{robot, points, {}, std::sqrt(lambda) / (robot.length * robot.length)};
  for (int i = 0; i < robot.disks; ++i) {
    if (!std::isnan(points(0, i))) problem.measured.push_back(i);
  }
  Solution best;
  best.outcome = numerics::Timed([&] {
    numerics::Options options;
    options.tolerance = 0;
    options.max_iterations = 200;
    numerics::Outcome outcome;
    Ends x = Ends::Zero();
    int iterations = 0;
    const int last = problem.measured.back();
    for (const Ends& start : {Ends(Ends::Zero()), ArcThrough(robot, points.col(last), last)}) {
      Ends trial = start;
      const auto result = numerics::LevenbergMarquardt<Eigen::VectorXd>(
          problem, trial, problem.equations(), options);
      iterations += result.iterations;
      if (result.residual < outcome.residual) {
        outcome = result;
        x = trial;
      }
    }
    outcome.residual = Polish(problem, x);
    outcome.iterations = iterations;
    best.x = x;
    best.u = Linear(x / robot.length, robot.disks);
    best.disks = Positions(robot.arc(), best.u);
    return outcome;
  });
  return best;
}

}  // namespace continuum::tdcr
