#include "sim/numerics/shared_loop.h"

#include <atomic>
#include <charconv>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "error.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/parallel.h"
#include "sim/numerics/parallel_scope.h"
#include "sim/numerics/rank_dialogue.h"
#include "sim/numerics/ranks.h"

namespace continuum {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// Messages are "NUMBER BYTES".
std::string Numbered(std::size_t i, const std::string& bytes) {
  return std::to_string(i) + " " + bytes;
}

std::size_t NumberOf(const std::string& message) {
  std::size_t i = kNone;
  std::from_chars(message.data(), message.data() + message.size(), i);
  return i;
}

std::string BytesAfterNumber(const std::string& message) {
  return message.substr(message.find(' ') + 1);
}

// Ranks come to the same loops in the same order. One that is late hears at once that a loop is
// over.
std::size_t NextLoop() {
  static std::size_t loops = 0;
  return ++loops;
}

[[noreturn]] void FailAtOtherPlace() {
  throw Error::Job("the ranks came to different places of the work");
}

// Rank 0 of a loop: numbers go out and results come in, in a thread beside its own work.
class Leader {
 public:
  Leader(std::size_t n, const std::function<void(std::size_t, const std::string&)>& take)
      : n_(n),
        loop_(NextLoop()),
        take_(take),
        messages_([this](const std::stop_token& stop) { Serve(stop); }) {}

  std::size_t Next() {
    const std::size_t i = StopRequested() ? n_ : next_++;
    return i < n_ ? i : kNone;
  }

  void Finish(std::size_t i, const std::string& result) {
    const std::lock_guard lock(mutex_);
    take_(i, result);
    ++finished_;
  }

  // Waits for the work of all ranks.
  void Wait() {
    const IdleTime idle;
    messages_.join();
    if (failure_) std::rethrow_exception(failure_);
  }

  // What every rank then knows.
  void EndAll(const std::string& bytes) const { SendToAll(kOver, Numbered(loop_, bytes)); }

 private:
  void Answer(const mpi::Message& ask) {
    const std::size_t loop = NumberOf(ask.bytes);
    if (loop < loop_) return;  // it hears that this one is over
    if (loop > loop_ || BytesAfterNumber(ask.bytes) != std::to_string(n_)) FailAtOtherPlace();
    const std::size_t i = Next();
    if (i != kNone) mpi::Send(ask.from, kNumber, std::to_string(i));
  }

  // Whether there was one.
  bool TakeMessage() {
    if (const auto ask = mpi::Receive(kAsk)) {
      Answer(*ask);
    } else if (const auto result = mpi::Receive(kResult)) {
      Finish(NumberOf(result->bytes), BytesAfterNumber(result->bytes));
    } else {
      return false;
    }
    return true;
  }

  void Serve(const std::stop_token& stop) {
    try {
      Looks looks;
      while (!stop.stop_requested() && finished_ < n_) {
        if (TakeMessage()) {
          looks = {};
        } else {
          looks.Pause();
        }
      }
    } catch (...) {
      failure_ = std::current_exception();
    }
  }

  const std::size_t n_, loop_;
  const std::function<void(std::size_t, const std::string&)> take_;
  std::atomic<std::size_t> next_ = 0, finished_ = 0;
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::jthread messages_;  // the last member: it begins when all others are there
};

// Any other rank of a loop; its threads ask one at a time.
class Follower {
 public:
  explicit Follower(std::size_t n) : n_(n), loop_(NextLoop()) {}

  std::size_t Next() {
    const std::lock_guard lock(mutex_);
    if (over_) return kNone;
    mpi::Send(0, kAsk, Numbered(loop_, std::to_string(n_)));
    const IdleTime idle;
    const Looks looks;
    std::optional<mpi::Message> number;
    while (!HearsOver() && !(number = mpi::Receive(kNumber))) looks.Pause();
    return number ? NumberOf(number->bytes) : kNone;
  }
  void Finish(std::size_t i, const std::string& result) {
    mpi::Send(0, kResult, Numbered(i, result));
  }

  // What rank 0 gave to EndAll, after Next has returned kNone.
  std::string Wait() const { return BytesAfterNumber(*over_); }

 private:
  bool HearsOver() {
    if (auto message = mpi::Receive(kOver)) {
      if (NumberOf(message->bytes) != loop_) FailAtOtherPlace();
      over_ = std::move(message->bytes);
    }
    return over_.has_value();
  }

  const std::size_t n_, loop_;
  std::mutex mutex_;
  std::optional<std::string> over_;
};

template <class Side, class Work>
void Share(Side& side, const Work& work) {
  for (std::size_t i = side.Next(); i != kNone; i = side.Next()) {
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
    std::size_t n, const std::function<std::string(std::size_t thread, std::size_t i)>& work) {
  const auto on_threads = [&](auto& side) {
    ParallelFor(ThreadCount(), [&](std::size_t thread, std::size_t) {
      Share(side, [&](std::size_t i) { return work(thread, i); });
    });
  };
  if (ThisRank() > 0) {
    Follower follower(n);
    on_threads(follower);
    return FromBytes<std::vector<Result>>(follower.Wait());
  }
  std::vector<Result> all(n);
  Leader leader(
      n, [&](std::size_t i, const std::string& bytes) { all[i] = FromBytes<Result>(bytes); });
  on_threads(leader);
  leader.Wait();
  leader.EndAll(ToBytes(all));
  return all;
}

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

void ShareOut(std::size_t n, const std::function<void(std::size_t thread, std::size_t i)>& work,
              const std::function<std::string(std::size_t i)>& pack,
              const std::function<void(std::size_t i, const std::string& bytes)>& unpack) {
  if (RankCount() == 1 || n < 2 || InParallelFor()) return ParallelFor(n, work);
  std::vector<std::uint8_t> here(n, 0);
  const auto all = ResultsOf(n, [&](std::size_t thread, std::size_t i) {
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

}  // namespace continuum
