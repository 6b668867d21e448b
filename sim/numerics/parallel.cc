#include "sim/numerics/parallel.h"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace continuum {

namespace {
thread_local bool is_parallel = false;
}

std::size_t ThreadCount() { return std::max(1u, std::thread::hardware_concurrency()); }

double ProcessorSeconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

void ParallelFor(std::size_t n, const std::function<void(std::size_t, std::size_t)>& work) {
  if (is_parallel) {
    for (std::size_t i = 0; i < n; ++i) work(0, i);
    return;
  }
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex mutex;
  const auto run = [&](std::size_t thread) {
    is_parallel = true;
    try {
      for (std::size_t i = next++; i < n; i = next++) work(thread, i);
    } catch (...) {
      next = n;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
    is_parallel = false;
  };
  std::vector<std::thread> threads;
  for (std::size_t t = 1; t < std::min(n, ThreadCount()); ++t) threads.emplace_back(run, t);
  run(0);
  for (std::thread& t : threads) t.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace continuum
