#include "models/twin_pivot/twin_pivot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "error.h"
#include "models/twin_pivot/balance.h"
#include "sim/io/file.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::VectorXd;

// A contact this wide [m] is no obstacle to Newton: cables move by about as much.
constexpr double kWidest = 1e-3;

statics::Options Tolerances() {
  statics::Options options;
  options.tolerance = 1e-13;
  options.accept = 1e-10;
  options.max_step = 1;
  return options;
}

// Runs one stage from x; keeps the count of iterations, and x only when it succeeded.
template <class Stage>
bool Take(statics::Outcome& total, VectorXd& x, const Stage& stage) {
  VectorXd trial = x;
  statics::Outcome outcome = stage(trial);
  outcome.iterations += total.iterations;
  total = outcome;
  if (total.ok()) x = trial;
  return total.ok();
}

// The root of problem_at(1): by Newton from x where that works, otherwise along the roots from that
// of problem_at(0), which is `known`.
template <class ProblemAt>
bool Reach(statics::Outcome& total, VectorXd& x, const ProblemAt& problem_at, VectorXd known) {
  const auto newton = [&](VectorXd& y) {
    return statics::Newton(problem_at(1.0), y, Tolerances());
  };
  if (Take(total, x, newton)) return true;
  x = std::move(known);
  return Take(total, x,
              [&](VectorXd& y) { return statics::Continue(problem_at, y, Tolerances()); });
}

// Three stages: everything but friction; friction with contacts that turn widely; sharp contacts.
statics::Outcome FindRoot(const Task& task, VectorXd& x) {
  statics::Outcome total;
  const double eps = task.robot.eps;
  const double widest = std::max(kWidest, eps);
  const auto loaded = [&](double t) { return Balance{task, t, 0, widest}; };
  if (!Reach(total, x, loaded, VectorXd::Zero(task.joints)) || !task.HasFriction()) return total;
  const auto rubbed = [&](double t) { return Balance{task, 1, t, widest}; };
  if (!Reach(total, x, rubbed, x) || widest == eps) return total;
  const auto sharpened = [&](double t) {
    return Balance{task, 1, 1, std::pow(widest, 1 - t) * std::pow(eps, t)};
  };
  Reach(total, x, sharpened, x);
  return total;
}

void RequirePositiveFriction(const Task& task, const VectorXd& beta) {
  for (const double b : beta) {
    const double theta = 0.5 * std::abs(b);
    const double mu = task.friction.At(theta);
    if (mu >= 0) continue;
    throw Error::Input(task.robot.file + ": friction",
                       "a coefficient >= 0 at every angle of a solution",
                       Decimal(mu) + " at " + Decimal(theta) + " rad");
  }
}

std::vector<Joint<double>> JointsAt(const Robot& robot, const VectorXd& beta) {
  std::vector<Joint<double>> joint;
  for (const double b : beta) joint.emplace_back(robot, b);
  return joint;
}

}  // namespace

int Robot::Joints() const { return std::accumulate(discs.begin(), discs.end(), 0); }

int Robot::Anchor(int cable) const {
  return std::accumulate(discs.begin(), discs.begin() + cable / 4 + 1, 0);
}

Task::Task(const Robot& r, const Load& load, Method chosen)
    : robot(r),
      method(chosen),
      joints(r.Joints()),
      cables(r.Cables()),
      m_D(r.m_D),
      payload(load.condition == Condition::kV ? load.payload : 0),
      gravity(load.gravity),
      force(load.force),
      moment(load.moment),
      tension(load.tension),
      reference(load.reference) {
  const bool all = load.condition != Condition::kIV;
  m_NiTi = all ? r.m_NiTi : 0;
  rho = all ? r.rho_cable : 0;
  m_CL = all ? r.m_CL : 0;
  if (load.condition == Condition::kIII) {
    friction.c = r.mu_const;
  } else if (load.condition != Condition::kI) {
    friction = r.friction;
  }
  for (int j = 0; j < cables; ++j) {
    anchor.push_back(r.Anchor(j));
    hole_y.push_back(r.r[j] * std::cos(r.phi[j]));
    hole_z.push_back(r.r[j] * std::sin(r.phi[j]));
  }
  if (reference.size() == 0) reference = CableLengths(r, VectorXd::Zero(joints));
}

Solution Solve(const Robot& robot, const Load& load, Method method,
               const std::optional<VectorXd>& start) {
  const Task task(robot, load, method);
  Solution solution;
  solution.beta = start ? *start : VectorXd::Zero(task.joints);
  solution.outcome = statics::Timed([&] { return FindRoot(task, solution.beta); });
  RequirePositiveFriction(task, solution.beta);
  if (!solution.outcome.ok()) {
    const auto f = Residual(robot, load, method, solution.beta);
    solution.outcome.residual = f ? f->norm() : std::numeric_limits<double>::infinity();
    return solution;
  }
  solution.tip = CentreLine(robot, solution.beta).back();
  solution.length = CableLengths(robot, solution.beta);
  std::vector<double> force;
  CableForces(task, JointsAt(robot, solution.beta), 1, robot.eps, force);
  solution.tension = Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
      force.data(), task.joints, task.cables);
  return solution;
}

std::optional<VectorXd> Residual(const Robot& robot, const Load& load, Method method,
                                 const VectorXd& beta) {
  const Task task(robot, load, method);
  VectorXd f(task.joints);
  if (!Balance{task, 1, 1, robot.eps}(beta.data(), f.data())) return std::nullopt;
  return f;
}

std::optional<Eigen::MatrixXd> ResidualSlope(const Robot& robot, const Load& load, Method method,
                                             const VectorXd& beta) {
  const Task task(robot, load, method);
  VectorXd f(task.joints);
  Eigen::MatrixXd slope(task.joints, task.joints);
  if (!statics::Linearize(Balance{task, 1, 1, robot.eps}, beta, f, slope)) return std::nullopt;
  return slope;
}

Eigen::MatrixXd CableLengths(const Robot& robot, const VectorXd& beta) {
  Eigen::MatrixXd length = Eigen::MatrixXd::Zero(robot.Joints(), robot.Cables());
  const std::vector<Joint<double>> joint = JointsAt(robot, beta);
  for (int j = 0; j < robot.Cables(); ++j) {
    for (int m = 0; m < robot.Anchor(j); ++m) {
      const double angle = robot.phi[j];
      const double y = robot.r[j] * (m % 2 == 0 ? std::cos(angle) : std::sin(angle));
      length(m, j) = joint[m].Length(y);
    }
  }
  return length;
}

std::vector<Eigen::Vector3d> CentreLine(const Robot& robot, const VectorXd& beta, int per_rod) {
  std::vector<Eigen::Vector3d> points = {Eigen::Vector3d::Zero()};
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (int m = 0; m < beta.size(); ++m) {
    const Joint<double> joint(robot, beta[m]);
    for (int i = 0; i < per_rod; ++i) {
      const double share = static_cast<double>(i) / (per_rod - 1);
      const auto c = Stumpff(share * beta[m]);
      const double s = share * robot.L;
      points.emplace_back(origin + frame * Eigen::Vector3d(0.5 * robot.h + s * c[1],
                                                           s * share * beta[m] * c[2], 0));
    }
    origin += frame * Eigen::Vector3d(joint.origin.x, joint.origin.y, 0);
    points.push_back(origin);
    const double turn = m % 2 == 0 ? M_PI_2 : -M_PI_2;
    frame = frame * Eigen::AngleAxisd(beta[m], Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitX());
  }
  return points;
}

}  // namespace continuum::twin_pivot
