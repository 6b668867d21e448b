#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include "sim/numerics/bytes.h"

namespace continuum {

/// Loops that all ranks of a job (ranks.h) work on. Every rank must come to the same loops in the
/// same order.
///
/// Calls work(i) for each i < n on whichever rank is free, one call at a time on each, and on rank
/// 0 take(i, what work(i) returned) for one after the other, as they come; not always in the
/// calling thread. Ends on all ranks together. Throws Error when the user asks to stop.
void HandOut(std::size_t n, const std::function<std::string(std::size_t i)>& work,
             const std::function<void(std::size_t i, const std::string& result)>& take);

/// ParallelFor with the threads of all ranks. What work(thread, i) stores is then on every rank, as
/// if all of it had run there: pack(i) gives it as bytes, unpack(i, bytes) stores it. An Error of
/// the first i that has one is thrown on every rank. Where the result of a task follows from its
/// number alone, it is the same to the last bit for any number of ranks and threads.
///
/// n is the same on every rank. A single task runs on every rank, and loops inside it are shared.
void ShareOut(std::size_t n, const std::function<void(std::size_t thread, std::size_t i)>& work,
              const std::function<std::string(std::size_t i)>& pack,
              const std::function<void(std::size_t i, const std::string& bytes)>& unpack);

/// The same of larger tasks, as whole fits: one at a time on each rank, where the loops inside of
/// work(i) use its threads. A single rank gives each thread tasks of its own where there are
/// enough, else it takes one after the other.
void ShareTasks(std::size_t n, const std::function<void(std::size_t i)>& work,
                const std::function<std::string(std::size_t i)>& pack,
                const std::function<void(std::size_t i, const std::string& bytes)>& unpack);

/// A step that cannot be shared: the first rank does it, with its threads, and the others wait for
/// what it stores. An Error is thrown on every rank.
void OnFirstRank(const std::function<void()>& work, const std::function<std::string()>& pack,
                 const std::function<void(const std::string& bytes)>& unpack);

/// Pack and unpack where fields(archive, i) lists what a task stores (bytes.h).
template <class Fields>
auto PackOf(const Fields& fields) {
  return [&fields](std::size_t i) {
    BytesOut bytes;
    fields(bytes, i);
    return std::move(bytes.bytes());
  };
}
template <class Fields>
auto UnpackOf(const Fields& fields) {
  return [&fields](std::size_t i, const std::string& all) {
    BytesIn bytes(all);
    fields(bytes, i);
  };
}

/// The same loops with such a list.
template <class Fields>
void ShareOut(std::size_t n, const std::function<void(std::size_t thread, std::size_t i)>& work,
              const Fields& fields) {
  ShareOut(n, work, PackOf(fields), UnpackOf(fields));
}
template <class Fields>
void ShareTasks(std::size_t n, const std::function<void(std::size_t i)>& work,
                const Fields& fields) {
  ShareTasks(n, work, PackOf(fields), UnpackOf(fields));
}

/// The same for what a step returns (bytes.h).
template <class Work>
auto OnFirstRank(const Work& work) {
  decltype(work()) result{};
  OnFirstRank([&] { result = work(); }, [&] { return ToBytes(result); },
              [&](const std::string& bytes) { result = FromBytes<decltype(work())>(bytes); });
  return result;
}

}  // namespace continuum
