#include "identification/problem/last_runs.h"

#include <algorithm>
#include <utility>

#include "sim/numerics/parallel.h"

namespace continuum {
namespace {

// Fits come back to where they were a few simulations ago: so many are kept, if they are small.
constexpr std::size_t kSome = 12, kNumbers = 100000;

// How many of one motion are worth their memory.
std::size_t MostOf(const LastRun& run) {
  std::size_t numbers = 1;
  for (const auto* const all : {&run.trace.raw, &run.trace.axes}) {
    for (const auto& output : *all)
      for (const auto& row : output) numbers += row.size();
  }
  for (const auto& channel : run.trace.channel) numbers += channel.size();
  return std::max(ThreadCount(), std::min(kSome, kNumbers / numbers));
}

}  // namespace

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
  const std::size_t most = MostOf(run);
  auto kept = std::make_shared<const LastRun>(std::move(run));
  const std::lock_guard lock(mutex_);
  Runs& runs = runs_[motion];
  runs.push_front(std::move(kept));
  while (runs.size() > most) runs.pop_back();
}

void LastRuns::KeepBehind(std::size_t motion, LastRun run) {
  const std::size_t most = MostOf(run), threads = ThreadCount();
  if (most <= threads || Find(motion, run)) return;
  auto kept = std::make_shared<const LastRun>(std::move(run));
  const std::lock_guard lock(mutex_);
  Runs& runs = runs_[motion];
  runs.insert(runs.begin() + static_cast<std::ptrdiff_t>(std::min(threads, runs.size())),
              std::move(kept));
  while (runs.size() > most) runs.pop_back();
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
