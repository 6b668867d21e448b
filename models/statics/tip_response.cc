#include "models/statics/tip_response.h"

#include <Eigen/LU>
#include <algorithm>

#include "sim/numerics/decompositions.h"

namespace continuum::statics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kTip = 6;  // rows of the tip

// (above - below), turns in the base frame. Right to the third order of the turn.
VectorXd Change(const Shown& above, const Shown& below) {
  VectorXd change(kTip + above.length.size() + above.points.size());
  const Eigen::Quaterniond turn = above.frame * below.frame.conjugate();
  const double sign = turn.w() < 0 ? -2 : 2;
  change << above.tip - below.tip, sign * turn.vec(), above.length - below.length,
      above.points - below.points;
  return change;
}

// The derivative at 0 of what changes by change(s): from both sides, or by three points of one
// where the other is out of the domain (a slack cable cannot push). Right to the second order of
// the step.
template <class ChangeBy>
std::optional<VectorXd> Slope(const ChangeBy& change, double step) {
  const std::optional<VectorXd> above = change(step), below = change(-step);
  if (above && below) return VectorXd((*above - *below) / (2 * step));
  if (!above && !below) return std::nullopt;
  const double side = above ? step : -step;
  const std::optional<VectorXd> farther = change(2 * side);
  if (!farther) return std::nullopt;
  return VectorXd((4 * (above ? *above : *below) - *farther) / (2 * side));
}

// A column for every i, by step(i); empty when something is out of the domain.
template <class ChangeBy, class Step>
MatrixXd Slopes(Index columns, const ChangeBy& change, const Step& step) {
  MatrixXd slopes;
  for (Index i = 0; i < columns; ++i) {
    const auto slope = Slope([&](double s) { return change(i, s); }, step(i));
    if (!slope) return {};
    slopes.conservativeResize(slope->size(), i + 1);
    slopes.col(i) = *slope;
  }
  return slopes;
}

// What changes from a root on; nothing out of the domain.
struct FromRoot {
  const Responding& robot;
  const VectorXd& z;
  VectorXd none;  // of the inputs
  VectorXd f = VectorXd(z.size());
  std::optional<Shown> here = robot.Show(z, none);
  bool inside = here && robot.Residual(z, none, f);

  std::optional<VectorXd> Seen(const VectorXd& at, const VectorXd& w) const {
    const auto there = robot.Show(at, w);
    if (!there) return std::nullopt;
    return Change(*there, *here);
  }
  std::optional<VectorXd> Unbalanced(const VectorXd& w) const {
    VectorXd there(z.size());
    if (!robot.Residual(z, w, there)) return std::nullopt;
    return VectorXd(there - f);
  }
};

}  // namespace

std::optional<MatrixXd> Respond(const Responding& robot, const VectorXd& z, Index inputs) {
  const FromRoot root{robot, z, VectorXd::Zero(inputs)};
  MatrixXd k(z.size(), z.size());
  if (!root.inside || !robot.Tangent(z, k)) return std::nullopt;
  const auto unknown = [&](Index i, double s) {
    return root.Seen(z + s * VectorXd::Unit(z.size(), i), root.none);
  };
  const auto input = [&](Index i, double s) { return root.Seen(z, s * VectorXd::Unit(inputs, i)); };
  const auto unbalanced = [&](Index i, double s) {
    return root.Unbalanced(s * VectorXd::Unit(inputs, i));
  };
  const auto step = [](Index) { return 1e-5; };
  const MatrixXd by_unknowns = Slopes(z.size(), unknown, [&](Index i) { return robot.Step(i); });
  const MatrixXd by_inputs = Slopes(inputs, input, step);
  const MatrixXd residual = Slopes(inputs, unbalanced, step);
  if (by_unknowns.size() == 0 || by_inputs.size() == 0 || residual.size() == 0) return std::nullopt;
  MatrixXd response = by_inputs - by_unknowns * Eigen::PartialPivLU<MatrixXd>(k).solve(residual);
  if (!response.allFinite()) return std::nullopt;
  return response;
}

