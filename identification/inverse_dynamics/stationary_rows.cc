#include "identification/inverse_dynamics/stationary_rows.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace continuum {
namespace {

using Vector = Eigen::VectorXd;

constexpr double kClear = 5;  // standard deviations from which a joint is seen to move

// The Jacobian of a row of dry friction; empty for other rows.
Vector FrictionRow(const mjModel& m, const mjData& d, int row) {
  const int id = d.efc_id[row];
  if (d.efc_type[row] == mjCNSTR_FRICTION_DOF) return Vector::Unit(m.nv, id);
  if (d.efc_type[row] != mjCNSTR_FRICTION_TENDON) return {};
  Vector J = Vector::Zero(m.nv);
  for (int k = 0; k < m.ten_J_rownnz[id]; ++k)
    J[m.ten_J_colind[m.ten_J_rowadr[id] + k]] = d.ten_J[m.ten_J_rowadr[id] + k];
  return J;
}

}  // namespace

double SpeedNoise(const std::vector<double>& y, const std::vector<double>& filtered, double cutoff,
                  double h) {
  double squares = 0;
  for (std::size_t k = 0; k < y.size(); ++k) squares += std::pow(y[k] - filtered[k], 2);
  const double sigma = std::sqrt(squares / static_cast<double>(y.size()) / (1 - 2 * cutoff));
  return sigma * 2 * std::numbers::pi / h * std::sqrt(2 * std::pow(cutoff, 3) / 3);
}

void MarkStationary(const JointEqualities& ties, const mjModel& m, const mjData& d,
                    const std::vector<double>& v, const std::vector<double>& noise,
                    Eigen::Ref<Eigen::RowVectorXd> stationary) {
  const auto free = static_cast<Eigen::Index>(ties.velocities());
  Vector seen(free);
  for (int row = 0; row < d.nefc; ++row) {
    const Vector J = FrictionRow(m, d, row);
    if (J.size() == 0) continue;
    ties.Project(J.data(), seen.data());
    const double speed = seen.dot(Vector::Map(v.data(), free));
    if (std::abs(speed) > kClear * seen.cwiseAbs().dot(Vector::Map(noise.data(), free))) continue;
    for (Eigen::Index i = 0; i < free; ++i) {
      if (seen[i] != 0) stationary[i] = 1;
    }
  }
}

Eigen::MatrixXd WidenedByFilter(const Eigen::MatrixXd& stationary, double cutoff) {
  const auto reach = static_cast<Eigen::Index>(std::lround(1 / cutoff));
  Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(stationary.rows(), stationary.cols());
  for (Eigen::Index i = 0; i < stationary.cols(); ++i) {
    for (Eigen::Index begin = 0, end; begin < stationary.rows(); begin = end + 1) {
      end = begin;
      while (end < stationary.rows() && stationary(end, i) != 0) ++end;
      if (end == begin || end - begin < reach) continue;
      const Eigen::Index from = std::max<Eigen::Index>(0, begin - reach);
      wide.col(i).segment(from, std::min(end + reach, stationary.rows()) - from).setOnes();
    }
  }
  return wide;
}

}  // namespace continuum
