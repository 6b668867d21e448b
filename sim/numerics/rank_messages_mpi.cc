#include "sim/numerics/rank_messages.h"

#include <mpi.h>

#include <array>
#include <chrono>
#include <climits>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "error.h"

namespace continuum::mpi {
namespace {

constexpr char kStartedByMpirun[] = "OMPI_COMM_WORLD_SIZE";

std::size_t rank = 0, size = 1, on_host = 1;
std::mutex mutex;  // MPI_THREAD_SERIALIZED: one call at a time

// MPI's own handler of errors ends the job with a message; so return codes say nothing here.
int Int(std::size_t n) {
  if (n > INT_MAX) throw Error::Job("a message of more than 2 GB between two ranks");
  return static_cast<int>(n);
}

std::size_t CountOnHost() {
  MPI_Comm host = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host);
  int count = 1;
  MPI_Comm_size(host, &count);
  MPI_Comm_free(&host);
  return static_cast<std::size_t>(count);
}

}  // namespace

std::string Library() {
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
  int length = 0;
  MPI_Get_library_version(text.data(), &length);
  const std::string all = text.data();
  return all.substr(0, all.find(','));
}

void Join() {
  if (!std::getenv(kStartedByMpirun)) return;
  int level = 0, r = 0, s = 1;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &level);
  if (level < MPI_THREAD_SERIALIZED) throw Error::Job("this MPI does not know threads");
  MPI_Comm_rank(MPI_COMM_WORLD, &r);
  MPI_Comm_size(MPI_COMM_WORLD, &s);
  rank = static_cast<std::size_t>(r), size = static_cast<std::size_t>(s);
  on_host = CountOnHost();
  unsetenv(kStartedByMpirun);  // programs that this one starts are none of the job
}

void Leave() {
  int joined = 0, left = 0;
  MPI_Initialized(&joined);
  MPI_Finalized(&left);
  if (joined && !left) MPI_Finalize();
  size = 1;
}

std::size_t Rank() { return rank; }
std::size_t Size() { return size; }
std::size_t RanksOnThisHost() { return on_host; }

void Send(std::size_t to, int tag, const std::string& bytes) {
  MPI_Request request = MPI_REQUEST_NULL;
  int sent = 0;
  for (bool begun = false; !sent; begun = true) {
    if (begun) std::this_thread::sleep_for(std::chrono::microseconds(100));
    const std::lock_guard lock(mutex);
    if (!begun) {
      MPI_Isend(bytes.data(), Int(bytes.size()), MPI_BYTE, Int(to), tag, MPI_COMM_WORLD, &request);
    }
    MPI_Test(&request, &sent, MPI_STATUS_IGNORE);
  }
}

std::optional<Message> Receive(int tag) {
  const std::lock_guard lock(mutex);
  int there = 0, length = 0;
  MPI_Status status{};
  MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &there, &status);
  if (!there) return {};
  MPI_Get_count(&status, MPI_BYTE, &length);
  Message m{static_cast<std::size_t>(status.MPI_SOURCE),
            std::string(static_cast<std::size_t>(length), '\0')};
  MPI_Recv(m.bytes.data(), length, MPI_BYTE, status.MPI_SOURCE, tag, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  return m;
}

void Abort(int exit_code) {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::abort();  // not reached
}

}  // namespace continuum::mpi
