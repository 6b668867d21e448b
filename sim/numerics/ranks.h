#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace continuum {

/// A job that `mpirun -n N` started is N processes, its ranks. Every rank runs the same program;
/// where that comes to a loop of shared_loop.h, all of them work on it. A program that was started
/// alone is the one rank of its job.
///
/// Joins the job, once in a program. Throws Error where ranks have other versions.
void JoinRanks(const std::string& version);
/// Waits for all ranks and leaves the job; from then on each is alone, with the number it had.
void LeaveRanks();

/// Which rank this process is, from 0, and of how many.
std::size_t ThisRank();
std::size_t RankCount();

/// Ends the job as something went wrong here. Another rank than 0 gives that one time to do so
/// first: it says what all ranks found. Returns where there is one rank.
void EndRanks(int exit_code, const std::function<void(const std::string& who)>& say);

/// Waits for all ranks. Throws Error on each of them where they do not have the same text.
/// what: "version of continuum".
void RequireSameOnRanks(const std::string& what, const std::string& text);

/// Of all ranks, on rank 0: "2 ranks: tasks 5 5; idle 0.1 0.2 of 3.4 s". Called on all.
std::string RankLoads();

}  // namespace continuum
