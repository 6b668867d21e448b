#include "models/tdcr/fit.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <vector>

#include "models/tdcr/disks.h"

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

// Gauss-Newton steps as long as the gradient falls: the sum of squares itself stops changing when
// the gradient is still at the root of the rounding. @returns the gradient's norm.
double Polish(const ShapeProblem& problem, Ends& x) {
  Eigen::VectorXd f(problem.equations());
  Eigen::Matrix<double, -1, 6> jacobian(problem.equations(), 6);
  double norm = std::numeric_limits<double>::infinity();
  for (Ends trial = x;;) {
    problem.Jacobian(trial, f, jacobian);
    const Ends gradient = jacobian.transpose() * f;
    if (!(2 * gradient.norm() < norm)) return norm;
    norm = 2 * gradient.norm();
    x = trial;
    trial -= (jacobian.transpose() * jacobian).ldlt().solve(gradient);
  }
}

}  // namespace

Solution FitShape(const Robot& robot, const Eigen::Matrix3Xd& points, double lambda) {
  ShapeProblem problem{robot, points, {}, std::sqrt(lambda) / (robot.length * robot.length)};
  for (int i = 0; i < robot.disks; ++i) {
    if (!std::isnan(points(0, i))) problem.measured.push_back(i);
  }
  Solution best;
  best.outcome = statics::Timed([&] {
    statics::Options options;
    options.tolerance = 0;
    options.max_iterations = 200;
    statics::Outcome outcome;
    Ends x = Ends::Zero();
    int iterations = 0;
    const int last = problem.measured.back();
    for (const Ends& start : {Ends(Ends::Zero()), ArcThrough(robot, points.col(last), last)}) {
      Ends trial = start;
      const auto result = statics::LevenbergMarquardt<Eigen::VectorXd>(
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
