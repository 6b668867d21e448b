#include "identification/statistics/information_modes.h"

#include "sim/numerics/decompositions.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

constexpr double kNone = 1e-12;  // of an eigenvalue: below it rounding decides
constexpr double kPoor = 1e-6;   // worth a second look

}  // namespace

InformationModes::InformationModes(const Matrix& H)
    : unit_(H.diagonal().unaryExpr([](double v) { return v > 0 ? 1 / std::sqrt(v) : 1; })) {
  if (H.rows() == 0) return;
  const Eigen::SelfAdjointEigenSolver<Matrix> modes(
      Matrix(unit_.asDiagonal() * H * unit_.asDiagonal()));
  values_ = modes.eigenvalues(), vectors_ = modes.eigenvectors();
  none_ = (values_.array() < kNone).count();
}

double InformationModes::smallest() const { return values_.size() > 0 ? values_[0] : 1; }

Matrix InformationModes::Inverse() const {
  const auto n = values_.size() - none_;
  const Matrix seen = unit_.asDiagonal() * vectors_.rightCols(n);
  return seen * values_.tail(n).cwiseInverse().asDiagonal() * seen.transpose();
}

Matrix InformationModes::AlongInvariances() const {
  const Matrix along = unit_.asDiagonal() * vectors_.leftCols(none_);
  return along * along.transpose() / kNone;
}

void InformationModes::TakeOutOf(std::vector<Matrix>& J) const {
  const Matrix V = vectors_.leftCols(none_);
  const Matrix P = unit_.asDiagonal() * V * V.transpose() * unit_.cwiseInverse().asDiagonal();
  for (Matrix& one : J) {
    if (one.size() > 0) one -= one * P;
  }
}

Matrix InformationIn(const std::vector<Matrix>& J) {
  Matrix H;
  for (const Matrix& one : J) {
    if (one.size() == 0) continue;
    if (H.size() == 0) H = Matrix::Zero(one.cols(), one.cols());
    H += one.transpose() * one;
  }
  return H;
}

void KeepInvariances(const Problem& problem, const Vector& x, const std::vector<Vector>& r,
                     std::vector<Matrix>& J) {
  if (problem.path() != Path::kStepped || InformationModes(InformationIn(J)).smallest() > kPoor)
    return;
  std::vector<bool> use;
  for (const Matrix& one : J) use.push_back(one.size() > 0);
  Problem narrow = problem;
  narrow.Center();
  narrow.DifferBy(1e-6);
  InformationModes(InformationIn(narrow.Jacobian(x, r, use))).TakeOutOf(J);
}

}  // namespace continuum
