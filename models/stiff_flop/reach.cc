#include "models/stiff_flop/reach.h"

#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/response.h"

namespace continuum::stiff_flop {

using Eigen::VectorXd;

statics::Reached Reach(const Module& module, const Method& method, const Case& row,
                       const statics::Target& target) {
  Case at = row;
  const auto stand = [&](const VectorXd& drives) -> std::optional<statics::Stand> {
    at.given = drives;
    const Solution s = SolveForward(module, method, at, false);
    if (s.status != Status::kOk) return std::nullopt;
    const auto response = Respond(module, method, at, s);
    if (!response) return std::nullopt;
    const Eigen::MatrixXd slopes = response->slope.topRightCorner(3, 3);
    return statics::Stand{s.tip(target.coordinate), slopes(target.coordinate, Eigen::all)};
  };
  return statics::Reach(stand, row.given, target, module.E, module.l);
}

}  // namespace continuum::stiff_flop
