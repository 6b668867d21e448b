#pragma once

#include <vector>

#include "models/stiff_flop/case.h"
#include "models/stiff_flop/tubes.h"

namespace continuum::stiff_flop {

/// Elastic energy per E l [m²] and gas volumes of every line [m³] of a module of constant
/// curvature.
template <class T>
struct Actions {
  T elastic;
  std::vector<T> volume;
};

/// U = W(r_2) - W(r_1) at the axis + n_c Sum_i [w_c - W(r_c2)] at the tubes' axes (Algorithm 1);
/// v_Gi = n_c lambda_ci l a_Gi. Valid where Margin(...) > 0.
template <class T>
Actions<T> ActionsOf(const Module& module, const Method& method, const T& gamma,
                     const Axis<T>& axis) {
  const Body<T> body(method.body, axis.bend());
  Actions<T> actions;
  actions.elastic = body.Energy(module.r_2);
  if (module.r_1 > 0) actions.elastic -= body.Energy(module.r_1);
  const T r_od = TubeDistance(module, method.body, axis.lambda);
  for (std::size_t i = 0; i < module.lines.size(); ++i) {
    const Bend<T> bend = TubeBend(module, axis, r_od, i);
    const Chamber<T> tube = Tube(module, method.chamber, gamma, bend);
    const T hole = Body<T>(method.body, bend).Energy(module.r_c2);
    actions.elastic += static_cast<double>(module.n_c) * (tube.Wall() - hole);
    actions.volume.push_back((module.n_c * module.l) * (bend.lambda * tube.GasArea()));
  }
  actions.elastic /= T(6.0);
  return actions;
}

/// Arc of a module of constant curvature; (1-3) with R_z(-theta), (6).
template <class T>
struct Arc {
  std::array<T, 3> tip, centre, tangent;

  Arc(double l, const Axis<T>& axis) {
    const T length = l * axis.lambda;
    const std::array<T, 4> c = ArcSeries(length * axis.bend().kappa);
    const std::array<T, 3> bend = {length * axis.k_1, T(0.0), -length * axis.k_2};
    for (int i = 0; i < 3; ++i) {
      const double y = i == 1 ? 1 : 0;
      tip[i] = length * (c[2] * bend[i] + y * c[1]);
      centre[i] = length * (c[3] * bend[i] + y * c[2]);
      tangent[i] = c[1] * bend[i] + y * c[0];
    }
  }
};

/// Potential of weight, mount and tip force [J]:
/// -m g.rho_COM - m_fs g.(rho_tip + l_fs/2 t) - f.(rho_tip + l_fs t).
template <class T>
T LoadPotential(const Module& module, const Load& load, const Axis<T>& axis) {
  const Arc<T> arc(module.l, axis);
  T potential(0.0);
  for (int i = 0; i < 3; ++i) {
    const double weight = module.m_fs * load.gravity[i];
    potential -= (module.m * load.gravity[i]) * arc.centre[i];
    potential -= (weight + load.force[i]) * arc.tip[i];
    potential -= (module.l_fs * (0.5 * weight + load.force[i])) * arc.tangent[i];
  }
  return potential;
}

/// Pressures that hold a module of constant curvature in the given shape, by virtual work (5):
/// Sum_i p_i dv_Gi/dq = d/dq (U + load potential), q = (kappa cos phi, kappa sin phi, lambda).
/// Derivatives by dual numbers. Of four lines the pressures with the least sum of squares; two
/// lines balance shapes in their plane at one stretch only. Sensitivities only on demand (they cost
/// six more solves).
Solution SolveInverse(const Module& module, const Method& method, const Case& row,
                      bool sensitivity);

/// Points of the arc from base to tip, for pictures.
std::vector<Eigen::Vector3d> InverseLine(const Module& module, const Case& row);

}  // namespace continuum::stiff_flop
