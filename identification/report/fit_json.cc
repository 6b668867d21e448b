#include "identification/report/fit_json.h"

#include <nlohmann/json.hpp>

namespace continuum {

nlohmann::json ParametersJson(const std::vector<FreeParameter>& parameters,
                              const Eigen::VectorXd& x, const Uncertainty& u) {
  auto all = nlohmann::json::array();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = parameters[i];
    const double edge = 1e-9 * p.scale;
    all.push_back({{"name", p.name},
                   {"unit", p.unit},
                   {"value", x[i]},
                   {"standard_error", u.standard_error[i]},
                   {"ci95", {u.lower[i], u.upper[i]}},
                   {"lower", p.lower},
                   {"upper", p.upper},
                   {"start", p.initial},
                   {"at_bound", static_cast<bool>(u.at_bound[i])},
                   {"start_at_bound", p.initial <= p.lower + edge || p.initial >= p.upper - edge}});
    if (u.step.size()) all.back()["fine_step"] = x[i] + u.step[i];
  }
  return all;
}

}  // namespace continuum
