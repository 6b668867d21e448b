#include "models/tdcr/equilibria.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/statics/equilibria.h"
#include "models/tdcr/cosserat.h"
#include "models/tdcr/details.h"
#include "models/tdcr/disks.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

// Curvatures of the base that a shape can have, in 1/L: a rod under a dead force P L^2/EI bends by
// at most 2 sqrt(P) more than its tendons do.
double Largest(const Robot& robot, const Loads& loads) {
  const double moment = robot.Softest() / robot.length;
  double tendons = 0;
  for (const double t : loads.tension) tendons += t * robot.tendon_radius / moment;
  return 2 + 2 * std::sqrt(loads.DeadForce(robot) * robot.length / moment) + tendons;
}

Vector3d Curvature(Random& random, double largest) {
  Vector3d u;
  for (double& value : u) value = largest * (2 * random.Uniform() - 1);
  u.z() /= 3;
  return u;
}

// The energy at a root, for families of them; the unit is EI/L.
template <class Vector>
double EnergyNear(const Robot& robot, const Loads& loads, Method method, const Vector& x) {
  const Solution s = SolveNear(robot, loads, method, x);
  if (!s.outcome.ok()) return std::nan("");
  return Describe(robot, loads, method, s).energy / robot.moment();
}

template <class Vector, class Balance, class Draw>
statics::Roots<VectorXd> Roots(const Robot& robot, const Loads& loads, Method method,
                               const Balance& balance, const std::vector<Vector>& known,
                               const Draw& draw) {
  const auto energy = [&](const Vector& x) { return EnergyNear(robot, loads, method, x); };
  statics::SearchOptions options;
  options.most_systems = 150000;  // among the 864 loads the hardest takes 12237
  const auto found = statics::FindRoots<Vector>(balance, known, draw, energy, options);
  return {{found.x.begin(), found.x.end()}, found.gave_up};
}

template <int C>
statics::Roots<VectorXd> RootsOfDisks(const Robot& robot, const Loads& loads, Method method,
                                      const VectorXd& known) {
  using Vector = typename DiskBalance<C>::Vector;
  const DiskBalance<C> balance(robot, loads);
  const double largest = Largest(robot, loads);
  const auto draw = [&](Random& random) {
    const Vector3d first = Curvature(random, largest), last = Curvature(random, largest);
    Vector x = Vector::Zero(balance.unknowns());
    const Eigen::Index count = x.size() / 3;
    for (Eigen::Index i = 0; i < count; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(count - 1);
      const Vector3d u = (1 - share) * first + share * last;
      x.template segment<3>(3 * i) << u.y(), -u.x(), u.z();
    }
    return x;
  };
  std::vector<Vector> starts;
  if (known.size() > 0) starts.emplace_back(known);
  return Roots<Vector>(robot, loads, method, balance, starts, draw);
}

statics::Roots<VectorXd> RootsOfRod(const Robot& robot, const Loads& loads, Method method,
                                    const VectorXd& known) {
  constexpr int kSteps = 36;  // along the rod
  const bool friction = method == Method::kCrtFriction;
  const RodBalance balance(robot, loads, friction, std::max(1, kSteps / CountArcs(robot)));
  const double largest = Largest(robot, loads);
  const auto draw = [&](Random& random) { return Curvature(random, largest); };
  std::vector<Vector3d> starts;
  if (known.size() > 0) starts.emplace_back(known.head<3>());
  return Roots<Vector3d>(robot, loads, method, balance, starts, draw);
}

Loads WithoutFriction(Loads loads) {
  loads.mu = 0;
  std::replace(loads.direction.begin(), loads.direction.end(), kAsItSlides, 1);
  return loads;
}

}  // namespace

std::vector<Solution> Equilibria(const Robot& robot, const Loads& loads, Method method,
                                 const Solution& known) {
  const bool slides = loads.AsItSlides();
  const Loads searched = slides ? WithoutFriction(loads) : loads;
  const VectorXd x = known.outcome.ok() ? known.x : VectorXd();
  statics::Roots<VectorXd> roots;
  if (method == Method::kEas) {
    roots = RootsOfDisks<6>(robot, searched, method, x);
  } else if (method == Method::kPcca) {
    roots = RootsOfDisks<Eigen::Dynamic>(robot, searched, method, x);
  } else {
    roots = RootsOfRod(robot, searched, method, x);
  }
  const auto near = [&](const VectorXd& root) { return SolveNear(robot, loads, method, root); };
  const auto same = [&](const Solution& a, const Solution& b) {
    return (a.disks - b.disks).colwise().norm().maxCoeff() < 1e-5 * robot.length;
  };
  const auto energy = [&](const Solution& s) { return Describe(robot, loads, method, s).energy; };
  return statics::ByEnergy(known, roots, near, same, energy);
}

}  // namespace continuum::tdcr
