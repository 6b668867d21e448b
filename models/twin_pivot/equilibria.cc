#include "models/twin_pivot/equilibria.h"

#include <algorithm>
#include <utility>

#include "models/statics/equilibria.h"
#include "models/twin_pivot/balance.h"
#include "models/twin_pivot/details.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::VectorXd;

constexpr double kWide = 1e-3;  // of contacts while roots are searched [m]

// f over a joint's stiffness.
struct Scaled {
  Balance balance;

  template <class T>
  bool operator()(const T* beta, T* f) const {
    if (!balance(beta, f)) return false;
    for (int m = 0; m < balance.task.joints; ++m) f[m] /= balance.task.robot.Stiffness();
    return true;
  }
};

// Both planes bend evenly more or less from base to tip, by up to 4 rad in all.
VectorXd Draw(const Task& task, Random& random) {
  const double largest = std::min(2.5, 8.0 / task.joints);
  VectorXd beta(task.joints);
  for (int plane = 0; plane < 2; ++plane) {
    const double first = 2 * random.Uniform() - 1, last = 2 * random.Uniform() - 1;
    for (int m = plane; m < task.joints; m += 2) {
      const double share = static_cast<double>(m) / task.joints;
      beta[m] = largest * ((1 - share) * first + share * last);
    }
  }
  return beta;
}

statics::Roots<VectorXd> Roots(const Robot& robot, const Load& load, Method method,
                               const Solution& known) {
  const Task task(robot, load, method);
  const Scaled problem{{task, 1, 1, std::max(kWide, robot.eps)}};
  std::vector<VectorXd> starts;
  if (known.outcome.ok()) starts.push_back(known.beta);
  const auto draw = [&](Random& random) { return Draw(task, random); };
  const auto energy = [&](const VectorXd& beta) {
    return Energy(robot, load, beta) / robot.Stiffness();
  };
  return statics::FindRoots<VectorXd>(problem, starts, draw, energy);
}

}  // namespace

std::vector<Solution> Equilibria(const Robot& robot, const Load& load, Method method,
                                 const Solution& known) {
  constexpr double kSame = 1e-5;  // rad
  const auto near = [&](const VectorXd& root) {
    return SolveNear(robot, load, method, root, kWide);
  };
  const auto same = [&](const Solution& a, const Solution& b) {
    return (a.beta - b.beta).cwiseAbs().maxCoeff() < kSame;
  };
  const auto energy = [&](const Solution& s) { return Energy(robot, load, s.beta); };
  return statics::ByEnergy(known, Roots(robot, load, method, known), near, same, energy);
}

}  // namespace continuum::twin_pivot
