#include "models/stiff_flop/details.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "models/stiff_flop/inverse.h"
#include "models/stiff_flop/rod.h"
#include "models/stiff_flop/rod_law.h"

namespace continuum::stiff_flop {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using statics::Details;

constexpr int kPieces = 32;

Quaterniond Frame(const Rod::State<double>& y) {
  return Quaterniond(y[3], y[4], y[5], y[6]).normalized();
}

std::vector<Rod::State<double>> States(const Module& module, const Method& method, const Case& row,
                                       const Solution& solution) {
  Rod rod(module, method, row, 1, kPieces);
  rod.StartFrom({solution.base[0], solution.base[1], solution.base[2]});
  return rod.States(solution.moment);
}

// Of the outermost fibres in the plane of bending.
double Strain(const Module& module, const Method& method, const Axis<double>& axis) {
  const BaseSection section = Describe(module, method, axis);
  const double kappa = std::hypot(axis.k_1, axis.k_2);
  return std::max(std::abs(axis.lambda * (1 + kappa * section.x_out) - 1),
                  std::abs(axis.lambda * (1 - kappa * section.x_in) - 1));
}

// Per length of the unstrained axis, by Gauss's rule of five points over the way of the strains.
double Work(const Module& module, const Method& method, const Vector3d& p,
            const Axis<double>& axis) {
  constexpr std::array<double, 5> kAt = {-0.906179845938664, -0.538469310105683, 0,
                                         0.538469310105683, 0.906179845938664};
  constexpr std::array<double, 5> kWeight = {0.236926885056189, 0.478628670499366,
                                             0.568888888888889, 0.478628670499366,
                                             0.236926885056189};
  const double zeta_x = -axis.lambda * axis.k_2, zeta_z = -axis.lambda * axis.k_1;
  double work = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    const double share = 0.5 * (1 + kAt[i]), lambda = 1 + share * (axis.lambda - 1);
    const Axis<double> at = {lambda, -share * zeta_z / lambda, -share * zeta_x / lambda};
    const auto reaction = ReactionOf(module, method, p, module.E, module.gamma, at);
    work += 0.5 * kWeight[i] *
            (reaction.n_y * (axis.lambda - 1) + reaction.M_x * zeta_x + reaction.M_z * zeta_z);
  }
  return work;
}

// Of one piece, and its strain.
void AddPiece(const Module& module, const Method& method, const Case& row, const Axis<double>& axis,
              double twist, const Vector3d& n, Details& details) {
  const double G = module.E / 3, h = module.l / kPieces;
  const auto reaction = ReactionOf(module, method, row.given, module.E, module.gamma, axis);
  details.energy += h * Work(module, method, row.given, axis);
  details.energy += h * 0.5 * G * reaction.polar * twist * twist;
  details.energy += h * 0.5 * (n.x() * n.x() + n.z() * n.z()) / (G * reaction.area);
  details.strain = std::max(details.strain, Strain(module, method, axis));
}

// Of a point of the straight module.
Vector3d Straight(double y) { return {0, y, 0}; }

// Of mount and tip force.
void AddMount(const Module& module, const Case& row, const Vector3d& tip, const Vector3d& tangent,
              Details& details) {
  const double l = module.l, l_fs = module.l_fs;
  AddDead(module.m_fs * row.load.gravity, tip + 0.5 * l_fs * tangent, Straight(l + 0.5 * l_fs),
          details);
  AddDead(row.load.force, tip + l_fs * tangent, Straight(l + l_fs), details);
}

Details OfRod(const Module& module, const Method& method, const Case& row,
              const Solution& solution) {
  Details details;
  const auto states = States(module, method, row, solution);
  RodLaw law(module, method, row, 1, kPieces);
  statics::RodChain<RodLaw> chain(law, kPieces);
  statics::RodChain<RodLaw>::Shape shape;
  for (const auto& y : states) shape.push_back(Frame(y));
  chain.Linearize(shape);
  for (int i = 0; i < kPieces; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Vector3d F =
        row.load.force + (module.m_fs + module.m * (1 - (i + 0.5) / kPieces)) * row.load.gravity;
    const Vector3d n = shape[at].slerp(0.5, shape[at + 1]).conjugate() * F;
    AddPiece(module, method, row, law.axis(i), chain.zeta()(1, i) / module.l, n, details);
    const Vector3d middle = 0.5 * (states[at].head<3>() + states[at + 1].head<3>());
    AddDead(module.m / kPieces * row.load.gravity, middle, Straight(module.l * (i + 0.5) / kPieces),
            details);
  }
  AddMount(module, row, solution.tip, solution.tangent, details);
  details.tip = Frame(states.back());
  details.moment = solution.moment * Rod(module, method, row, 1, 1).unit();
  return details;
}

Details OfArc(const Module& module, const Method& method, const Case& row,
              const Solution& solution) {
  Details details;
  const double kappa = row.given[0], phi = row.given[1];
  const Axis<double> axis = {row.given[2], kappa * std::cos(phi), kappa * std::sin(phi)};
  const Arc<double> arc(module.l, axis);
  AddDead(module.m * row.load.gravity, Vector3d::Map(arc.centre.data()), Straight(0.5 * module.l),
          details);
  AddMount(module, row, solution.tip, solution.tangent, details);
  details.tip = Quaterniond::FromTwoVectors(Vector3d::UnitY(), solution.tangent);
  details.strain = Strain(module, method, axis);
  details.energy = std::numeric_limits<double>::quiet_NaN();
  return details;
}

}  // namespace

Details Describe(const Module& module, const Method& method, Direction direction, const Case& row,
                 const Solution& solution) {
  return direction == Direction::kInverse ? OfArc(module, method, row, solution)
                                          : OfRod(module, method, row, solution);
}

std::vector<statics::Place> Places(const Module& module, const Method& method, const Case& row,
                                   const Solution& solution) {
  const auto states = States(module, method, row, solution);
  std::vector<statics::Place> places;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const int disk = i == 0 ? 0 : i + 1 == states.size() ? 1 : -1;
    places.push_back({module.l * static_cast<double>(i) / kPieces,
                      disk,
                      states[i].head<3>(),
                      Frame(states[i]),
                      {}});
  }
  return places;
}

}  // namespace continuum::stiff_flop
