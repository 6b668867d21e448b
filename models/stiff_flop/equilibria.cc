#include "models/stiff_flop/equilibria.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "models/statics/equilibria.h"
#include "models/stiff_flop/details.h"
#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/rod.h"

namespace continuum::stiff_flop {
namespace {

using Eigen::Vector3d;

/// M(l) by M(0), every time from sections that are raised from rest: no shape depends on the one
/// before.
struct ColdShooting {
  const ModuleSeries& series;
  const Method& method;
  const Case& row;

  bool Jacobian(const Vector3d& x, Vector3d& f, Eigen::Matrix3d& jacobian) const {
    constexpr int kSteps = 2;
    Rod rod(series, method, row, 1, kSteps);
    Rod::State<Rod::Dual> tip;
    if (!rod.Integrate(x, tip)) return false;
    const Eigen::Matrix<Rod::Dual, 3, 1> mismatch = rod.Mismatch(tip);
    for (int i = 0; i < 3; ++i) {
      f[i] = mismatch[i].a;
      jacobian.row(i) = mismatch[i].v.head<3>().transpose();
    }
    return true;
  }
};

// The base cannot carry a larger moment [ModuleSeries::unit()] than all loads at the end of long
// modules give.
double Largest(const ModuleSeries& series, const Case& row) {
  constexpr double kStretched = 1.5;
  const double force = row.load.force.norm() + series.mass() * row.load.gravity.norm();
  return force * (kStretched * series.length() + series.mounts()) / series.unit();
}

}  // namespace

std::vector<Solution> Equilibria(const ModuleSeries& series, const Method& method, const Case& row,
                                 const Solution& known) {
  const auto energy_of = [&](const Solution& s) {
    return Describe(series, method, Direction::kForward, row, s).energy;
  };
  const ColdShooting problem{series, method, row};
  const double largest = Largest(series, row);
  const auto draw = [&](Random& random) {
    Vector3d moment;
    for (double& value : moment) value = largest * (2 * random.Uniform() - 1);
    return moment;
  };
  const auto energy = [&](const Vector3d& moment) {
    const Solution s = SolveNear(series, method, row, moment);
    return s.status == Status::kOk ? energy_of(s) / series.unit()
                                   : std::numeric_limits<double>::quiet_NaN();
  };
  std::vector<Vector3d> starts;
  if (known.status == Status::kOk) starts.push_back(known.moment);
  statics::SearchOptions options;
  options.tolerance = 1e-9;
  options.most_systems = 6000000;  // sections included; among the pushes the hardest takes 513537
  const auto roots = statics::FindRoots<Vector3d>(problem, starts, draw, energy, options);
  const auto near = [&](const Vector3d& root) { return SolveNear(series, method, row, root); };
  const auto same = [&](const Solution& a, const Solution& b) {
    return (a.tip - b.tip).norm() < 1e-6 * series.length() && (a.tangent - b.tangent).norm() < 1e-5;
  };
  return statics::ByEnergy(known, roots, near, same, energy_of);
}

}  // namespace continuum::stiff_flop
