#pragma once

#include <string>

#include "sim/numerics/solver.h"

namespace continuum::numerics {

/// Thrown where a job has cost more linear systems than it may. `where`: how far it had come.
struct GaveUp {
  long systems = 0;
  std::string where = {};

  /// "given up after 20000 linear systems, at 0.02 of the rising load".
  std::string Sentence() const;
};

/// How many linear systems may be solved on this thread from here on, while it lives. It counts
/// systems and not seconds, so that results repeat. Limits nest: each counts what those within it
/// spend.
class WorkLimit {
 public:
  explicit WorkLimit(long most);
  ~WorkLimit();
  WorkLimit(const WorkLimit&) = delete;
  WorkLimit& operator=(const WorkLimit&) = delete;

  long spent() const { return spent_; }
  bool exceeded() const { return spent_ > most_; }

  /// Counts systems in every limit of this thread. @throws GaveUp above one.
  static void Spend(long systems = 1);

 private:
  long most_, spent_ = 0;
  WorkLimit* outer_;
};

/// Timed, and given up after so many linear systems: then not ok, and `why` says so. Also where a
/// solver within was given up for this limit and the job went on without it.
template <class Solve>
Outcome Limited(long most, Solve&& solve) {
  return Timed([&] {
    const WorkLimit limit(most);
    const auto given_up = [&](const GaveUp& at) {
      Outcome outcome;
      outcome.iterations = static_cast<int>(limit.spent());
      return internal::Failed(outcome, Status::kNoConvergence, at.Sentence());
    };
    try {
      Outcome outcome = solve();
      return !outcome.ok() && limit.exceeded() ? given_up({limit.spent()}) : outcome;
    } catch (const GaveUp& at) {
      return given_up(at);
    }
  });
}

}  // namespace continuum::numerics
