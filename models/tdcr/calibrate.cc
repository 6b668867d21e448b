#include "models/tdcr/calibrate.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numbers>
#include <utility>

#include "error.h"
#include "sim/numerics/levenberg_marquardt.h"
#include "sim/numerics/solver.h"

namespace continuum::tdcr {
namespace {

// Residuals over L by the unknowns' x.
class CalibrationProblem {
 public:
  CalibrationProblem(const Robot& robot, Method method, std::vector<Unknown> unknowns,
                     const std::vector<Pair>& pairs)
      : robot_(robot),
        method_(method),
        unknowns_(std::move(unknowns)),
        low_(LowestOf(unknowns_, robot)),
        high_(HighestOf(unknowns_, robot)) {
    for (const Pair& pair : pairs) {
      if (!pair.measured->test) pairs_.push_back(pair);
    }
    starts_.resize(pairs_.size());
    for (const Pair& pair : pairs_) {
      begin_.push_back(equations_);
      equations_ += 3 * pair.measured->count();
    }
    begin_.push_back(equations_);
  }

  Eigen::Index unknowns() const { return low_.size(); }
  Eigen::Index equations() const { return equations_; }
  const std::vector<Pair>& pairs() const { return pairs_; }
  const std::vector<Eigen::Index>& begin() const { return begin_; }
  const Eigen::VectorXd& low() const { return low_; }
  const Eigen::VectorXd& high() const { return high_; }
  const std::string& failure() const { return failure_; }

  Eigen::VectorXd Start() const { return StartOf(unknowns_, robot_); }

  Robot At(const Eigen::VectorXd& p) const { return Changed(robot_, unknowns_, p); }

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
    for (Eigen::Index i = 0; i < unknowns(); ++i) {
      const Unknown& unknown = unknowns_[static_cast<std::size_t>(i)];
      if (unknown.quantity == Quantity::kBaseRotation) {
        jacobian.col(i) = Points(TurnSlope(robot, unknown.component));
      } else if (!Slope(x, i, jacobian)) {
        return false;
      }
    }
    return true;
  }

