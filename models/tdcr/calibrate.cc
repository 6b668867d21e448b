#include "models/tdcr/calibrate.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <limits>
#include <map>
#include <numbers>

#include "error.h"
#include "sim/numerics/levenberg_marquardt.h"
#include "sim/numerics/solver.h"

namespace continuum::tdcr {
namespace {

constexpr double kMaxFriction = 0.999;

// Unknowns: E over that of the start, the three angles, mu.
class CalibrationProblem {
 public:
  CalibrationProblem(const Robot& robot, Method method, const std::vector<Pair>& pairs)
      : robot_(robot), method_(method) {
    for (const Pair& pair : pairs) {
      if (!pair.measured->test) pairs_.push_back(pair);
    }
    starts_.resize(pairs_.size());
    for (const Pair& pair : pairs_) equations_ += 3 * pair.measured->count();
  }

  int unknowns() const { return method_ == Method::kCrt ? 4 : 5; }
  Eigen::Index equations() const { return equations_; }
  int cases() const { return static_cast<int>(pairs_.size()); }
  const std::string& failure() const { return failure_; }

  Eigen::VectorXd Start() const {
    Eigen::VectorXd p(unknowns());
    p.head<4>() << 1, robot_.base_rotation;
    if (unknowns() == 5) p[4] = robot_.mu;
    return p;
  }

  Robot At(const Eigen::VectorXd& p) const {
    Robot robot = robot_;
    robot.E *= p[0];
    robot.base_rotation = p.segment<3>(1);
    if (p.size() == 5) robot.mu = p[4];
    return robot;
  }

  bool operator()(const double* x, double* f) const {
    const Robot robot = At(Eigen::Map<const Eigen::VectorXd>(x, unknowns()));
    Eigen::VectorXd model(equations_);
    if (!Model(robot, model)) return false;
    Eigen::Map<Eigen::VectorXd>(f, equations_) = Points(robot.MeasuringToBase()) - model;
    return true;
  }

  bool Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& f, Eigen::MatrixXd& jacobian) const {
    if (!(*this)(x.data(), f.data())) return false;
    const Robot robot = At(x);
    const Eigen::Vector3d& a = robot.base_rotation;
    const auto turn = [](double x_angle, double y_angle, double z_angle) {
      Robot r;
      r.base_rotation = {x_angle, y_angle, z_angle};
      return r.MeasuringToBase();
    };
    for (int i = 0; i < 3; ++i) {
      // dR_i/dtheta = (R_i(theta + pi/2) - R_i(theta - pi/2))/2 holds exactly for a rotation about
      // an axis, and the other two factors are linear in it.
      Eigen::Vector3d up = a, down = a;
      up[i] += std::numbers::pi / 2;
      down[i] -= std::numbers::pi / 2;
      const Eigen::Matrix3d slope =
          (turn(up[0], up[1], up[2]) - turn(down[0], down[1], down[2])) / 2;
      jacobian.col(1 + i) = Points(slope);
    }
    return Slope(x, 0, jacobian) && (x.size() < 5 || Slope(x, 4, jacobian));
  }

