#include "models/twin_pivot/rising.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "models/statics/dense_system.h"
#include "models/twin_pivot/geometry.h"
#include "sim/numerics/decompositions.h"
#include "sim/numerics/linearize.h"
#include "sim/numerics/newton.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kZero = -1e-9;  // of the largest eigenvalue
constexpr int kUnknown = 999;

bool IsDefinite(const MatrixXd& symmetric) {
  return Eigen::LLT<MatrixXd>(symmetric).info() == Eigen::Success;
}

int NegativeEigenvalues(const MatrixXd& symmetric) {
  if (IsDefinite(symmetric)) return 0;
  const VectorXd values =
      Eigen::SelfAdjointEigenSolver<MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
  return static_cast<int>((values.array() < kZero * values.cwiseAbs().maxCoeff()).count());
}

// Rows d(length beyond the contact)/dbeta of the contacts that rest.
MatrixXd Constraints(const Task& task, const VectorXd& x, const MatrixXd& slide) {
  constexpr double kResting = 0.98;
  const auto joint = JointsAt(task.robot, x);
  MatrixXd rows(slide.size(), x.size());
  Eigen::Index count = 0;
  for (int j = 0; j < task.cables; ++j) {
    for (int m = 0; m < task.anchor[static_cast<std::size_t>(j)]; ++m) {
      if (!(std::abs(slide(m, j)) < kResting)) continue;
      rows.row(count).setZero();
      for (int i = m; i < task.anchor[static_cast<std::size_t>(j)]; ++i) {
        rows(count, i) = -joint[static_cast<std::size_t>(i)].Arm(task.Y(i, j));
      }
      ++count;
    }
  }
  return rows.topRows(count);
}

}  // namespace

numerics::Options Tolerances() {
  numerics::Options options;
  options.tolerance = 1e-13;
  options.accept = 1e-10;
  options.max_step = 1;
  return options;
}

MatrixXd CableSlopes(const Task& task, const VectorXd& beta) {
  const auto joint = JointsAt(task.robot, beta);
  MatrixXd slopes = MatrixXd::Zero(task.cables, task.joints);
  for (int j = 0; j < task.cables; ++j) {
    for (int m = 0; m < task.anchor[static_cast<std::size_t>(j)]; ++m) {
      slopes(j, m) = -joint[static_cast<std::size_t>(m)].Arm(task.Y(m, j));
    }
  }
  return slopes;
}

MatrixXd SlideAt(const Task& task, const VectorXd& beta, std::vector<double>& force) {
  MatrixXd slide = MatrixXd::Zero(task.joints, task.cables);
  CableForces(task, JointsAt(task.robot, beta), 1, task.robot.eps, force, nullptr, &slide);
  return slide;
}

int UnstableDirections(Balance balance, const VectorXd& beta, const VectorXd& held) {
  constexpr double kHeld = 1e6;  // of a joint's stiffness, at the cables' own distance
  const Task& task = balance.task;
  const Balance giving = balance;
  MatrixXd slide;
  if (task.HasFriction()) {
    slide.setZero(task.joints, task.cables);
    std::vector<double> force;
    const auto joint = JointsAt(task.robot, beta);
    if (!CableForces(task, joint, 1, balance.eps, force, nullptr, &slide)) return kUnknown;
    balance.frozen = &slide;
  }
  VectorXd f(beta.size());
  MatrixXd slope(beta.size(), beta.size());
  if (!numerics::Linearize(balance, beta, f, slope)) return kUnknown;
  MatrixXd winches = MatrixXd::Zero(beta.size(), beta.size());
  if (held.size() > 0) {
    const MatrixXd slopes = CableSlopes(task, beta);
    winches = slopes.transpose() * (held / task.robot.Stiffness()).asDiagonal() * slopes;
  }
  const auto stiffness = [&] {
    return MatrixXd(winches - 0.5 * (slope + slope.transpose()) / task.robot.Stiffness());
  };
  MatrixXd k = stiffness();
  if (IsDefinite(k)) return 0;
  if (task.HasFriction()) {
    // Contacts that nearly slide give way a little, neither held nor free.
    if (numerics::Linearize(giving, beta, f, slope) && IsDefinite(stiffness())) return 0;
    const MatrixXd rows = Constraints(task, beta, slide);
    const double arm = task.robot.r.front();
    k += kHeld / (arm * arm) * MatrixXd(rows.transpose() * rows);
  }
  return NegativeEigenvalues(k);
}

