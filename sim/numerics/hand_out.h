#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

/// Who does which task of a loop that all ranks of a job come to. Rank r begins with task r and
/// asks nobody; what is left, rank 0 hands out to whoever is free. So a loop with no more tasks
/// than ranks takes one message from each of them, and one to each.
namespace continuum {

inline constexpr std::size_t kNoTask = std::numeric_limits<std::size_t>::max();

/// Rank 0 of a loop of n tasks: numbers go out and results come in, in a thread beside its own
/// work.
class Leader {
 public:
  /// take(i, result): one call at a time, not always in the calling thread.
  Leader(std::size_t n, std::function<void(std::size_t, const std::string&)> take);

  /// What to work on; kNoTask: nothing is left.
  std::size_t Next();
  void Finish(std::size_t i, const std::string& result);
  /// Waits for the work of all ranks. Throws Error when the user asks to stop.
  void Wait();
  /// What every rank then knows.
  void EndAll(const std::string& bytes) const;

 private:
  void Answer(const struct TaskMessage& ask, std::size_t from);
  bool TakeMessage();
  void Serve(const std::stop_token& stop);
  std::size_t NextToAll();

  const std::size_t n_, loop_;
  const std::function<void(std::size_t, const std::string&)> take_;
  std::atomic<bool> begun_ = false;
  std::atomic<std::size_t> next_, finished_ = 0;
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::jthread messages_;  // the last member: it begins when all others are there
};

/// Any other rank of a loop; its threads ask one at a time.
class Follower {
 public:
  explicit Follower(std::size_t n);

  std::size_t Next();
  void Finish(std::size_t i, const std::string& result);
  /// What rank 0 gave to EndAll, after Next has returned kNoTask.
  const std::string& Wait() const { return *over_; }

 private:
  bool HearsOver();

  const std::size_t n_, loop_;
  bool begun_ = false;
  std::mutex mutex_;
  std::optional<std::string> over_;
};

}  // namespace continuum