  // Best rotation of the measured points onto the modelled ones, as angles of R_x R_y R_z.
  bool Align(Eigen::VectorXd& p) const {
    Eigen::VectorXd model(equations_);
    if (!Model(At(p), model)) return false;
    const Eigen::VectorXd points = Points(Eigen::Matrix3d::Identity());
    const Eigen::Matrix3Xd from = points.reshaped(3, equations_ / 3);
    const Eigen::Matrix3Xd to = model.reshaped(3, equations_ / 3);
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(to * from.transpose(),
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Vector3d sign(1, 1, (svd.matrixU() * svd.matrixV()).determinant());
    const Eigen::Matrix3d r = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
    p[1] = std::atan2(-r(1, 2), r(2, 2));
    p[2] = std::asin(std::clamp(r(0, 2), -1.0, 1.0));
    p[3] = std::atan2(-r(0, 1), r(0, 0));
    return true;
  }

 private:
  // R x of all measured points, over L.
  Eigen::VectorXd Points(const Eigen::Matrix3d& R) const {
    Eigen::VectorXd points(equations_);
    Eigen::Index row = 0;
    for (const Pair& pair : pairs_) {
      for (int i = 0; i < robot_.disks; ++i) {
        if (!pair.measured->Has(i)) continue;
        points.segment<3>(row) = R * pair.measured->disks.col(i) / robot_.length;
        row += 3;
      }
    }
    return points;
  }

  // The modelled disks at the same rows, over L; every case starts from its last equilibrium.
  bool Model(const Robot& robot, Eigen::VectorXd& model) const {
    Eigen::Index row = 0;
    for (std::size_t c = 0; c < pairs_.size(); ++c) {
      Loads loads = pairs_[c].loads->loads;
      if (!loads.own_mu) loads.mu = robot.mu;
      const Solution solution =
          SolveCase(robot, loads, method_, starts_[c].size() ? &starts_[c] : nullptr);
      if (!solution.outcome.ok()) {
        failure_ = "case '" + pairs_[c].loads->name + "': " + solution.outcome.why;
        return false;
      }
      starts_[c] = solution.x;
      for (int i = 0; i < robot.disks; ++i) {
        if (!pairs_[c].measured->Has(i)) continue;
        model.segment<3>(row) = solution.disks.col(i) / robot.length;
        row += 3;
      }
    }
    return true;
  }

  // Central difference; at a bound of mu the one-sided formula of the same order.
  bool Slope(const Eigen::VectorXd& x, int i, Eigen::MatrixXd& jacobian) const {
    constexpr double kStep =
        1e-4;  // equilibria are good to 1e-12, so 1e-8 of error from both sides
    const auto model = [&](double shift, Eigen::VectorXd& out) {
      Eigen::VectorXd at = x;
      at[i] += shift;
      out.resize(equations_);
      return Model(At(at), out);
    };
    Eigen::VectorXd a, b, c;
    if (i == 4 && (x[i] < kStep || x[i] > kMaxFriction - kStep)) {
      const double h = x[i] < kStep ? kStep : -kStep;
      if (!model(0, a) || !model(h, b) || !model(2 * h, c)) return false;
      jacobian.col(i) = -(-3 * a + 4 * b - c) / (2 * h);
      return true;
    }
    if (!model(kStep, a) || !model(-kStep, b)) return false;
    jacobian.col(i) = -(a - b) / (2 * kStep);
    return true;
  }

  const Robot& robot_;
  Method method_;
  std::vector<Pair> pairs_;
  Eigen::Index equations_ = 0;
  mutable std::vector<Eigen::VectorXd> starts_;
  mutable std::string failure_;
};

numerics::Bounds<Eigen::Dynamic> Limits(int unknowns) {
  numerics::Bounds<Eigen::Dynamic> bounds;
  constexpr double kTurn = std::numbers::pi;
  bounds.lower = Eigen::VectorXd::Constant(unknowns, -kTurn);
  bounds.upper = Eigen::VectorXd::Constant(unknowns, kTurn);
  bounds.lower[0] = 0.01;
  bounds.upper[0] = 100;
  if (unknowns == 5) {
    bounds.lower[4] = 0;
    bounds.upper[4] = kMaxFriction;
  }
  return bounds;
}

// Square roots of the diagonal of (J^T J)^-1 SSR/(N - p) over the parameters that are free.
Eigen::VectorXd StandardErrors(const Eigen::MatrixXd& jacobian, double squares,
                               const std::vector<bool>& bound) {
  const Eigen::Index n = jacobian.cols();
  Eigen::VectorXd standard = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN());
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!bound[static_cast<std::size_t>(i)] && jacobian.col(i).norm() > 0) free.push_back(i);
  }
  const Eigen::Index spare = jacobian.rows() - static_cast<Eigen::Index>(free.size());
  if (spare <= 0 || free.empty()) return standard;
  const Eigen::MatrixXd used = jacobian(Eigen::all, free);
  const Eigen::MatrixXd covariance =
      (used.transpose() * used).ldlt().solve(Eigen::MatrixXd::Identity(used.cols(), used.cols())) *
      squares / static_cast<double>(spare);
  for (std::size_t k = 0; k < free.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    standard[free[k]] = std::sqrt(covariance(i, i));
  }
  return standard;
}

}  // namespace

Calibration Calibrate(const Robot& robot, Method method, const std::vector<Pair>& pairs,
                      const std::string& file) {
  const CalibrationProblem problem(robot, method, pairs);
  if (problem.equations() < problem.unknowns()) {
    throw Error::Input(
        file,
        fmt::format("at least {} measured coordinates for as many unknowns", problem.unknowns()),
        fmt::format("{}", problem.equations()));
  }
  const auto bounds = Limits(problem.unknowns());
  numerics::Options options;
  options.tolerance = 0;
  options.gradient = 1e-9;  // of the differences in E and mu
  options.step = 1e-10;
  options.max_iterations = 2000;  // shapes of other cases: flat valleys
  Eigen::VectorXd best;
  numerics::Outcome outcome;
  std::vector<Eigen::VectorXd> starts{problem.Start()};
  Eigen::VectorXd aligned = problem.Start();
  if (problem.Align(aligned)) starts.push_back(aligned);
  for (Eigen::VectorXd p : starts) {
    const auto result = numerics::LevenbergMarquardt<Eigen::VectorXd>(
        problem, p, problem.equations(), options, bounds);
    if (result.ok() && result.residual < outcome.residual) {
      outcome = result;
      best = p;
    } else if (!result.ok() && best.size() == 0) {
      outcome.why = result.why;
    }
  }
  if (best.size() == 0) {
    throw Error::Job("calibration failed: " + outcome.why +
                     (problem.failure().empty() ? "" : "; " + problem.failure()));
  }

  Calibration calibration{problem.At(best), {}, {}, problem.cases(), {}, {}};
  const char* const names[] = {"E", "base_rotation", "base_rotation", "base_rotation", "mu"};
  std::vector<bool> bound;
  for (Eigen::Index i = 0; i < best.size(); ++i) {
    bound.push_back(best[i] <= bounds.lower[i] || best[i] >= bounds.upper[i]);
    if (bound.back()) calibration.at_bound.emplace_back(names[i]);
  }
  Eigen::VectorXd f(problem.equations());
  Eigen::MatrixXd jacobian(problem.equations(), best.size());
  if (!problem.Jacobian(best, f, jacobian)) throw Error::Job(problem.failure());
  calibration.standard = StandardErrors(jacobian, f.squaredNorm(), bound);
  calibration.standard[0] *= robot.E;
  for (const Pair& pair : pairs) {
    Loads loads = pair.loads->loads;
    if (!loads.own_mu) loads.mu = calibration.robot.mu;
    const Solution solution = SolveCase(calibration.robot, loads, method);
    if (!solution.outcome.ok()) {
      throw Error::Job("case '" + pair.loads->name + "': " + solution.outcome.why);
    }
    calibration.tips.Add(calibration.robot, *pair.measured, solution.disks);
    if (!pair.measured->test) {
      calibration.explained.Add(calibration.robot, *pair.measured, solution.disks);
    }
  }
  return calibration;
}

}  // namespace continuum::tdcr
