#include "models/stiff_flop/reach.h"

#include "models/stiff_flop/details.h"
#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/response.h"

namespace continuum::stiff_flop {

using Eigen::VectorXd;

statics::Reached Reach(const ModuleSeries& series, const Method& method, const Case& row,
                       const statics::Target& target) {
  Case at = row;
  const auto stand = [&](const VectorXd& drives) -> std::optional<statics::Stand> {
    at.given = drives;
    const Solution s = SolveForward(series, method, at, false);
    if (s.status != Status::kOk) return std::nullopt;
    const auto response = Respond(series, method, at, s);
    if (!response) return std::nullopt;
    const auto ends = EndsOf(series, method, at, s);
    const VectorXd points = VectorXd::Map(ends.data(), ends.size());
    const Eigen::MatrixXd slopes =
        response->slope.bottomRows(points.size()).rightCols(series.lines());
    return statics::Stand{points(target.coordinate), slopes(target.coordinate, Eigen::all)};
  };
  return statics::Reach(stand, row.given, target, series.first().E, series.length());
}

}  // namespace continuum::stiff_flop
