#pragma once

#include <atomic>
#include <cstddef>
#include <string>

#include "sim/numerics/rank_messages.h"

/// How ranks talk with rank 0: what a message is about, and the wait for one.
namespace continuum {

/// What a message is about.
enum RankSubject {
  kAsk = 1,  ///< to rank 0: for a number; says in which loop
  kNumber,   ///< from rank 0: what to work on
  kResult,   ///< to rank 0: number and bytes
  kOver,     ///< from rank 0: which loop is done, and its results where every rank needs them
  kText,     ///< to rank 0: the text that must be the same
  kAnswer,   ///< from rank 0: what is wrong, or nothing
  kLoad      ///< to rank 0: how much a rank did
};

/// What this rank has done so far.
struct RankLoad {
  std::atomic<std::size_t> tasks = 0;
  std::atomic<double> idle = 0;  ///< [s] in waits for other ranks
};
RankLoad& OwnLoad();

/// Adds its own lifetime to the idle time of this rank.
class IdleTime {
 public:
  IdleTime();
  ~IdleTime();
  IdleTime(const IdleTime&) = delete;

 private:
  double begin_;  // [s]
};

/// Looks at messages, with pauses between them: a twentieth of the wait so far, so that short tasks
/// wait for little and long waits cost little.
class Looks {
 public:
  Looks();
  /// Before the next look. Throws Error when the user asks to stop.
  void Pause() const;

 private:
  double begin_;  // [s]
};

/// The next message about something. Throws Error when the user asks to stop.
mpi::Message Await(RankSubject subject);

void SendToAll(RankSubject subject, const std::string& bytes);

}  // namespace continuum
