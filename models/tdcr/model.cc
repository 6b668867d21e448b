#include "models/tdcr/model.h"

#include <cmath>

#include "error.h"
#include "models/tdcr/cosserat.h"
#include "models/tdcr/disks.h"
#include "sim/numerics/continuation.h"
#include "sim/numerics/decompositions.h"
#include "sim/numerics/levenberg_marquardt.h"
#include "sim/numerics/linearize.h"
#include "sim/numerics/newton.h"
#include "sim/numerics/solver.h"

namespace continuum::tdcr {
namespace {

using numerics::Outcome;

numerics::Options Limits() {
  numerics::Options options;
  options.tolerance = 1e-12;
  options.accept = 5e-10;
  options.max_step = 6;  // radians over the whole rod
  return options;
}

// A root at full load from wherever x is: damped Newton, then least squares polished by Newton.
template <class Balance, int N>
Outcome Search(const Balance& balance, Eigen::Matrix<double, N, 1>& x) {
  using Vector = Eigen::Matrix<double, N, 1>;
  const Vector begin = x;
  Outcome outcome = numerics::Newton(balance, x, Limits());
  if (outcome.ok()) return outcome;
  x = begin;
  numerics::Options options = Limits();
  options.max_iterations = 300;
  const int before = outcome.iterations;
  outcome = numerics::LevenbergMarquardt<Vector>(balance, x, x.size(), options);
  outcome.iterations += before;
  if (outcome.residual <= options.tolerance) return outcome;
  const int spent = outcome.iterations;
  outcome = numerics::Newton(balance, x, Limits());
  outcome.iterations += spent;
  return outcome;
}

// Whether the stiffness is positive: J relative to the unloaded rod has no eigenvalue to the left
// of zero. It starts as the identity and stays so on a path of equilibria without a singular point.
template <class Balance, int N>
bool Stable(const Balance& balance, const Eigen::Matrix<double, N, 1>& x) {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  Vector f(x.size());
  Matrix jacobian(x.size(), x.size());
  if (!numerics::Linearize(balance, x, f, jacobian)) return false;
  return LeastRealEigenvalue(balance.RelativeToUnloaded(jacobian)) > -0.01;
}

constexpr double kOnTheWay = 1e-6;  // of EI/L: enough to tell branches apart

// The path of equilibria from zero load. Corrector steps can cross to an unstable branch where a
// pitchfork is close: then again with a look at every step.
template <class Balance, int N>
Outcome FollowLoads(Balance& balance, Eigen::Matrix<double, N, 1>& x) {
  const auto at = [&](double load) -> const Balance& {
    balance.SetLoad(load);
    return balance;
  };
  const auto stable = [&](const auto& trial) { return Stable(balance, trial); };
  numerics::PathOptions path;
  path.tolerance = kOnTheWay;
  Outcome outcome = numerics::Continue(at, x, Limits(), path);
  if (!outcome.ok() || !stable(x)) {
    const int spent = outcome.iterations;
    x.setZero();
    path.first_step = path.largest_step = 0.05;
    outcome = numerics::Continue(at, x, Limits(), path, stable);
    outcome.iterations += spent;
  }
  balance.SetLoad(1);
  return outcome;
}

template <class Balance, int N>
Outcome Equilibrium(Balance& balance, Eigen::Matrix<double, N, 1>& x, bool direct,
                    const Eigen::VectorXd* start) {
  int iterations = 0;
  Outcome outcome;
  const auto done = [&] {
    iterations += outcome.iterations;
    outcome.iterations = iterations;
    return outcome.ok();
  };
  if (start != nullptr && start->size() == x.size()) {
    x = *start;
    outcome = numerics::Newton(balance, x, Limits());
    if (done()) return outcome;
    x.setZero();
  }
  if (direct) {
    outcome = numerics::Newton(balance, x, Limits());
    if (done()) return outcome;
    x.setZero();
  }
  outcome = FollowLoads(balance, x);
  if (done()) return outcome;
  outcome = Search(balance, x);
  if (done()) return outcome;
  x.setZero();
  outcome = Search(balance, x);
  done();
  if (!outcome.ok() && !std::isfinite(outcome.residual)) {
    const Eigen::Matrix<double, N, 1> straight = Eigen::Matrix<double, N, 1>::Zero(x.size());
    Eigen::Matrix<double, N, 1> f = straight;
    outcome.residual = numerics::NormAt(balance, straight, f);
  }
  return outcome;
}

bool Direct(const Robot& robot, const Loads& loads) {
  return loads.DeadForce(robot) * robot.length / robot.moment() < kOneEquilibrium;
}

template <int C>
Solution SolveDisks(const Robot& robot, const Loads& loads, const Eigen::VectorXd* start) {
  Solution solution;
  solution.outcome = numerics::Timed([&] {
    DiskBalance<C> balance(robot, loads);
    typename DiskBalance<C>::Vector x = DiskBalance<C>::Vector::Zero(balance.unknowns());
    const Outcome outcome = Equilibrium(balance, x, Direct(robot, loads), start);
    solution.x = x;
    solution.u = balance.Curvatures(x);
    solution.disks = Positions(robot.arc(), solution.u);
    return outcome;
  });
  return solution;
}

// Steps of the integrator: about 9 along the rod, a whole number in every piece. The shape is
// taken from twice as many, so that every piece has a middle.
int Steps(int disks) { return std::max(1, (9 + disks - 1) / disks); }

Solution SolveRod(const Robot& robot, const Loads& loads, bool friction,
                  const Eigen::VectorXd* start) {
  constexpr double kAccuracy = 2e-8;  // of L; the contract asks for 1e-7
  Solution solution;
  solution.outcome = numerics::Timed([&] {
    RodBalance balance(robot, loads, friction, Steps(robot.disks));
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    Outcome outcome = Equilibrium(balance, x, Direct(robot, loads), start);
    for (int refinement = 0; outcome.ok(); ++refinement) {
      const int steps = balance.steps();
      const auto coarse = balance.Integrate(x);
      balance.SetSteps(2 * steps);
      const auto fine = balance.Integrate(x);
      const double error = (fine.disks - coarse.disks).colwise().norm().maxCoeff() / robot.length +
                           (fine.residual - coarse.residual).norm();
      solution.u = fine.middles;
      solution.disks = fine.disks;
      if (error <= kAccuracy) break;
      if (refinement == 7) {
        outcome.status = numerics::Status::kNoConvergence;
        outcome.why = "the rod is too strongly bent for the integrator";
        break;
      }
      const int spent = outcome.iterations;
      outcome = Search(balance, x);
      outcome.iterations += spent;
    }
    solution.x = x;
    return outcome;
  });
  return solution;
}

}  // namespace

Method ParseMethod(const std::string& name) {
  if (name == "eas") return Method::kEas;
  if (name == "pcca") return Method::kPcca;
  if (name == "crt") return Method::kCrt;
  if (name == "crt_friction") return Method::kCrtFriction;
  throw Error::Input("--method", "eas, pcca, crt, crt_friction or fit", "'" + name + "'");
}

Solution SolveCase(const Robot& robot, const Loads& loads, Method method,
                   const Eigen::VectorXd* start) {
  switch (method) {
    case Method::kEas:
      return SolveDisks<6>(robot, loads, start);
    case Method::kPcca:
      return SolveDisks<Eigen::Dynamic>(robot, loads, start);
    default:
      return SolveRod(robot, loads, method == Method::kCrtFriction, start);
  }
}

}  // namespace continuum::tdcr
