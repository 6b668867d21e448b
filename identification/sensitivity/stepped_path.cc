#include "identification/sensitivity/stepped_path.h"

#include "identification/sensitivity/smooth_path.h"
#include "identification/sensitivity/step_sensitivity.h"
#include "sim/simulation/input_signals.h"
#include "sim/simulation/simulate.h"
#include "sim/simulation/trace_measurement.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

std::vector<double> Difference(const std::vector<double>& there, const std::vector<double>& here) {
  std::vector<double> s(here.size());
  for (std::size_t i = 0; i < s.size(); ++i) s[i] = (there[i] - here[i]) / kPerturbation;
  return s;
}

// The perturbed models, followed beside the machine.
class PerturbedRuns {
 public:
  PerturbedRuns(const PerturbedRun& trial, std::vector<PerturbedRun>& perturbed,
                const Experiment& e, const Log& log, const Wiring& wiring)
      : sensitivity_(trial.machine, wiring, Machines(perturbed), kPerturbation,
                     Mirrored(perturbed)) {
    for (std::size_t k = 0; k < perturbed.size(); ++k) {
      const PerturbedRun& other = perturbed[k];
      AddInputs(other.machine, e, log, wiring);
      if (other.mirrored.model) AddInputs(other.mirrored, e, log, wiring);
      recorders_.emplace_back(*trial.machine.model, wiring, log.rows());
      if (sensitivity_.Covers(k))
        sensitivity_.Start(k, {Difference(other.q, trial.q), Difference(other.v, trial.v),
                               Difference(other.w, trial.w), Difference(other.z, trial.z)});
    }
  }

  Hooks MakeHooks() {
    Hooks hooks;
    hooks.step = [this](const mjModel& m, mjData& d) { sensitivity_.Before(m, d); };
    hooks.row = [this](const mjModel& m, mjData& d, std::size_t row) {
      for (auto& [inputs, data] : inputs_) inputs.AtRow(*data, row);  // actuators are switched too
      if (closed_form_) sensitivity_.Observe(m, d, row, recorders_);
    };
    hooks.stepped = [this](const mjModel& m, mjData& d) {
      closed_form_ = closed_form_ && sensitivity_.After(m, d);
    };
    return hooks;
  }

  std::string WhyNot(std::size_t k) const {
    return closed_form_ ? sensitivity_.WhyNot(k) : sensitivity_.failure();
  }
  Trace Release(std::size_t k) {
    Trace perturbed;
    recorders_[k].Release(perturbed);
    return perturbed;
  }

 private:
  static std::vector<const ModelAndData*> Machines(const std::vector<PerturbedRun>& trials) {
    std::vector<const ModelAndData*> machines;
    for (const PerturbedRun& trial : trials) machines.push_back(&trial.machine);
    return machines;
  }
  static std::vector<const ModelAndData*> Mirrored(const std::vector<PerturbedRun>& trials) {
    std::vector<const ModelAndData*> machines;
    for (const PerturbedRun& trial : trials)
      machines.push_back(trial.mirrored.model ? &trial.mirrored : nullptr);
    return machines;
  }
  void AddInputs(const ModelAndData& machine, const Experiment& e, const Log& log,
                 const Wiring& wiring) {
    inputs_.emplace_back(Inputs(*machine.model, e, log, wiring), machine.data.get());
  }

  StepSensitivity sensitivity_;
  std::vector<std::pair<Inputs, mjData*>> inputs_;
  std::vector<Recorder> recorders_;
  bool closed_form_ = true;  ///< whether it has held so far
};

}  // namespace

SteppedTraces SimulateStepped(PerturbedRun& trial, std::vector<PerturbedRun>& perturbed,
                              const Experiment& e, const Log& log) {
  SteppedTraces traces;
  traces.perturbed.resize(perturbed.size()), traces.why_not.resize(perturbed.size());
  const Wiring wiring(e, *trial.machine.model);
  PerturbedRuns runs(trial, perturbed, e, log, wiring);
  traces.trace = Simulate(trial.machine, e, log, {trial.q, trial.v}, runs.MakeHooks());
  for (std::size_t k = 0; k < perturbed.size(); ++k) {
    traces.why_not[k] = traces.trace.diverged ? "the simulation diverges" : runs.WhyNot(k);
    if (!traces.why_not[k].empty()) continue;
    traces.perturbed[k] = runs.Release(k);
    MeasureTrace(e, wiring, log, traces.perturbed[k]);
  }
  return traces;
}

}  // namespace continuum
