#include "identification/problem/last_runs.h"

#include <algorithm>
#include <utility>

#include "sim/numerics/parallel.h"

namespace continuum {

LastRuns::LastRuns(std::size_t motions) : runs_(motions) {}

LastRuns::LastRuns(const LastRuns& other) : runs_(other.All()) {}

LastRuns& LastRuns::operator=(const LastRuns& other) {
  auto all = other.All();
  const std::lock_guard lock(mutex_);
  runs_ = std::move(all);
  return *this;
}

std::vector<LastRuns::Runs> LastRuns::All() const {
  const std::lock_guard lock(mutex_);
  return runs_;
}

void LastRuns::Keep(std::size_t motion, LastRun run) {
  auto kept = std::make_shared<const LastRun>(std::move(run));
  const std::lock_guard lock(mutex_);
  Runs& runs = runs_[motion];
  runs.push_front(std::move(kept));
  if (runs.size() > ThreadCount()) runs.pop_back();
}

std::shared_ptr<const LastRun> LastRuns::Find(std::size_t motion, const LastRun& made_of) const {
  const std::lock_guard lock(mutex_);
  const Runs& runs = runs_[motion];
  const auto found =
      std::find_if(runs.begin(), runs.end(), [&](const auto& run) { return run->IsOf(made_of); });
  return found == runs.end() ? nullptr : *found;
}

void LastRuns::Forget() {
  const std::lock_guard lock(mutex_);
  for (Runs& runs : runs_) runs.clear();
}

}  // namespace continuum
