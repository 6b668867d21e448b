#include "sim/replay/replay.h"

#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "sim/experiment/measurement_model.h"
#include "sim/model/attribute_bounds.h"
#include "sim/numerics/parallel.h"
#include "sim/simulation/output_units.h"
#include "sim/simulation/registration_fit.h"
#include "sim/simulation/simulate.h"
#include "sim/simulation/trace_measurement.h"
#include "sim/simulation/wiring.h"

namespace continuum {

void CheckNames(const Experiment& e, const ModelSpec& system) {
  CheckUnits(e, system.model());
  for (const Log& log : e.logs) {
    if (log.set.empty()) continue;
    try {
      for (const Change& change : log.set) {
        RequirePossible(change);
        if (IsMeasurement(change.target, change.attribute))
          MeasurementValue(e, change.target, change.attribute);
      }
      system.Build(SettingsOfModel(log));
    } catch (const Error& error) {
      throw Error::Input(log.set_where + " (log '" + log.label + "')", error.what());
    }
  }
}

std::vector<Replayed> Replay(Experiment& e, const ModelSpec& system,
                             const ProgressCallback& progress) {
  Experiment setup = WithoutLogs(e);
  std::vector<Trace> traces(e.logs.size());
  std::mutex one_at_a_time;
  std::size_t begun = 0;
  const auto build = [&](const Log& log) {
    const std::lock_guard lock(one_at_a_time);
    if (progress) progress({"replay", begun++, e.logs.size(), log.label});
    return system.Build(SettingsOfModel(log));
  };
  ParallelFor(e.logs.size(), [&](std::size_t, std::size_t l) {
    ModelAndData machine = build(e.logs[l]);
    traces[l] = Simulate(machine, MeasuredIn(setup, e.logs[l]), e.logs[l], {}, Hooks::Stoppable());
  });
  for (std::size_t l = 0; l < traces.size(); ++l)
    if (traces[l].diverged) throw Error::Job(e.logs[l].label + ": " + traces[l].Failure());
  const Wiring wiring(e, system.model());
  e.registration = setup.registration = Registered(e, wiring, system.model(), traces);
  std::vector<Replayed> out;
  for (std::size_t l = 0; l < traces.size(); ++l) {
    const Log& log = e.logs[l];
    if (e.registration.estimates()) MeasureTrace(MeasuredIn(setup, log), wiring, log, traces[l]);
    out.push_back({std::move(traces[l]), {}});
    out.back().score = ScoreLog(e, log, out.back().trace);
  }
  return out;
}

SplitError PooledError(const Experiment& e, const std::vector<Replayed>& logs) {
  const Pool pool(e);
  Pool::Sum train, validate;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    pool.Add(Residuals(e, e.logs[l], logs[l].trace), e.logs[l].train ? train : validate);
  }
  return {train.Rms(), validate.Rms()};
}

}  // namespace continuum
