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

std::vector<std::vector<Rod::State<double>>> States(const ModuleSeries& series,
                                                    const Method& method, const Case& row,
                                                    const Solution& solution) {
  Rod rod(series, method, row, 1, kPieces);
  rod.StartFrom(solution.bases);
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
double Work(const Module& module, const Method& method, const Eigen::VectorXd& p,
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
void AddPiece(const Module& module, const Method& method, const Eigen::VectorXd& p,
              const Axis<double>& axis, double twist, const Vector3d& n, Details& details) {
  const double G = module.E / 3, h = module.l / kPieces;
  const auto reaction = ReactionOf(module, method, p, module.E, module.gamma, axis);
  details.energy += h * Work(module, method, p, axis);
  details.energy += h * 0.5 * G * reaction.polar * twist * twist;
  details.energy += h * 0.5 * (n.x() * n.x() + n.z() * n.z()) / (G * reaction.area);
  details.strain = std::max(details.strain, Strain(module, method, axis));
}

// Of a point of the straight module.
Vector3d Straight(double y) { return {0, y, 0}; }

// Of a mount from `tip` on, that stands at `straight` before all loads.
void AddMount(const Module& module, const Load& load, const Vector3d& tip, const Vector3d& tangent,
              double straight, Details& details) {
  AddDead(module.m_fs * load.gravity, tip + 0.5 * module.l_fs * tangent,
          Straight(straight + 0.5 * module.l_fs), details);
}

void AddTipForce(const Module& last, const Load& load, const Vector3d& tip, const Vector3d& tangent,
                 double straight, Details& details) {
  AddDead(load.force, tip + last.l_fs * tangent, Straight(straight + last.l_fs), details);
}

using Shape = statics::RodChain<RodLaw>::Shape;

// Strains by the chain of all pieces, loads of the pieces of one module and of its mount.
class Pieces {
 public:
  Pieces(const ModuleSeries& series, const Method& method, const Case& row,
         const std::vector<std::vector<Rod::State<double>>>& states)
      : series_(series),
        method_(method),
        row_(row),
        states_(states),
        law_(series, method, row, 1, kPieces),
        chain_(law_, law_.Lengths()) {
    for (const auto& module : states) {
      if (!shape_.empty()) shape_.pop_back();
      for (const auto& y : module) shape_.push_back(Frame(y));
    }
    chain_.Linearize(shape_);
  }

  /// straight: where the module begins on the robot without loads [m].
  void AddModule(std::size_t j, double straight, Details& details) {
    const Module& module = series_[j];
    const Load& load = row_.load;
    const Eigen::VectorXd p = series_.PressuresOf(j, row_.given);
    const Vector3d above = series_.Above(j, load.force, load.gravity);
    for (int i = 0; i < kPieces; ++i) {
      const auto at = static_cast<std::size_t>(i), piece = kPieces * j + at;
      const double share = (i + 0.5) / kPieces;
      const Vector3d F = above + module.m * (1 - share) * load.gravity;
      const Vector3d n = shape_[piece].slerp(0.5, shape_[piece + 1]).conjugate() * F;
      const double twist = chain_.zeta()(1, static_cast<Eigen::Index>(piece)) / series_.length();
      AddPiece(module, method_, p, law_.axis(static_cast<int>(piece)), twist, n, details);
      const Vector3d middle = 0.5 * (states_[j][at].head<3>() + states_[j][at + 1].head<3>());
      AddDead(module.m / kPieces * load.gravity, middle, Straight(straight + module.l * share),
              details);
    }
    const Vector3d end = states_[j].back().head<3>();
    const Vector3d tangent = shape_[kPieces * (j + 1)] * Vector3d::UnitY();
    AddMount(module, load, end, tangent, straight + module.l, details);
  }

 private:
  const ModuleSeries& series_;
  const Method& method_;
  const Case& row_;
  const std::vector<std::vector<Rod::State<double>>>& states_;
  RodLaw law_;
  statics::RodChain<RodLaw> chain_;
  Shape shape_;
};

Details OfRod(const ModuleSeries& series, const Method& method, const Case& row,
              const Solution& solution) {
  Details details;
  const auto states = States(series, method, row, solution);
  Pieces pieces(series, method, row, states);
  double straight = 0;
  for (std::size_t j = 0; j < series.size(); ++j) {
    pieces.AddModule(j, straight, details);
    straight += series[j].l + series[j].l_fs;
  }
  AddTipForce(series.last(), row.load, solution.tip, solution.tangent,
              straight - series.last().l_fs, details);
  details.tip = Frame(states.back().back());
  details.moment = solution.moment * series.unit();
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
  AddMount(module, row.load, solution.tip, solution.tangent, module.l, details);
  AddTipForce(module, row.load, solution.tip, solution.tangent, module.l, details);
  details.tip = Quaterniond::FromTwoVectors(Vector3d::UnitY(), solution.tangent);
  details.strain = Strain(module, method, axis);
  details.energy = std::numeric_limits<double>::quiet_NaN();
  return details;
}

}  // namespace

Details Describe(const ModuleSeries& series, const Method& method, Direction direction,
                 const Case& row, const Solution& solution) {
  return direction == Direction::kInverse ? OfArc(series.first(), method, row, solution)
                                          : OfRod(series, method, row, solution);
}

std::vector<statics::Place> Places(const ModuleSeries& series, const Method& method,
                                   const Case& row, const Solution& solution) {
  const auto states = States(series, method, row, solution);
  std::vector<statics::Place> places;
  double start = 0;
  for (std::size_t j = 0; j < states.size(); ++j) {
    for (std::size_t i = 0; i < states[j].size(); ++i) {
      const Rod::State<double>& y = states[j][i];
      const bool base = i == 0 && j == 0, end = i + 1 == states[j].size();
      const int disk = base ? 0 : end ? static_cast<int>(j) + 1 : -1;
      const double s = start + series[j].l * static_cast<double>(i) / kPieces;
      places.push_back({s, disk, y.head<3>(), Frame(y), {}});
    }
    start += series[j].l + series[j].l_fs;
  }
  return places;
}

Eigen::Matrix3Xd EndsOf(const ModuleSeries& series, const Method& method, const Case& row,
                        const Solution& solution) {
  const auto states = States(series, method, row, solution);
  Eigen::Matrix3Xd ends(3, static_cast<Eigen::Index>(states.size()));
  for (std::size_t j = 0; j < states.size(); ++j) {
    ends.col(static_cast<Eigen::Index>(j)) = states[j].back().head<3>();
  }
  ends.rightCols<1>() = solution.tip;
  return ends;
}

}  // namespace continuum::stiff_flop