Balance RisingSystem::At(double load) {
  if (load != load_ && load != 1) {
    now_.emplace(to_.Between(from_, load));
  }
  load_ = load;
  return Balance{load == 1 ? to_ : *now_, 1, 1, to_.robot.eps};
}

numerics::Outcome RisingSystem::Correct(double load, VectorXd& x) {
  Balance balance = At(load);
  numerics::Options options = Tolerances();
  options.damped = false;
  options.max_iterations = 12;
  VectorXd trial = x;
  numerics::Outcome outcome = tangent_.Newton(balance, trial, options);
  if (!outcome.ok() && to_.HasFriction()) {  // contacts that turn widely, then sharply
    options = Tolerances();
    options.max_step = 0.3;
    options.max_iterations = 30;
    int spent = outcome.iterations;
    trial = x;
    for (double eps : {1e-3, 3e-5, to_.robot.eps}) {
      balance.eps = std::max(eps, to_.robot.eps);
      outcome = tangent_.Newton(balance, trial, options);
      outcome.iterations += spent;
      spent = outcome.iterations;
      if (!outcome.ok()) break;
    }
  }
  if (outcome.ok()) x = trial;
  return outcome;
}

statics::Fall RisingSystem::Fall(double /*from*/, double load, VectorXd& x) {
  At(load);
  statics::DenseSystem<RisingSystem> system(*this);
  statics::FallOptions options;
  options.most_steps = 1000;
  options.balanced = 10 * Tolerances().accept;  // below it rounding would choose the side
  statics::Fall fall = statics::FallToRest(system, x, options);
  VectorXd root = x;
  fall.ok = fall.ok && Correct(load, root).ok() && (root - x).norm() < 0.05;
  if (fall.ok) driven_ = Unstable(load, root);
  fall.ok = fall.ok && driven_ == 0;
  x = root;
  return fall;
}

bool RisingSystem::Relative(const VectorXd& x, VectorXd& r, MatrixXd* k) const {
  const Balance balance{load_ == 1 ? to_ : *now_, 1, 1, to_.robot.eps};
  VectorXd f(x.size());
  if (k == nullptr) {
    if (!balance(x.data(), f.data())) return false;
  } else {
    if (!numerics::Linearize(balance, x, f, *k)) return false;
    *k /= -to_.robot.Stiffness();
  }
  r = -f / to_.robot.Stiffness();
  return r.allFinite();
}

VectorXd RememberingSystem::Slid(const VectorXd& x) const {
  if (!to_.HasFriction()) return {};
  MatrixXd beyond = CableLengths(to_.robot, x) / to_.robot.eps;
  for (Eigen::Index m = beyond.rows() - 2; m >= 0; --m) beyond.row(m) += beyond.row(m + 1);
  return beyond.reshaped();
}

bool RememberingSystem::SomeRest(const VectorXd& x) const {
  constexpr double kSlides = 0.999;
  std::vector<double> force;
  const auto share = SlideAt(to_, x, force).array().abs().eval();
  return (share > 0 && share < kSlides).any();
}

VectorXd RememberingSystem::Rate(double load, const VectorXd& x, bool exact) {
  constexpr double kStep = 1e-5;
  VectorXd before = x, now = x;
  const bool valid = At(load - kStep)(x.data(), before.data());
  const Balance balance = At(load);
  if (!valid || !balance(x.data(), now.data())) return VectorXd::Zero(x.size());
  return tangent_.Rate(balance, x, (now - before) / kStep, exact);
}

void RememberingSystem::GoOnFrom(const VectorXd& x) {
  if (!to_.HasFriction()) return;
  std::vector<double> force;
  const MatrixXd slide = SlideAt(load_ == 1 ? to_ : *now_, x, force);
  going_on_.slide = slide;
  going_on_.reference = CableLengths(to_.robot, x);
  load_ = 1;  // of the old contacts no task is left
  ++parts_;
}

}  // namespace continuum::twin_pivot
