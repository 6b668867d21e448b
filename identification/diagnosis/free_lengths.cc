#include "identification/diagnosis/free_lengths.h"

#include <algorithm>
#include <vector>

#include "effects/link_length.h"
#include "error.h"
#include "identification/diagnosis/diagnosis.h"
#include "identification/diagnosis/lengths_and_masses.h"
#include "identification/diagnosis/probing.h"
#include "sim/io/interrupt.h"

namespace continuum {
namespace {

// Of the logs left out, where there are any.
double ErrorOf(const TwoErrors& error) { return error.validate > 0 ? error.validate : error.train; }

// With the best of its candidates, named or not.
double LeastErrorOf(const Diagnosis& d) {
  double least = ErrorOf(d.before.error);
  for (const CandidateResult& c : d.candidates)
    if (c.was_fitted) least = std::min(least, ErrorOf(c.fitted.error));
  return least;
}

bool MayBeLengths(const Diagnosis& d) {
  return !d.noise.known() && !d.interrupted &&
         (d.Is(Verdict::Kind::kAmbiguous) || d.Is(Verdict::Kind::kUnexplained));
}

bool IsBetter(const Diagnosis& as_given, const Diagnosis& with_lengths) {
  const bool answers =
      with_lengths.Is(Verdict::Kind::kNamed) || with_lengths.Is(Verdict::Kind::kAdequate);
  return answers && !with_lengths.interrupted &&
         IsFarLess(ErrorOf(with_lengths.after()), LeastErrorOf(as_given), as_given.criteria);
}

// Whether another length changes the motion; a link that carries nothing has none.
bool Matters(const Hypothesis& h, const Experiment& e, const Diagnosis& d) {
  constexpr double kLonger = 1.01;
  try {
    const Problem problem(e, h.system, h.Free());
    const std::vector<bool> train = problem.TrainLogs();
    const auto there = problem.Residuals(Append(d.before.fit.x, {kLonger}), train);
    for (std::size_t l = 0; l < train.size(); ++l)
      if (train[l] && there[l] != d.before.residuals[l]) return true;
  } catch (const Error&) {
    StopIfRequested();  // else it is none that can be fitted
  }
  return false;
}

std::vector<Parameter> LengthsOfLinks(const Experiment& e, const ModelSpec& system,
                                      const Diagnosis& d) {
  constexpr std::size_t kMost = 6;
  const SearchBase base{&system, {}, {}};
  std::vector<Parameter> lengths;
  for (const Hypothesis& h : NumbersOfBodies({e, base, d.sizes})) {
    if (h.effect != LinkLength::kName || !Matters(h, e, d)) continue;
    lengths.push_back(FreeLength(h, d.criteria));
  }
  if (lengths.size() > kMost) lengths.clear();
  return lengths;
}

// In half of the time that the first answer has had.
DiagnosisOptions OnceMore(const DiagnosisOptions& options) {
  DiagnosisOptions more = options;
  more.time_share = options.time_share / 2;
  more.progress = Within({"with free lengths"}, options.progress);
  return more;
}

}  // namespace

Parameter FreeLength(const Hypothesis& h, const Criteria& criteria) {
  Parameter p = h.extra.front();
  p.name = "length of " + h.where;
  p.initial = 1, p.lower = 1 - criteria.lengths_off, p.upper = 1 + criteria.lengths_off;
  return p;
}

bool IsFarLess(double with_lengths, double as_given, const Criteria& criteria) {
  return with_lengths < criteria.lengths_gain * as_given;
}

Diagnosis DiagnoseWithLengths(Experiment& e, const ModelSpec& system,
                              const DiagnosisOptions& options) {
  Diagnosis as_given = Diagnose(e, system, options);
  if (!MayBeLengths(as_given)) return as_given;
  const std::vector<Parameter> lengths = LengthsOfLinks(e, system, as_given);
  if (lengths.empty()) return as_given;
  e.parameters.insert(e.parameters.end(), lengths.begin(), lengths.end());
  try {
    Diagnosis free = Diagnose(e, system, OnceMore(options));
    if (IsBetter(as_given, free)) {
      free.lengths_as_given = {as_given.verdict.word(), as_given.after()};
      free.seconds += as_given.seconds;
      return free;
    }
  } catch (const Error&) {
    StopIfRequested();  // else the first answer stands
  }
  e.parameters.resize(e.parameters.size() - lengths.size());
  return as_given;
}

}  // namespace continuum
