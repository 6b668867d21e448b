#pragma once

#include <cstddef>
#include <optional>
#include <string>

/// Messages between the processes of one job, its ranks 0 ... Size() - 1. This hides MPI: where the
/// program was built without it, or was not started by mpirun, there is one rank.
namespace continuum::mpi {

/// "Open MPI v4.1.4"; empty: built without.
std::string Library();

/// Joins the job and leaves it again, once in a program. Who has left is alone, with the same
/// number and ranks on this host. Throws Error where there is a job that cannot be joined.
void Join();
void Leave();

std::size_t Rank();
std::size_t Size();
std::size_t RanksOnThisHost();

struct Message {
  std::size_t from;
  std::string bytes;
};

/// Both may be called from any thread. Send returns when the bytes are on their way; Receive takes
/// a message with this tag, if one has arrived.
void Send(std::size_t to, int tag, const std::string& bytes);
std::optional<Message> Receive(int tag);

/// Ends all ranks at once.
[[noreturn]] void Abort(int exit_code);

}  // namespace continuum::mpi
