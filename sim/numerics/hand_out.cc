#include "sim/numerics/hand_out.h"

#include <algorithm>
#include <utility>

#include "error.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/bytes.h"
#include "sim/numerics/rank_dialogue.h"
#include "sim/numerics/ranks.h"

namespace continuum {

// Of a loop with so many tasks: the number of one, or kNoTask, and its result.
struct TaskMessage {
  std::size_t loop, tasks, task;
  std::string bytes;
};

template <class A>
void Fields(A& a, TaskMessage& m) {
  a(m.loop, m.tasks, m.task, m.bytes);
}

namespace {

// Ranks come to the same loops in the same order. One that is late hears at once that a loop is
// over.
std::size_t NextLoop() {
  static std::size_t loops = 0;
  return ++loops;
}

[[noreturn]] void FailAtOtherPlace() {
  throw Error::Job("the ranks came to different places of the work");
}

void SendTask(std::size_t to, RankSubject subject, TaskMessage message) {
  mpi::Send(to, subject, ToBytes(message));
}

}  // namespace

Leader::Leader(std::size_t n, std::function<void(std::size_t, const std::string&)> take)
    : n_(n), loop_(NextLoop()), take_(std::move(take)), next_(std::min(n, RankCount())) {
  if (n > RankCount()) messages_ = std::jthread([this](const auto& stop) { Serve(stop); });
}

std::size_t Leader::NextToAll() {
  const std::size_t i = StopRequested() ? n_ : next_++;
  return i < n_ ? i : kNoTask;
}

std::size_t Leader::Next() {
  const bool first = !begun_.exchange(true);
  return first && n_ > 0 && !StopRequested() ? 0 : NextToAll();
}

void Leader::Finish(std::size_t i, const std::string& result) {
  const std::lock_guard lock(mutex_);
  take_(i, result);
  ++finished_;
}

void Leader::Wait() {
  const IdleTime idle;
  if (messages_.joinable()) {
    messages_.join();
  } else {
    Serve({});
  }
  if (failure_) std::rethrow_exception(failure_);
}

void Leader::EndAll(const std::string& bytes) const {
  TaskMessage over{loop_, n_, kNoTask, bytes};
  SendToAll(kOver, ToBytes(over));
}

void Leader::Answer(const TaskMessage& ask, std::size_t from) {
  if (ask.loop < loop_) return;  // it hears that this one is over
  if (ask.loop > loop_ || ask.tasks != n_) FailAtOtherPlace();
  const std::size_t i = NextToAll();
  if (i != kNoTask) SendTask(from, kNumber, {loop_, n_, i, ""});
}

// Whether there was one.
bool Leader::TakeMessage() {
  if (const auto ask = mpi::Receive(kAsk)) {
    Answer(FromBytes<TaskMessage>(ask->bytes), ask->from);
  } else if (const auto message = mpi::Receive(kResult)) {
    const auto result = FromBytes<TaskMessage>(message->bytes);
    if (result.loop != loop_ || result.tasks != n_) FailAtOtherPlace();
    Finish(result.task, result.bytes);
  } else {
    return false;
  }
  return true;
}

void Leader::Serve(const std::stop_token& stop) {
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

Follower::Follower(std::size_t n) : n_(n), loop_(NextLoop()) {}

std::size_t Follower::Next() {
  const std::lock_guard lock(mutex_);
  if (over_) return kNoTask;
  if (!std::exchange(begun_, true) && ThisRank() < n_) return ThisRank();
  if (n_ > RankCount()) SendTask(0, kAsk, {loop_, n_, kNoTask, ""});
  const IdleTime idle;
  const Looks looks;
  std::optional<mpi::Message> number;
  while (!HearsOver() && !(number = mpi::Receive(kNumber))) looks.Pause();
  return number ? FromBytes<TaskMessage>(number->bytes).task : kNoTask;
}

void Follower::Finish(std::size_t i, const std::string& result) {
  SendTask(0, kResult, {loop_, n_, i, result});
}

bool Follower::HearsOver() {
  if (const auto message = mpi::Receive(kOver)) {
    auto over = FromBytes<TaskMessage>(message->bytes);
    if (over.loop != loop_) FailAtOtherPlace();
    over_ = std::move(over.bytes);
  }
  return over_.has_value();
}

}  // namespace continuum
