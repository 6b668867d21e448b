#include "models/stiff_flop/inverse.h"
#include "sim/numerics/solver.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <numbers>

namespace continuum::stiff_flop {
namespace {

using Dual = ceres::Jet<double, 3>;

Axis<double> AxisOf(const Eigen::VectorXd& shape) {
  return {shape[2], shape[0] * std::cos(shape[1]), shape[0] * std::sin(shape[1])};
}

// Dimensionless form of Sum p_i dv_i/dq = dU/dq + dP/dq: rows per E a l (and r_2 for curvatures),
// pressures per E.
struct Balance {
  Eigen::Matrix3Xd volumes;
  Eigen::Vector3d elastic, loads;

  Balance(const Module& module, const Method& method, double gamma, const Load& load,
          const Axis<double>& at) {
    const Axis<Dual> axis{Dual(at.lambda, 2), Dual(at.k_1, 0), Dual(at.k_2, 1)};
    const Actions<Dual> actions = ActionsOf(module, method, Dual(gamma), axis);
    const Dual potential = LoadPotential(module, load, axis);
    const double volume = module.Area() * module.l;
    volumes.resize(3, static_cast<Eigen::Index>(actions.volume.size()));
    for (int k = 0; k < 3; ++k) {
      const double scale = volume * (k < 2 ? module.r_2 : 1);
      for (Eigen::Index i = 0; i < volumes.cols(); ++i) {
        volumes(k, i) = actions.volume[static_cast<std::size_t>(i)].v[k] / scale;
      }
      elastic[k] = module.l * actions.elastic.v[k] / scale;
      loads[k] = potential.v[k] / (module.E * scale);
    }
  }

  // Of more than three lines the least sum of squares; two lines balance few shapes.
  Eigen::VectorXd Solved(const Eigen::Vector3d& b) const {
    if (volumes.cols() == 3) return volumes.fullPivLu().solve(b);
    return volumes.completeOrthogonalDecomposition().solve(b);
  }
  Eigen::VectorXd Pressures() const { return Solved(elastic + loads); }
};

// Distance of gamma from the largest smaller angle at which the section leaves its domain.
double RoomOfGamma(Module module, const Method& method, const Axis<double>& axis) {
  const double gamma = module.gamma;
  double outside = 0;
  double inside = gamma;
  for (int i = 0; i < 30; ++i) {
    module.gamma = 0.5 * (outside + inside);
    (Margin(module, method, axis) > 0 ? inside : outside) = module.gamma;
  }
  return gamma - inside;
}

// Fourth-order differences of exact balances; the laws are even in cot(gamma), hence smooth at
// pi/2. Step: a thousandth of the way to the nearest singularity, error about 1e-12.
Eigen::VectorXd ByGamma(const Module& module, const Method& method, const Case& row,
                        const Axis<double>& axis) {
  const double h = 1e-3 * std::min(1.0, RoomOfGamma(module, method, axis));
  const auto at = [&](double step) {
    return Balance(module, method, module.gamma + step, row.load, axis).Pressures();
  };
  return module.E * (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
}

}  // namespace

Solution SolveInverse(const Module& module, const Method& method, const Case& row,
                      bool sensitivity) {
  Solution solution;
  const Axis<double> axis = AxisOf(row.given);
  solution.outcome = numerics::Timed([&] {
    numerics::Outcome outcome;
    if (Margin(module, method, axis) <= 0) {
      solution.status = Status::kOutOfDomain;
      outcome.status = numerics::Status::kOutOfDomain;
      outcome.why = "the section folds or a thread is straight";
      return outcome;
    }
    const Balance balance(module, method, module.gamma, row.load, axis);
    const Eigen::VectorXd p = balance.Pressures();
    outcome.iterations = 1;
    outcome.residual = (balance.volumes * p - balance.elastic - balance.loads).norm();
    if (!(outcome.residual <= 1e-9)) {
      outcome.why = "no pressures balance this shape, or its integrals do not converge";
      return outcome;
    }
    outcome.status = numerics::Status::kOk;
    solution.status = Status::kOk;
    solution.answer = module.E * p;
    if (sensitivity) {
      solution.by_E = balance.Solved(balance.elastic);
      if (method.chamber != ChamberLaw::kFixed) {
        solution.by_gamma = ByGamma(module, method, row, axis);
      }
    }
    return outcome;
  });
  if (solution.status != Status::kOk) return solution;
  const Arc<double> arc(module.l, axis);
  solution.tip = Eigen::Vector3d::Map(arc.tip.data());
  solution.tangent = Eigen::Vector3d::Map(arc.tangent.data());
  solution.section = Describe(module, method, axis);
  return solution;
}

std::vector<Eigen::Vector3d> InverseLine(const Module& module, const Case& row) {
  constexpr int kPieces = 40;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= kPieces; ++i) {
    const Arc<double> arc(module.l * i / kPieces, AxisOf(row.given));
    points.push_back(Eigen::Vector3d::Map(arc.tip.data()));
  }
  return points;
}

}  // namespace continuum::stiff_flop