  // Best rotation of the measured points onto the modelled ones, as angles of R_x R_y R_z; only
  // where all three are unknown.
  bool Align(Eigen::VectorXd& p) const {
    std::vector<Eigen::Index> at;
    for (Eigen::Index i = 0; i < unknowns(); ++i) {
      if (unknowns_[static_cast<std::size_t>(i)].quantity == Quantity::kBaseRotation)
        at.push_back(i);
    }
    if (at.empty()) return false;
    Eigen::VectorXd model(equations_);
    if (!Model(At(p), model)) return false;
    const Eigen::VectorXd points = Points(Eigen::Matrix3d::Identity());
    const Eigen::Matrix3Xd from = points.reshaped(3, equations_ / 3);
    const Eigen::Matrix3Xd to = model.reshaped(3, equations_ / 3);
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(to * from.transpose(),
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Vector3d sign(1, 1, (svd.matrixU() * svd.matrixV()).determinant());
    const Eigen::Matrix3d r = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
    p[at[0]] = std::atan2(-r(1, 2), r(2, 2));
    p[at[1]] = std::asin(std::clamp(r(0, 2), -1.0, 1.0));
    p[at[2]] = std::atan2(-r(0, 1), r(0, 0));
    return true;
  }

 private:
  // dR^c/dtheta_i = (R(theta_i + pi/2) - R(theta_i - pi/2))/2 holds exactly for a rotation about an
  // axis, and the other two factors are linear in it.
  static Eigen::Matrix3d TurnSlope(const Robot& robot, int i) {
    Robot up, down;
    up.base_rotation = down.base_rotation = robot.base_rotation;
    up.base_rotation[i] += std::numbers::pi / 2;
    down.base_rotation[i] -= std::numbers::pi / 2;
    return (up.MeasuringToBase() - down.MeasuringToBase()) / 2;
  }

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

  // Central difference; at a bound the one-sided formula of the same order.
  bool Slope(const Eigen::VectorXd& x, Eigen::Index i, Eigen::MatrixXd& jacobian) const {
    constexpr double kStep =
        1e-4;  // equilibria are good to 1e-12, so 1e-8 of error from both sides
    const auto model = [&](double shift, Eigen::VectorXd& out) {
      Eigen::VectorXd at = x;
      at[i] += shift;
      out.resize(equations_);
      return Model(At(at), out);
    };
    Eigen::VectorXd a, b, c;
    if (x[i] < low_[i] + kStep || x[i] > high_[i] - kStep) {
      const double h = x[i] < low_[i] + kStep ? kStep : -kStep;
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
  std::vector<Unknown> unknowns_;
  Eigen::VectorXd low_, high_;
  std::vector<Pair> pairs_;
  std::vector<Eigen::Index> begin_;
  Eigen::Index equations_ = 0;
  mutable std::vector<Eigen::VectorXd> starts_;
  mutable std::string failure_;
};

numerics::Options FitOptions() {
  numerics::Options options;
  options.tolerance = 0;
  options.gradient = 1e-9;  // of the differences in E and mu
  options.step = 1e-10;
  options.max_iterations = 2000;  // shapes of other cases: flat valleys
  return options;
}

// The better fit of those from all starts.
Eigen::VectorXd Fit(const CalibrationProblem& problem) {
  numerics::Bounds<Eigen::Dynamic> bounds;
  bounds.lower = problem.low();
  bounds.upper = problem.high();
  std::vector<Eigen::VectorXd> starts{problem.Start()};
  Eigen::VectorXd aligned = problem.Start(), best;
  if (problem.Align(aligned)) starts.push_back(aligned);
  numerics::Outcome outcome;
  for (Eigen::VectorXd p : starts) {
    const auto result = numerics::LevenbergMarquardt<Eigen::VectorXd>(
        problem, p, problem.equations(), FitOptions(), bounds);
    if (result.ok() && result.residual < outcome.residual) {
      outcome = result;
      best = p;
    } else if (!result.ok() && best.size() == 0) {
      outcome.why = result.why;
    }
  }
  if (best.size() > 0) return best;
  throw Error::Job("calibration failed: " + outcome.why +
                   (problem.failure().empty() ? "" : "; " + problem.failure()));
}

// An unknown that moves no measured point cannot be found.
void RequireEffects(const std::vector<Unknown>& unknowns, const Eigen::MatrixXd& J,
                    const std::string& file) {
  constexpr double kNoise = 1e-9;  // of L
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (J.col(static_cast<Eigen::Index>(i)).lpNorm<Eigen::Infinity>() > kNoise) continue;
    throw Error::Input(file, "shapes that depend on the parameter " + unknowns[i].name, "none");
  }
}

// How near disks are that a fit without their shape predicts.
Prediction PredictionOf(const CalibrationProblem& problem, const Eigen::VectorXd& left_out,
                        const Robot& robot) {
  std::vector<std::vector<double>> distances(static_cast<std::size_t>(robot.disks));
  Eigen::Index row = 0;
  for (const Pair& pair : problem.pairs()) {
    for (int i = 0; i < robot.disks; ++i) {
      if (!pair.measured->Has(i)) continue;
      const double distance = robot.length * left_out.segment<3>(row).norm();
      distances[static_cast<std::size_t>(i)].push_back(distance);
      row += 3;
    }
  }
  Prediction prediction;
  prediction.cases = static_cast<int>(problem.pairs().size());
  for (const auto& d : distances) {
    double level = 0.95;
    prediction.within.push_back(statics::WithinOf(d, level));
    if (!d.empty()) prediction.level = std::min(prediction.level, level);
  }
  return prediction;
}

// Errors of the calibrated robot on all cases.
void AddErrors(Method method, const std::vector<Pair>& pairs, Calibration& calibration) {
  const Robot& robot = calibration.robot;
  for (const Pair& pair : pairs) {
    Loads loads = pair.loads->loads;
    if (!loads.own_mu) loads.mu = robot.mu;
    const Solution solution = SolveCase(robot, loads, method);
    if (!solution.outcome.ok()) {
      throw Error::Job("case '" + pair.loads->name + "': " + solution.outcome.why);
    }
    calibration.tips.Add(robot, *pair.measured, solution.disks);
    if (!pair.measured->test) calibration.explained.Add(robot, *pair.measured, solution.disks);
  }
}

}  // namespace

Calibration Calibrate(const Robot& robot, Method method, const std::vector<Unknown>& unknowns,
                      const std::vector<Pair>& pairs, const std::string& file) {
  const CalibrationProblem problem(robot, method, unknowns, pairs);
  if (problem.equations() < problem.unknowns()) {
    throw Error::Input(
        file,
        fmt::format("at least {} measured coordinates for as many unknowns", problem.unknowns()),
        fmt::format("{}", problem.equations()));
  }
  const Eigen::VectorXd x = Fit(problem);
  Calibration calibration{problem.At(x), unknowns, x, {}, {}, 0, {}, {}, {}};
  calibration.cases = static_cast<int>(problem.pairs().size());
  std::vector<bool> free;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    free.push_back(x[i] > problem.low()[i] && x[i] < problem.high()[i]);
    if (!free.back()) calibration.at_bound.push_back(unknowns[static_cast<std::size_t>(i)].name);
  }
  statics::FittedShapes fit{Eigen::VectorXd(problem.equations()),
                            Eigen::MatrixXd(problem.equations(), x.size()),
                            problem.begin(),
                            x,
                            problem.low(),
                            problem.high()};
  if (!problem.Jacobian(x, fit.f, fit.J)) throw Error::Job(problem.failure());
  RequireEffects(unknowns, fit.J, file);
  calibration.spread = statics::SpreadOf(fit, free);
  calibration.prediction = PredictionOf(problem, calibration.spread.left_out, robot);
  AddErrors(method, pairs, calibration);
  return calibration;
}

Calibration Calibrate(const Robot& robot, Method method, const std::vector<Pair>& pairs,
                      const std::string& file) {
  const auto unknowns = ParseUnknowns(DefaultParameters(robot, method), robot, method, file);
  return Calibrate(robot, method, unknowns, pairs, file);
}

}  // namespace continuum::tdcr
