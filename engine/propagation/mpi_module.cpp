/// The module gumshoe_mpi.so: the only door to MPI. One call of MPI is under way at a time in a rank, and none waits,
/// so that threads can share it and an idle rank leaves its processor to others.
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include "propagation/transport.h"

namespace gumshoe::propagation {

namespace {

/// The allowed processors, divided by the ranks of this machine that have the same: a launcher either binds ranks to
/// sets that do not overlap, or to none.
int share_of_processors() {
  MPI_Comm machine;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int ranks = 0;
  MPI_Comm_size(machine, &ranks);
  cpu_set_t own;
  CPU_ZERO(&own);
  sched_getaffinity(0, sizeof own, &own);
  std::vector<cpu_set_t> all(static_cast<std::size_t>(ranks));
  MPI_Allgather(&own, sizeof own, MPI_BYTE, all.data(), sizeof own, MPI_BYTE, machine);
  MPI_Comm_free(&machine);
  int sharing = 0;
  for (const cpu_set_t& other : all) sharing += CPU_EQUAL(&own, &other) ? 1 : 0;
  return std::max(1, CPU_COUNT(&own) / sharing);
}

class Mpi : public Transport {
public:
  Mpi() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    processors_ = share_of_processors();
  }
  ~Mpi() override { MPI_Finalize(); }
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int processors() const override { return processors_; }

  void send(int to, int tag, const std::string& bytes) override {
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      throw std::length_error("a block of samples is larger than a message of MPI");
    MPI_Request request;
    int sent = 0;
    {
      const std::lock_guard lock(guard_);
      MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD, &request);
    }
    for (;;) {
      {
        const std::lock_guard lock(guard_);
        MPI_Test(&request, &sent, MPI_STATUS_IGNORE);
      }
      if (sent) return;
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
  }

  std::optional<std::string> poll(int from, int tag) override {
    const std::lock_guard lock(guard_);
    int there = 0, size = 0;
    MPI_Status status;
    MPI_Iprobe(from, tag, MPI_COMM_WORLD, &there, &status);
    if (!there) return std::nullopt;
    MPI_Get_count(&status, MPI_BYTE, &size);
    std::string bytes(static_cast<std::size_t>(size), '\0');
    MPI_Recv(bytes.data(), size, MPI_BYTE, from, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return bytes;
  }

private:
  std::mutex guard_;
  int rank_ = 0, size_ = 1, processors_ = 1;
};

} // namespace

extern "C" Transport* gumshoe_open_transport() { return new Mpi; }

} // namespace gumshoe::propagation
