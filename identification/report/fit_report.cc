#include "identification/report/fit_report.h"

#include <string>

#include <fmt/format.h>

namespace continuum {

void AddParameterTable(Page& page, const std::vector<FreeParameter>& parameters,
                       const Eigen::VectorXd& x, const Uncertainty& u) {
  std::vector<std::vector<std::string>> rows;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = parameters[i];
    if (p.IsStart()) continue;
    const std::string range =
        u.known() ? fmt::format("{:.5g} … {:.5g}", u.lower[i], u.upper[i]) : "not computed";
    rows.push_back({p.name, fmt::format("{:.5g}", x[i]), p.unit,
                    u.known() ? fmt::format("{:.2g}", u.standard_error[i]) : "–",
                    range + (u.at_bound[i] ? ", at its bound" : ""),
                    u.step.size() ? fmt::format("{:.5g}", x[i] + u.step[i]) : "",
                    fmt::format("{:.5g}", p.initial)});
  }
  std::string note = "Intervals allow for residuals that are correlated in time";
  if (u.step.size()) note += ", and reach over what a fine time step would give";
  if (!u.known()) note = "Standard errors, intervals and correlations are " + u.lacks;
  page.Table({"parameter", "value", "unit", "standard error", "95 % interval",
              u.step.size() ? "at a fine step" : "", "start"},
             rows, {note + "."});
}

}  // namespace continuum
