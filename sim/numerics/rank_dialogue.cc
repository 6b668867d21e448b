#include "sim/numerics/rank_dialogue.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "sim/io/interrupt.h"

namespace continuum {
namespace {

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

RankLoad& OwnLoad() {
  static RankLoad load;
  return load;
}

IdleTime::IdleTime() : begin_(Now()) {}
IdleTime::~IdleTime() { OwnLoad().idle += Now() - begin_; }

Looks::Looks() : begin_(Now()) {}

void Looks::Pause() const {
  constexpr double kShortest = 1e-4, kLongest = 5e-3;  // [s]
  StopIfRequested();
  const double pause = std::clamp(0.05 * (Now() - begin_), kShortest, kLongest);
  std::this_thread::sleep_for(std::chrono::duration<double>(pause));
}

mpi::Message Await(RankSubject subject) {
  const IdleTime idle;
  const Looks looks;
  for (;;) {
    if (auto message = mpi::Receive(subject)) return *std::move(message);
    looks.Pause();
  }
}

void SendToAll(RankSubject subject, const std::string& bytes) {
  for (std::size_t r = 1; r < mpi::Size(); ++r) mpi::Send(r, subject, bytes);
}

}  // namespace continuum
