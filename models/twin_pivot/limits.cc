#include "models/twin_pivot/limits.h"

#include <fmt/format.h>

#include "models/twin_pivot/details.h"

namespace continuum::twin_pivot {

Extent::Extent(const Robot& robot, const Load& load, const Solution& solution)
    : strain(Strain(robot, solution.beta)) {
  if (load.condition == Condition::kI || load.condition == Condition::kIII) return;
  theta = 0.5 * solution.beta.cwiseAbs().maxCoeff();  // every joint has cables
}

std::string Extent::Beyond(const Robot& robot) const {
  std::string text;
  if (BeyondStrain(robot)) text = fmt::format("strain {:.3g} > {:.3g}", strain, robot.strain_limit);
  if (!BeyondTheta(robot)) return text;
  return text + (text.empty() ? "" : "; ") +
         fmt::format("theta {:.3g} > {:.3g} rad", theta, robot.theta_max);
}

}  // namespace continuum::twin_pivot
