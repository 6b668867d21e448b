// What the time step of a problem leaves open.
#include "identification/problem/problem.h"
#include "sim/numerics/shared_loop.h"
#include "sim/simulation/trace_measurement.h"
#include "sim/simulation/wiring.h"

namespace continuum {

// The same motion, measured later.
Trace Problem::Delayed(const Trace& trace, const Vector& x, std::size_t log, double delay) const {
  Experiment setup = MeasuredBy(x, log);
  for (Output& out : setup.outputs) out.measurement.delay += delay;
  Trace later = trace;
  MeasureTrace(setup, Wiring(setup, system().model()), experiment_->logs[log], later);
  return later;
}

std::vector<Problem::Matrix> Problem::StepEffects(const Vector& x, const std::vector<Vector>& r,
                                                  const std::vector<bool>& use) const {
  const double h = step();
  const auto motions = Motions(use);
  std::vector<Vector> quarter(use.size()), half(use.size()), later(use.size());
  const std::vector<std::vector<Vector>*> parts{&quarter, &half, &later};  // the longest first
  const auto simulate = [&](std::size_t thread, std::size_t task) {
    const std::size_t part = task / motions.size();
    const auto& logs = motions[task % motions.size()];
    const std::size_t first = logs.front();
    const Trace trace = part == 0   ? Run(thread, x, first, h / 4)
                        : part == 1 ? Run(thread, x, first, h / 2)
                                    : Delayed(Run(thread, x, first), x, first, h);
    for (const std::size_t l : logs) (*parts[part])[l] = ResidualOf(l, trace);
  };
  ShareOut(parts.size() * motions.size(), simulate, [&](auto& archive, std::size_t task) {
    for (const std::size_t l : motions[task % motions.size()])
      archive((*parts[task / motions.size()])[l]);
  });
  Count(motions.size());
  std::vector<Matrix> out(use.size());
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    out[l].resize(r[l].size(), 3);
    out[l].col(0) = r[l] - quarter[l];
    out[l].col(2) = r[l] - half[l] - 2.0 / 3 * out[l].col(0);
    for (const Eigen::Index c : {0, 2})
      if (!out[l].col(c).allFinite()) out[l].col(c).setZero();
    out[l].col(1) = later[l] - r[l];
    if (experiment_->quasi_static) out[l].col(1).setZero();  // rows know no time
  }
  return out;
}

}  // namespace continuum
