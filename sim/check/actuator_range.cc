#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "sim/check/against_model.h"
#include "sim/io/units.h"

namespace continuum {
namespace {

struct Exceedance {
  std::size_t rows = 0, first = 0, worst = 0;
  double by = 0;  // of the worst row
};

Exceedance ExceedanceOf(const std::vector<double>& u, const double* range) {
  Exceedance exceedance;
  for (std::size_t k = 0; k < u.size(); ++k) {
    const double by = std::max(range[0] - u[k], u[k] - range[1]);
    if (!(by > 1e-9 * (range[1] - range[0]))) continue;
    if (exceedance.rows++ == 0) exceedance.first = k;
    if (by > exceedance.by) exceedance.worst = k, exceedance.by = by;
  }
  return exceedance;
}

// Rows on a limit: what was asked beyond it the log does not show. A limit of 0 is where a cable or
// chamber is let go.
void CheckLimit(const Input& in, const Log& log, const std::vector<double>& u, double limit,
                const char* which, Findings& out) {
  if (limit == 0) return;
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < u.size(); ++k) {
    if (std::abs(u[k] - limit) <= 1e-6 * std::abs(limit)) rows.push_back(k);
  }
  constexpr double kNoticeable = 0.02;
  const double share = static_cast<double>(rows.size()) / static_cast<double>(u.size());
  if (rows.size() < 5 || share < kNoticeable) return;
  out.Add(Finding::Severity::kInfo, in.column, "at_limit",
          fmt::format("is at the {} that actuator '{}' takes, {}, in {:.2g} % of the rows: "
                      "saturated, or held there on purpose",
                      which, in.actuator, Amount(limit / UnitFactor(in.unit, ""), in.unit),
                      100 * share),
          log.time[rows.front()], log.time[rows.back()]);
}

}  // namespace

void CheckRanges(const Experiment& e, const Log& log, const mjModel& m, Findings& out) {
  if (m.opt.disableflags & mjDSBL_CLAMPCTRL) return;
  for (std::size_t i = 0; i < e.inputs.size(); ++i) {
    const Input& in = e.inputs[i];
    const int a = mj_name2id(&m, mjOBJ_ACTUATOR, in.actuator.c_str());
    if (in.column.empty() || a < 0 || !m.actuator_ctrllimited[a]) continue;
    const double* const range = m.actuator_ctrlrange + 2 * a;
    CheckLimit(in, log, log.input[i], range[0], "smallest", out);
    CheckLimit(in, log, log.input[i], range[1], "largest", out);
    const Exceedance exceedance = ExceedanceOf(log.input[i], range);
    if (exceedance.rows == 0) continue;
    const double unit = UnitFactor(in.unit, ""), t = log.time[exceedance.worst];
    out.Add(
        Finding::Severity::kWarning, in.column, "out_of_range",
        fmt::format("leaves the range of actuator '{}', {:.4g} to {}, in {} of {} rows, most "
                    "by {} at t = {}: the model clamps it there",
                    in.actuator, range[0] / unit, Amount(range[1] / unit, in.unit), exceedance.rows,
                    log.rows(), Amount(exceedance.by / unit, in.unit), Clock(t)),
        log.time[exceedance.first], t);
  }
}

}  // namespace continuum
