#include "identification/diagnosis/extension.h"

#include "identification/diagnosis/candidate_fitter.h"
#include "identification/diagnosis/next_experiment.h"
#include "identification/problem/extended_model.h"
#include "identification/statistics/uncertainty.h"
#include "sim/io/file.h"
#include "sim/replay/replay.h"

namespace continuum {
namespace {

// With the cause that was chosen, or the model before.
ExtendedModel Extended(const Experiment& e, const Diagnosis& d, const CandidateResult* chosen,
                       const std::filesystem::path& folder) {
  return chosen ? Extend(ProblemOf(*chosen, e), chosen->hypothesis.system, chosen->fitted.fit.x,
                         folder, kExtendedModel)
                : Extend(Problem(e, d.system), d.system, d.before.fit.x, folder, kExtendedModel);
}

// What cannot be written ends the job: only what cannot be made is a missing part.
void WriteExtended(const ExtendedModel& extended, const std::filesystem::path& folder) {
  WriteOrRemove(folder / kExtendedModel, extended.xml);
  WriteOrRemove(folder / kExtendedExperiment, extended.yaml);
}

void RunExtended(const std::filesystem::path& folder, ExtensionRun& run) {
  Experiment extended = Experiment::Read(folder / kExtendedExperiment);
  const auto replayed = Replay(extended, ModelSpec::Load(folder / kExtendedModel));
  const SplitError error = PooledError(extended, replayed);
  run.after = {error.train, error.validate};
  for (const Replayed& r : replayed) run.after_traces.push_back(r.trace);
}

// With a cause, or without one (null).
void WriteAndRun(const Experiment& e, const Diagnosis& d, const CandidateResult* chosen,
                 const std::filesystem::path& folder, ExtensionRun& run) {
  run.after = chosen ? chosen->fitted.error : d.before.error;
  run.after_traces.clear();
  const bool made = MakePart("extended model", run.missing,
                             [&] { run.extended = Extended(e, d, chosen, folder); });
  WriteExtended(run.extended, folder);
  if (made)
    MakePart("errors of the extended files", run.missing, [&] { RunExtended(folder, run); });
}

// Of the logs that are not fitted, at a quarter of the time step and with the values that a fit
// would have there.
double HeldOutErrorFinely(const Problem& problem, const Fitted& fitted) {
  std::vector<bool> held_out = problem.TrainLogs();
  held_out.flip();
  Problem::Vector x = fitted.fit.x;
  if (fitted.complete() && fitted.sensitivities->uncertainty.step.size() == x.size())
    x += fitted.sensitivities->uncertainty.step;
  const Problem fine = AtQuarter(problem);
  return fine.PooledRms(fine.Residuals(fine.Clamp(x), held_out), held_out);
}

// A coarse step may add more to logs left out than the cause takes off.
std::optional<double> RemovedFinely(const Experiment& e, const Diagnosis& d) {
  const double before = HeldOutErrorFinely(Problem(e, d.system), d.before),
               after = HeldOutErrorFinely(ProblemOf(*d.chosen(), e), d.chosen()->fitted);
  if (!(after < before)) return {};
  return 1 - after / before;
}

}  // namespace

ExtensionRun MeasureExtension(const Experiment& e, const Diagnosis& d,
                              const std::filesystem::path& folder) {
  ExtensionRun run;
  MakePart("model before", run.missing, [&] { run.model_before = d.system.Xml({}, {}, folder); });
  WriteAndRun(e, d, d.chosen(), folder, run);
  run.offered = d.chosen() && !(run.after.validate > d.before.error.validate);
  if (d.chosen() && !run.offered) {
    WriteAndRun(e, d, nullptr, folder, run);
    MakePart("errors at a finer time step", run.missing,
             [&] { run.removed_finely = RemovedFinely(e, d); });
  }
  if (d.fallback) {
    MakePart("fallback", run.missing, [&] {
      run.fallback = Extend(ProblemOf(*d.fallback, e), d.fallback->hypothesis.system,
                            d.fallback->fitted.fit.x, folder, kFallbackModel);
    });
  }
  if (d.next.log) {
    MakePart("inputs of the next experiment", run.missing,
             [&] { run.next_inputs = NextCsv(e, *d.next.log); });
  }
  MakePart("deviations", run.missing, [&] {
    const Problem null(e, d.system);
    for (std::size_t l = 0; l < e.logs.size(); ++l)
      run.before_traces.push_back(null.Predict(d.before.fit.x, l));
    run.deviations = FindDeviations(e, run.before_traces);
  });
  MakePart("log check", run.missing, [&] { run.findings = CheckLogs(e); });
  return run;
}

}  // namespace continuum
