#include "identification/sensitivity/smooth_path.h"

#include "identification/sensitivity/continuous_sensitivity.h"

namespace continuum {
namespace {

using Flows = std::vector<std::unique_ptr<ContinuousDynamics>>;

std::vector<double> FirstSensitivities(const ContinuousDynamics& flow, const Flows& neighbours) {
  std::vector<double> s;
  for (const auto& neighbour : neighbours) {
    for (std::size_t i = 0; i < flow.size(); ++i)
      s.push_back((neighbour->start()[i] - flow.start()[i]) / kMove);
  }
  return s;
}

Ode EquationOf(ContinuousDynamics& flow, const Flows& neighbours, ContinuousSensitivity& tangent) {
  Ode ode;
  ode.size = flow.size();
  ode.parameters = neighbours.size();
  ode.rate = [&flow](double t, const double* y, double* rate) { flow.Rate(t, y, rate); };
  ode.sensitivity = [&, near = std::vector<double>(ode.size)](
                        double t, const double* y, const double* rate, const Ode::States& s,
                        const Ode::States& rates) mutable {
    tangent.At(t, y);
    tangent.Rates(s, rates);
    for (std::size_t k = 0; k < s.size(); ++k) {
      if (tangent.Covers(k)) continue;
      for (std::size_t i = 0; i < near.size(); ++i) near[i] = y[i] + kMove * s[k][i];
      neighbours[k]->Rate(t, near.data(), rates[k]);
      for (std::size_t i = 0; i < near.size(); ++i) rates[k][i] = (rates[k][i] - rate[i]) / kMove;
    }
  };
  return ode;
}

// Lets recorders see every row that the solver reaches.
class Observation {
 public:
  Observation(ContinuousDynamics& flow, const Flows& neighbours, ContinuousSensitivity& tangent,
              std::size_t rows)
      : flow_(flow), neighbours_(neighbours), tangent_(tangent), near_(flow.size()) {
    recorders_.emplace_back(flow.model(), flow.wiring(), rows);
    for (const auto& other : neighbours)
      recorders_.emplace_back(other->model(), other->wiring(), rows);
  }

  void Hold(std::size_t row) {
    flow_.Hold(row);
    for (const auto& other : neighbours_) other->Hold(row);
    tangent_.Forget();
  }
  void See(const Cvodes& solver) {
    flow_.Observe(solver.y(), recorders_[0]);
    std::vector<const double*> s;
    std::vector<Recorder*> recorders;
    for (std::size_t k = 0; k < neighbours_.size(); ++k)
      s.push_back(solver.s(k)), recorders.push_back(&recorders_[k + 1]);
    tangent_.Observe(s, recorders);
    for (std::size_t k = 0; k < neighbours_.size(); ++k) {
      if (tangent_.Covers(k)) continue;
      for (std::size_t i = 0; i < near_.size(); ++i)
        near_[i] = solver.y()[i] + kMove * solver.s(k)[i];
      neighbours_[k]->Observe(near_.data(), recorders_[k + 1]);
    }
  }
  void Release(SmoothTraces& traces) {
    recorders_[0].Release(traces.trace);
    traces.moved.resize(neighbours_.size());
    for (std::size_t k = 0; k < neighbours_.size(); ++k) recorders_[k + 1].Release(traces.moved[k]);
  }

 private:
  ContinuousDynamics& flow_;
  const Flows& neighbours_;
  ContinuousSensitivity& tangent_;
  std::vector<Recorder> recorders_;
  std::vector<double> near_;
};

}  // namespace

SmoothTraces FollowFlow(ContinuousDynamics& flow, const Flows& neighbours, const Experiment& e,
                        const Log& log, const SolverOptions& how) {
  const std::size_t rows = log.rows();
  std::vector<double> breaks;  // times after each row at which the inputs are smooth no more
  breaks.assign(rows, log.time.back());
  for (std::size_t row = rows - 1; row-- > 0;)
    breaks[row] = BreaksAt(e, log, row + 1) ? log.time[row + 1] : breaks[row + 1];

  ContinuousSensitivity tangent(flow, neighbours, kMove);
  Cvodes solver(EquationOf(flow, neighbours, tangent), how);
  Observation observation(flow, neighbours, tangent, rows);
  solver.Start(log.time[0], flow.start(), FirstSensitivities(flow, neighbours));
  SmoothTraces traces;
  for (std::size_t row = 0; row < rows; ++row) {
    observation.Hold(row);
    if (row > 0 && breaks[row - 1] == log.time[row]) solver.Restart(log.time[row]);
    observation.See(solver);
    if (row + 1 == rows) break;
    if (!solver.Advance(log.time[row + 1], breaks[row])) {
      traces.trace.diverged = true;
      traces.trace.diverged_at = log.time[row];
      traces.trace.why = "CVODES: " + solver.failure();
      break;
    }
  }
  traces.work = solver.work();
  observation.Release(traces);
  MeasureTrace(e, flow.wiring(), log, traces.trace);
  return traces;
}

}  // namespace continuum
