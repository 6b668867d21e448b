#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include <Eigen/Core>

#include "sim/model/change.h"
#include "sim/simulation/trace.h"

namespace continuum {

/// A simulation and what it was made of.
struct LastRun {
  std::vector<Change> changes, starts;
  Eigen::VectorXd theta;  ///< of force terms
  double skew = 0;
  Trace trace = {};

  bool IsOf(const LastRun& other) const {
    return changes == other.changes && starts == other.starts && theta == other.theta &&
           skew == other.skew;
  }
};

/// The last simulations of each motion: at least one for each thread that may fit it, more where
/// they are short. May be used by several threads at once.
class LastRuns {
 public:
  explicit LastRuns(std::size_t motions);
  LastRuns(const LastRuns& other);
  LastRuns& operator=(const LastRuns& other);

  void Keep(std::size_t motion, LastRun run);
  /// The same of one beside the last, as for a slope: it never takes the place of those of Keep.
  void KeepBehind(std::size_t motion, LastRun run);
  /// Made of the same as another; null: it is not among them.
  std::shared_ptr<const LastRun> Find(std::size_t motion, const LastRun& made_of) const;
  void Forget();

 private:
  using Runs = std::deque<std::shared_ptr<const LastRun>>;
  std::vector<Runs> All() const;

  mutable std::mutex mutex_;
  std::vector<Runs> runs_;  // [motion] the newest first, but for those beside
};

}  // namespace continuum
