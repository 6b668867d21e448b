#include "identification/sensitivity/stepped_path.h"

#include "identification/sensitivity/smooth_path.h"
#include "identification/sensitivity/step_sensitivity.h"
#include "sim/simulation/input_signals.h"

namespace continuum {
namespace {

std::vector<double> Apart(const std::vector<double>& there, const std::vector<double>& here) {
  std::vector<double> s(here.size());
  for (std::size_t i = 0; i < s.size(); ++i) s[i] = (there[i] - here[i]) / kMove;
  return s;
}

// The neighbours on their way beside the machine.
class Company {
 public:
  Company(const PerturbedRun& trial, std::vector<PerturbedRun>& neighbours, const Experiment& e,
          const Log& log, const Wiring& wiring)
      : neighbours_(neighbours), tangent_(*trial.machine.model, wiring, Models(neighbours), kMove) {
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
      const PerturbedRun& other = neighbours[k];
      inputs_.emplace_back(*other.machine.model, e, log, wiring);
      recorders_.emplace_back(*trial.machine.model, wiring, log.rows());
      if (tangent_.Covers(k))
        tangent_.Start(k, Apart(other.q, trial.q), Apart(other.v, trial.v),
                       Apart(other.w, trial.w));
    }
  }

  Hooks Along() {
    Hooks hooks;
    hooks.step = [this](const mjModel& m, mjData& d) { tangent_.Before(m, d); };
    hooks.row = [this](const mjModel& m, mjData& d, std::size_t row) {
      for (std::size_t k = 0; k < neighbours_.size(); ++k)
        inputs_[k].AtRow(*neighbours_[k].machine.data, row);  // its actuators are switched too
      if (reaches_) tangent_.Observe(m, d, row, recorders_);
    };
    hooks.stepped = [this](const mjModel& m, mjData& d) {
      reaches_ = reaches_ && tangent_.After(m, d);
    };
    return hooks;
  }

  std::optional<Trace> Release(std::size_t k) {
    if (!reaches_ || !tangent_.Covers(k)) return {};
    Trace moved;
    recorders_[k].Release(moved);
    return moved;
  }

 private:
  static std::vector<const mjModel*> Models(const std::vector<PerturbedRun>& trials) {
    std::vector<const mjModel*> models;
    for (const PerturbedRun& trial : trials) models.push_back(trial.machine.model.get());
    return models;
  }

  std::vector<PerturbedRun>& neighbours_;
  StepSensitivity tangent_;
  std::vector<Inputs> inputs_;
  std::vector<Recorder> recorders_;
  bool reaches_ = true;  ///< the closed form, so far
};

}  // namespace

SteppedTraces FollowSteps(PerturbedRun& trial, std::vector<PerturbedRun>& neighbours,
                          const Experiment& e, const Log& log) {
  SteppedTraces traces;
  traces.moved.resize(neighbours.size());
  const Wiring wiring(e, *trial.machine.model);
  Company company(trial, neighbours, e, log, wiring);
  traces.trace = Simulate(trial.machine, e, log, {trial.q, trial.v}, company.Along());
  if (traces.trace.diverged) return traces;
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    traces.moved[k] = company.Release(k);
    if (traces.moved[k]) MeasureTrace(e, wiring, log, *traces.moved[k]);
  }
  return traces;
}

}  // namespace continuum
