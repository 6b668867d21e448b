#include "identification/sensitivity/smooth_path.h"

#include "identification/sensitivity/continuous_sensitivity.h"
#include "sim/simulation/trace_measurement.h"

namespace continuum {
namespace {

using AllDynamics = std::vector<std::unique_ptr<ContinuousDynamics>>;

std::vector<double> FirstSensitivities(const ContinuousDynamics& dynamics,
                                       const AllDynamics& perturbed) {
  std::vector<double> s;
  for (const auto& other : perturbed) {
    for (std::size_t i = 0; i < dynamics.size(); ++i)
      s.push_back((other->start()[i] - dynamics.start()[i]) / kPerturbation);
  }
  return s;
}

Ode EquationOf(ContinuousDynamics& dynamics, const AllDynamics& perturbed,
               ContinuousSensitivity& sensitivity) {
  Ode ode;
  ode.size = dynamics.size();
  ode.parameters = perturbed.size();
  ode.rate = [&dynamics](double t, const double* y, double* rate) { dynamics.Rate(t, y, rate); };
  ode.sensitivity = [&, near = std::vector<double>(ode.size)](
                        double t, const double* y, const double* rate, const Ode::States& s,
                        const Ode::States& rates) mutable {
    sensitivity.At(t, y);
    sensitivity.Rates(s, rates);
    for (std::size_t k = 0; k < s.size(); ++k) {
      if (sensitivity.Covers(k)) continue;
      for (std::size_t i = 0; i < near.size(); ++i) near[i] = y[i] + kPerturbation * s[k][i];
      perturbed[k]->Rate(t, near.data(), rates[k]);
      for (std::size_t i = 0; i < near.size(); ++i)
        rates[k][i] = (rates[k][i] - rate[i]) / kPerturbation;
    }
  };
  return ode;
}

// Lets recorders see every row that the solver reaches.
class Observation {
 public:
  Observation(ContinuousDynamics& dynamics, const AllDynamics& perturbed,
              ContinuousSensitivity& sensitivity, std::size_t rows)
      : dynamics_(dynamics),
        perturbed_(perturbed),
        sensitivity_(sensitivity),
        near_(dynamics.size()) {
    recorders_.emplace_back(dynamics.model(), dynamics.wiring(), rows);
    for (const auto& other : perturbed)
      recorders_.emplace_back(other->model(), other->wiring(), rows);
  }

  void Hold(std::size_t row) {
    dynamics_.Hold(row);
    for (const auto& other : perturbed_) other->Hold(row);
    sensitivity_.Forget();
  }
  void See(const Cvodes& solver) {
    dynamics_.Observe(solver.y(), recorders_[0]);
    std::vector<const double*> s;
    std::vector<Recorder*> recorders;
    for (std::size_t k = 0; k < perturbed_.size(); ++k)
      s.push_back(solver.s(k)), recorders.push_back(&recorders_[k + 1]);
    sensitivity_.Observe(s, recorders);
    for (std::size_t k = 0; k < perturbed_.size(); ++k) {
      if (sensitivity_.Observes(k)) continue;
      for (std::size_t i = 0; i < near_.size(); ++i)
        near_[i] = solver.y()[i] + kPerturbation * solver.s(k)[i];
      perturbed_[k]->Observe(near_.data(), recorders_[k + 1]);
    }
  }
  void Release(SmoothTraces& traces) {
    recorders_[0].Release(traces.trace);
    traces.perturbed.resize(perturbed_.size());
    for (std::size_t k = 0; k < perturbed_.size(); ++k)
      recorders_[k + 1].Release(traces.perturbed[k]);
  }

 private:
  ContinuousDynamics& dynamics_;
  const AllDynamics& perturbed_;
  ContinuousSensitivity& sensitivity_;
  std::vector<Recorder> recorders_;
  std::vector<double> near_;
};

}  // namespace

SmoothTraces SimulateSmooth(ContinuousDynamics& dynamics, const AllDynamics& perturbed,
                            const Experiment& e, const Log& log, const SolverOptions& how) {
  const std::size_t rows = log.rows();
  std::vector<double> breaks;  // times after each row at which the inputs are smooth no more
  breaks.assign(rows, log.time.back());
  for (std::size_t row = rows - 1; row-- > 0;)
    breaks[row] = BreaksAt(e, log, row + 1) ? log.time[row + 1] : breaks[row + 1];

  ContinuousSensitivity sensitivity(dynamics, perturbed, kPerturbation);
  Cvodes solver(EquationOf(dynamics, perturbed, sensitivity), how);
  Observation observation(dynamics, perturbed, sensitivity, rows);
  solver.Start(log.time[0], dynamics.start(), FirstSensitivities(dynamics, perturbed));
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
    if (solver.work().rates > how.most_rates) {
      traces.trace.diverged = true;
      traces.trace.diverged_at = log.time[row + 1];
      traces.trace.why = "CVODES takes too many evaluations of the motion";
      break;
    }
  }
  traces.work = solver.work();
  observation.Release(traces);
  MeasureTrace(e, dynamics.wiring(), log, traces.trace);
  return traces;
}

}  // namespace continuum
