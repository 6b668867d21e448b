#include "sim/numerics/shared_loop.h"

#include <cstdint>
#include <vector>

#include "error.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/hand_out.h"
#include "sim/numerics/parallel.h"
#include "sim/numerics/parallel_scope.h"
#include "sim/numerics/rank_dialogue.h"
#include "sim/numerics/ranks.h"

namespace continuum {
namespace {

using Work = std::function<void(std::size_t thread, std::size_t i)>;
using Pack = std::function<std::string(std::size_t i)>;
using Unpack = std::function<void(std::size_t i, const std::string& bytes)>;

enum class On { kThreads, kRank };  // each thread of a rank has tasks of its own, or one has all

bool is_task = false;  // whether this rank works on tasks

// While it is there, loops run on this rank alone.
class AtTasks {
 public:
  AtTasks() { is_task = true; }
  ~AtTasks() { is_task = false; }
  AtTasks(const AtTasks&) = delete;
};

template <class Side, class Work>
void Share(Side& side, const Work& work) {
  for (std::size_t i = side.Next(); i != kNoTask; i = side.Next()) {
    side.Finish(i, work(i));
    ++OwnLoad().tasks;
  }
}

// The result of a task: its bytes, or the error that it threw.
struct Result {
  std::string bytes, error;
  Error::Kind kind = Error::Kind::kJob;
};

template <class A>
void Fields(A& a, Result& r) {
  a(r.bytes, r.error, r.kind);
}

[[noreturn]] void Throw(const Result& r) {
  if (r.kind == Error::Kind::kInput) throw Error::Input("", r.error);
  throw Error::Job(r.error);
}

// Of all tasks, on every rank. work gives the bytes of a Result.
std::vector<Result> ResultsOf(
    std::size_t n, On on,
    const std::function<std::string(std::size_t thread, std::size_t i)>& work) {
  const auto run = [&](auto& side) {
    const auto share = [&](std::size_t thread, std::size_t) {
      Share(side, [&](std::size_t i) { return work(thread, i); });
    };
    const AtTasks alone;
    if (on == On::kRank) return share(0, 0);
    ParallelFor(ThreadCount(), share);
  };
  if (ThisRank() > 0) {
    Follower follower(n);
    run(follower);
    return FromBytes<std::vector<Result>>(follower.Wait());
  }
  std::vector<Result> all(n);
  Leader leader(
      n, [&](std::size_t i, const std::string& bytes) { all[i] = FromBytes<Result>(bytes); });
  run(leader);
  leader.Wait();
  leader.EndAll(ToBytes(all));
  return all;
}

// Runs tasks on all ranks, and has what they store on each.
void ShareAll(std::size_t n, On on, const Work& work, const Pack& pack, const Unpack& unpack) {
  std::vector<std::uint8_t> here(n, 0);
  const auto all = ResultsOf(n, on, [&](std::size_t thread, std::size_t i) {
    here[i] = 1;
    Result result;
    try {
      work(thread, i);
      result.bytes = pack(i);
    } catch (const Error& error) {
      result.error = error.what(), result.kind = error.kind();
    }
    return ToBytes(result);
  });
  for (const Result& result : all)
    if (!result.error.empty()) Throw(result);
  for (std::size_t i = 0; i < n; ++i)
    if (!here[i]) unpack(i, all[i].bytes);
}

// Whether there is no other rank to share with here.
bool IsAlone() { return RankCount() == 1 || InParallelFor() || is_task; }

}  // namespace

void HandOut(std::size_t n, const std::function<std::string(std::size_t i)>& work,
             const std::function<void(std::size_t i, const std::string& result)>& take) {
  if (RankCount() == 1) {
    for (std::size_t i = 0; i < n && !StopRequested(); ++i) take(i, work(i));
    StopIfRequested();
  } else if (ThisRank() == 0) {
    Leader leader(n, take);
    Share(leader, work);
    leader.Wait();
    leader.EndAll("");
  } else {
    Follower follower(n);
    Share(follower, work);
  }
}

void ShareOut(std::size_t n, const Work& work, const Pack& pack, const Unpack& unpack) {
  if (IsAlone() || n < 2) return ParallelFor(n, work);
  ShareAll(n, On::kThreads, work, pack, unpack);
}

void ShareTasks(std::size_t n, const std::function<void(std::size_t i)>& work, const Pack& pack,
                const Unpack& unpack) {
  const auto task = [&](std::size_t, std::size_t i) { work(i); };
  if (!IsAlone() && n > 1) return ShareAll(n, On::kRank, task, pack, unpack);
  if (RankCount() == 1 && n >= ThreadCount()) return ParallelFor(n, task);
  for (std::size_t i = 0; i < n; ++i) work(i);
}

void OnFirstRank(const std::function<void()>& work, const std::function<std::string()>& pack,
                 const std::function<void(const std::string& bytes)>& unpack) {
  if (IsAlone()) return work();
  ShareAll(
      1, On::kRank, [&](std::size_t, std::size_t) { work(); }, [&](std::size_t) { return pack(); },
      [&](std::size_t, const std::string& bytes) { unpack(bytes); });
}

}  // namespace continuum
