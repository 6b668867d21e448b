#include "sim/numerics/parallel.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <ctime>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "sim/numerics/parallel_scope.h"
#include "sim/numerics/rank_messages.h"

namespace continuum {

namespace {
thread_local bool is_parallel = false;
thread_local std::size_t this_thread = 0;

// Asked for once: the system reads a file for it.
std::size_t Cores() {
  static const std::size_t cores = std::thread::hardware_concurrency();
  return cores;
}

// By the system, to this process.
std::size_t CoresAllowed() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (sched_getaffinity(0, sizeof cores, &cores) != 0) return Cores();
  return static_cast<std::size_t>(CPU_COUNT(&cores));
}

}  // namespace

bool InParallelFor() { return is_parallel; }

std::size_t ThisThread() { return this_thread; }

// Ranks on one machine divide its cores, and mpirun may have bound this one to few of them.
std::size_t ThreadCount() {
  return std::max<std::size_t>(1, std::min(CoresAllowed(), Cores() / mpi::RanksOnThisHost()));
}

double ProcessorSeconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

void ParallelFor(std::size_t n, const std::function<void(std::size_t, std::size_t)>& work) {
  if (is_parallel || n == 1) {
    for (std::size_t i = 0; i < n; ++i) work(this_thread, i);
    return;
  }
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex mutex;
  const auto run = [&](std::size_t thread) {
    is_parallel = true, this_thread = thread;
    try {
      for (std::size_t i = next++; i < n; i = next++) work(thread, i);
    } catch (...) {
      next = n;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
    is_parallel = false, this_thread = 0;
  };
  std::vector<std::thread> threads;
  for (std::size_t t = 1; t < std::min(n, ThreadCount()); ++t) threads.emplace_back(run, t);
  run(0);
  for (std::thread& t : threads) t.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace continuum
