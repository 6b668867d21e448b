#include "models/tdcr/model.h"

#include <cmath>

#include "error.h"
#include "models/tdcr/cosserat.h"
#include "models/tdcr/disks.h"
#include "models/tdcr/equilibrium.h"
#include "sim/numerics/solver.h"

namespace continuum::tdcr {
namespace {

using numerics::Outcome;

// Where loads go on from: those before and their x.
struct Before {
  const Loads* loads = nullptr;
  const Eigen::VectorXd* x = nullptr;
};

template <int C>
Solution SolveDisks(const Robot& robot, const Loads& loads, const Eigen::VectorXd* start,
                    const Before& before = {}) {
  Solution solution;
  solution.outcome = numerics::Timed([&] {
    DiskBalance<C> balance(robot, loads, before.loads);
    typename DiskBalance<C>::Vector x = DiskBalance<C>::Vector::Zero(balance.unknowns());
    if (before.x != nullptr) x = *before.x;
    const Found found = before.x == nullptr ? FindEquilibrium<C>(robot, loads, balance, x, start)
                                            : ContinueEquilibrium<C>(robot, loads, balance, x);
    solution.stability = found.stability;
    balance.SetLoad(1);
    solution.x = x;
    solution.u = balance.Curvatures(x);
    solution.disks = Positions(robot.arc(), solution.u);
    if (found.outcome.ok()) solution.contacts = balance.ContactsAt(x);
    return found.outcome;
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
    const Found found = FindEquilibrium(robot, loads, balance, friction, x, start);
    solution.stability = found.stability;
    Outcome outcome = found.outcome;
    balance.SetLoad(1);
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
      outcome = Polish(balance, x);
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

Solution SolveFrom(const Robot& robot, const Loads& earlier, const Solution& before, Loads loads,
                   Method method) {
  if (method == Method::kCrtFriction)
    throw Error::Input("--method", "eas or pcca, whose contacts go on from a reference",
                       "crt_friction");
  const Before from{&earlier, &before.x};
  loads.from = before.contacts;
  switch (method) {
    case Method::kEas:
      return SolveDisks<6>(robot, loads, nullptr, from);
    case Method::kPcca:
      return SolveDisks<Eigen::Dynamic>(robot, loads, nullptr, from);
    default:
      return SolveCase(robot, loads, method);
  }
}

Solution SolveCase(const Robot& robot, const Loads& loads, Method method,
                   const Eigen::VectorXd* start) {
  if (method == Method::kCrtFriction && loads.AsItSlides()) {
    throw Error::Input("--method", "eas or pcca, whose contacts find their directions (auto)",
                       "crt_friction");
  }
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
