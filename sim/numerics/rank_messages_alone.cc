// The messages of a program that was built without MPI.
#include <cstdlib>

#include "error.h"
#include "sim/numerics/rank_messages.h"

namespace continuum::mpi {

std::string Library() { return ""; }

void Join() {
  const char* const ranks = std::getenv("OMPI_COMM_WORLD_SIZE");
  if (ranks && std::atoi(ranks) > 1)
    throw Error::Input("mpirun", "a `continuum` that was built with MPI", "one without");
}
void Leave() {}

std::size_t Rank() { return 0; }
std::size_t Size() { return 1; }
std::size_t RanksOnThisHost() { return 1; }

void Send(std::size_t, int, const std::string&) {}
std::optional<Message> Receive(int) { return {}; }
void Abort(int exit_code) { std::_Exit(exit_code); }

}  // namespace continuum::mpi
