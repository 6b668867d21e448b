#include "models/tdcr/fit.h"

#include <cmath>
#include <vector>

#include "models/tdcr/linear_curvature.h"
#include "sim/numerics/levenberg_marquardt.h"
#include "sim/numerics/newton.h"
#include "sim/numerics/solver.h"

namespace continuum::tdcr {
namespace {

// Residuals of (8) over L, by L u: three rows per point and one per unknown for the penalty.
struct ShapeProblem {
  const Robot& robot;
  const LinearCurvature& linear;
  const Eigen::Matrix3Xd& points;
  std::vector<int> measured;
  double penalty;  // sqrt(lambda)/L^2

  Eigen::Index unknowns() const { return linear.unknowns(); }
  Eigen::Index equations() const {
    return static_cast<Eigen::Index>(3 * measured.size()) + unknowns();
  }

  bool operator()(const double* at, double* f) const {
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(at, unknowns());
    const Eigen::Matrix3Xd disks = linear.Positions(linear.Curvatures(x / robot.length));
    (Eigen::Map<Eigen::VectorXd>(f, unknowns())) = penalty * x;
    f += unknowns();
    for (const int disk : measured) {
      (Eigen::Map<Eigen::Vector3d>(f)) = (disks.col(disk) - points.col(disk)) / robot.length;
      f += 3;
    }
    return true;
  }

  bool Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& f, Eigen::MatrixXd& jacobian) const {
    (*this)(x.data(), f.data());
    const auto gradient = linear.Gradient(linear.Curvatures(x / robot.length));
    jacobian.topRows(unknowns()) = penalty * Eigen::MatrixXd::Identity(unknowns(), unknowns());
    Eigen::Index row = unknowns();
    for (const int disk : measured) {
      jacobian.middleRows<3>(row) =
          gradient[static_cast<std::size_t>(disk)] / (robot.length * robot.length);
      row += 3;
    }
    return true;
  }
};

// The arc of constant curvature from the base through a point: the chord makes half its angle.
Eigen::VectorXd ArcThrough(const ShapeProblem& problem, int disk) {
  const Robot& robot = problem.robot;
  const Eigen::Vector3d point = problem.points.col(disk);
  Eigen::VectorXd ends = Eigen::VectorXd::Zero(problem.unknowns());
  const double side = point.head<2>().norm();
  if (side == 0) return ends;
  const double curvature = 2 * std::atan2(side, point.z()) / robot.Place(disk + 1);
  for (Eigen::Index i = 0; i < ends.size(); i += 3) {
    ends.segment<2>(i) = robot.length * curvature * point.head<2>() / side;
  }
  return ends;
}

// Half the gradient of (8) over L^2 by L u, with its Gauss-Newton derivative: a root is sought
// where the sum of squares itself has stopped to change, when the gradient is still at the root of
// the rounding.
struct HalfGradient {
  const ShapeProblem& problem;

  bool operator()(const double* at, double* gradient) const {
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(at, problem.unknowns());
    Eigen::VectorXd g;
    Eigen::MatrixXd curvature;
    if (!Jacobian(x, g, curvature)) return false;
    (Eigen::Map<Eigen::VectorXd>(gradient, g.size())) = g;
    return true;
  }

  bool Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& gradient,
                Eigen::MatrixXd& curvature) const {
    Eigen::VectorXd f(problem.equations());
    Eigen::MatrixXd slope(problem.equations(), problem.unknowns());
    if (!problem.Jacobian(x, f, slope)) return false;
    gradient = slope.transpose() * f;
    curvature = slope.transpose() * slope;
    return true;
  }
};

// Full steps as long as each halves the gradient. @returns the gradient's norm.
double Polish(const ShapeProblem& problem, Eigen::VectorXd& x) {
  numerics::Options options;
  options.tolerance = 0;
  options.damped = false;
  return 2 * numerics::Newton(HalfGradient{problem}, x, options).residual;
}

}  // namespace

Solution FitShape(const Robot& robot, const Eigen::Matrix3Xd& points, double lambda) {
  const LinearCurvature linear(robot);
  ShapeProblem problem{
      robot, linear, points, {}, std::sqrt(lambda) / (robot.length * robot.length)};
  for (int i = 0; i < robot.disks; ++i) {
    if (!std::isnan(points(0, i))) problem.measured.push_back(i);
  }
  Solution best;
  best.outcome = numerics::Timed([&] {
    numerics::Options options;
    options.tolerance = 0;
    options.max_iterations = 200;
    numerics::Outcome outcome;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(problem.unknowns());
    int iterations = 0;
    const Eigen::VectorXd straight = x;
    for (const Eigen::VectorXd& start : {straight, ArcThrough(problem, problem.measured.back())}) {
      Eigen::VectorXd trial = start;
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
    best.u = linear.Curvatures(x / robot.length);
    best.disks = linear.Positions(best.u);
    return outcome;
  });
  return best;
}

}  // namespace continuum::tdcr
