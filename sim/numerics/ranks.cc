#include "sim/numerics/ranks.h"

#include <chrono>
#include <cstdlib>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "error.h"
#include "sim/io/excerpt.h"
#include "sim/io/host_name.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/rank_dialogue.h"

namespace continuum {
namespace {

using Clock = std::chrono::steady_clock;

Clock::time_point& JoinedAt() {
  static Clock::time_point at;
  return at;
}

// What each rank has sent to rank 0, there. No rank sends a second one before all sent the first.
std::vector<std::string> Collect(RankSubject subject, std::string own) {
  std::vector<std::string> all(RankCount());
  all[0] = std::move(own);
  for (std::size_t r = 1; r < RankCount(); ++r) {
    mpi::Message m = Await(subject);
    all[m.from] = std::move(m.bytes);
  }
  return all;
}

// A text with the name of its machine, and how people read it.
struct RankText {
  std::string shown, text;

  static std::string Of(const std::string& text) {
    return HostName() + " has " + Excerpt(text) + "\n" + text;
  }
  explicit RankText(const std::string& message)
      : shown(message.substr(0, message.find('\n'))),
        text(message.substr(message.find('\n') + 1)) {}
};

// Which rank has another text than rank 0; empty: none.
std::string DifferenceOf(const std::string& what, const std::vector<std::string>& all) {
  const RankText first(all[0]);
  for (std::size_t r = 1; r < all.size(); ++r) {
    const RankText other(all[r]);
    if (other.text != first.text)
      return fmt::format("the ranks differ in the {}: rank 0 on {}, rank {} on {}", what,
                         first.shown, r, other.shown);
  }
  return "";
}

}  // namespace

void JoinRanks(const std::string& version) {
  mpi::Join();
  JoinedAt() = Clock::now();
  RequireSameOnRanks("version of continuum", version);
}

// All wait asleep for the last one, as MPI's own end does not.
void LeaveRanks() {
  RequireSameOnRanks("end", "");
  mpi::Leave();
}

std::size_t ThisRank() { return mpi::Rank(); }
std::size_t RankCount() { return mpi::Size(); }

void EndRanks(int exit_code, const std::function<void(const std::string& who)>& say) {
  constexpr int kLooks = 50;  // of 0.1 s
  const bool first = ThisRank() == 0;
  for (int i = 0; !first && i < kLooks; ++i) {
    if (StopRequested()) std::_Exit(exit_code);  // the job is at its end
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  say(first ? "" : fmt::format("rank {} on {}: ", ThisRank(), HostName()));
  if (RankCount() > 1) mpi::Abort(exit_code);
}

void RequireSameOnRanks(const std::string& what, const std::string& text) {
  if (RankCount() == 1) return;
  std::string fault;
  if (ThisRank() > 0) {
    mpi::Send(0, kText, RankText::Of(text));
    fault = Await(kAnswer).bytes;
  } else {
    fault = DifferenceOf(what, Collect(kText, RankText::Of(text)));
    SendToAll(kAnswer, fault);
  }
  if (!fault.empty()) throw Error::Input("mpirun", fault);
}

std::string RankLoads() {
  const std::string own = fmt::format("{} {:.1f}", OwnLoad().tasks.load(), OwnLoad().idle.load());
  if (ThisRank() > 0) {
    mpi::Send(0, kLoad, own);
    return "";
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - JoinedAt()).count();
  std::string tasks, idle;
  for (const std::string& one : Collect(kLoad, own)) {
    const std::size_t space = one.find(' ');
    tasks += " " + one.substr(0, space);
    idle += one.substr(space);
  }
  return fmt::format("{} ranks: tasks{}; idle{} of {:.1f} s", RankCount(), tasks, idle, seconds);
}

}  // namespace continuum
