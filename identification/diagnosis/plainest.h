#pragma once

#include <utility>

#include <Eigen/Core>

namespace continuum {

/// What solve finds with only one of several columns, where that explains nearly as much; else with
/// all. Laws of several amplitudes that do nearly the same would begin with large ones that cancel.
/// solve: of columns, some of them zero; amount: what a solution explains.
template <class Solve, class Amount>
auto PlainestOf(const Eigen::MatrixXd& columns, Solve solve, Amount amount) {
  constexpr double kNearly = 0.9;
  auto best = solve(columns);
  double most = kNearly * amount(best);
  for (Eigen::Index i = 0; i < columns.cols() && columns.cols() > 1; ++i) {
    if (!(columns.col(i).squaredNorm() > 0)) continue;
    Eigen::MatrixXd one = Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
    one.col(i) = columns.col(i);
    auto alone = solve(one);
    if (amount(alone) < most) continue;
    most = amount(alone), best = std::move(alone);
  }
  return best;
}

}  // namespace continuum