std::optional<TipResponse> HoldLengths(const TipResponse& by_tension, const VectorXd& tension) {
  const Index loads = by_tension.loads, cables = tension.size();
  std::vector<Index> taut;
  for (Index k = 0; k < cables; ++k) {
    if (tension[k] > 0) taut.push_back(k);
  }
  std::vector<Index> rows, drives;
  for (const Index k : taut) {
    rows.push_back(kTip + k);
    drives.push_back(loads + k);
  }
  const MatrixXd& slope = by_tension.slope;
  const MatrixXd stroke = slope(rows, drives);
  const Eigen::FullPivLU<MatrixXd> factors(stroke);
  if (!taut.empty() && !factors.isInvertible()) return std::nullopt;
  MatrixXd of_tension = MatrixXd::Zero(cables, slope.cols());
  if (!taut.empty()) {
    const MatrixXd by_load = factors.solve(MatrixXd(-slope(rows, Eigen::seqN(0, loads))));
    const MatrixXd by_length = factors.inverse();
    of_tension(taut, Eigen::seqN(0, loads)) = by_load;
    of_tension(taut, drives) = by_length;
  }
  TipResponse held = by_tension;
  for (Index k = 0; k < cables; ++k) {
    held.input[static_cast<std::size_t>(loads + k)] = "L" + std::to_string(k + 1);
  }
  held.slope.rightCols(cables).setZero();
  held.slope += slope.rightCols(cables) * of_tension;
  held.slope.middleRows(kTip, cables) = of_tension;
  return held;
}

Eigen::Matrix3d Ellipsoid(const TipResponse& response, bool drives) {
  const Index first = drives ? response.loads : 0;
  const Index count = drives ? response.slope.cols() - first : 3;
  const MatrixXd by = response.slope.block(0, first, 3, count);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> square(MatrixXd(by * by.transpose()));
  Eigen::Matrix3d axes;
  for (int i = 0; i < 3; ++i) {
    const double size = std::sqrt(std::max(0.0, square.eigenvalues()[2 - i]));
    axes.col(i) = size * square.eigenvectors().col(2 - i);
  }
  return axes;
}

ComplianceTable::ComplianceTable(int cables, bool by_length)
    : cables_(cables), cable_(by_length ? "T_" : "l_"), results_([&] {
        std::vector<std::string> names = {"case", "by", "x", "y", "z", "rx", "ry", "rz"};
        for (const auto& name : Numbered(by_length ? "T_" : "l_", cables)) names.push_back(name);
        return names;
      }()) {}

void ComplianceTable::Add(const std::string& name, const TipResponse& response) {
  const char* const rows[kTip] = {"x", "y", "z", "rx", "ry", "rz"};
  for (Index i = 0; i < response.slope.cols(); ++i) {
    results_.Row();
    results_.Set("case", name);
    results_.Set("by", response.input[static_cast<std::size_t>(i)]);
    for (int row = 0; row < kTip; ++row) results_.Set(rows[row], response.slope(row, i));
    for (int k = 0; k < cables_; ++k) {
      results_.Set(cable_ + std::to_string(k + 1), response.slope(kTip + k, i));
    }
  }
  AddAxes(name, "force_", Ellipsoid(response, false));
  AddAxes(name, "drive_", Ellipsoid(response, true));
}

void ComplianceTable::AddAxes(const std::string& name, const std::string& kind,
                              const Eigen::Matrix3d& axes) {
  for (int i = 0; i < 3; ++i) {
    results_.Row();
    results_.Set("case", name);
    results_.Set("by", kind + std::to_string(i + 1));
    for (int row = 0; row < 3; ++row) results_.Set(std::string(1, "xyz"[row]), axes(row, i));
  }
}

}  // namespace continuum::statics
