// Communicator of a job: its ranks and the messages between them. Implemented over MPI
// (mpi_peers.cpp, loaded at run time) and by tests. A message that cannot be sent ends the whole
// job, so no call returns an error. Collective calls block until all ranks have called them; all
// ranks make them in the same order.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::cluster {

// The content of a message.
using Bytes = std::vector<std::byte>;

// A message from another rank.
struct Parcel {
  unsigned from = 0;
  Bytes bytes;
};

class Peers {
 public:
  virtual ~Peers() = default;
  // This rank, 0 … count() − 1; the number of ranks; the number of ranks on this machine.
  virtual unsigned rank() const = 0;
  virtual unsigned count() const = 0;
  virtual unsigned count_here() const = 0;
  virtual std::string host() const = 0;  // of this machine
  // Collective. Returns the strings of all ranks, by rank. Main thread.
  virtual std::vector<std::string> exchange(const std::string& mine) = 0;
  // Returns the next number of a counter shared by all ranks, from 0 on. One-sided: no rank has to
  // respond. Any thread.
  virtual std::uint64_t claim() = 0;
  // Lets claims of other ranks complete where the network needs this process for them. Rank 0 calls
  // it every millisecond from its main thread.
  virtual void progress() = 0;
  // Sends bytes to another rank and returns once they are under way, which may take until that rank
  // calls receive(). Any thread.
  virtual void send(unsigned rank, Bytes bytes) = 0;
  // Receives the next message from any rank, or nullopt. Messages of one rank keep their order.
  // Waits briefly for the rest of a message whose transfer has begun, and otherwise not at all. One
  // thread.
  virtual std::optional<Parcel> receive() = 0;
  // Number of calls of this rank that sent something. Any thread.
  virtual std::uint64_t messages() const = 0;
  // Collective: ends the job. No call may follow. If a rank exits without it, the others learn that
  // this rank failed.
  virtual void finish() = 0;
  // Terminates all ranks.
  virtual void abort() = 0;
};

// Polling backoff for receive(): sleeps one eighth of the idle time, because MPI has no blocking
// wait with wake-up. A message is therefore late by a small fraction of its waiting time, and a
// long wait uses little processor time. One thread.
class Nap {
 public:
  explicit Nap(std::chrono::nanoseconds longest = std::chrono::microseconds(200))
      : longest_(longest) {}
  // Resets the backoff: a message has arrived or will arrive soon.
  void wake() { since_ = Clock::now(); }
  // Returns the next pause: an eighth of the time since wake(), up to the maximum.
  std::chrono::nanoseconds length() const {
    return std::min(longest_, std::chrono::nanoseconds(Clock::now() - since_) / 8);
  }
  void sleep() const { std::this_thread::sleep_for(length()); }

 private:
  using Clock = std::chrono::steady_clock;
  std::chrono::nanoseconds longest_;
  Clock::time_point since_ = Clock::now();
};

// Returns true if mpirun started this process as a rank.
bool is_rank();

// Returns the number of processes of this job step, as mpirun (OMPI_COMM_WORLD_SIZE), srun
// (SLURM_STEP_NUM_TASKS) or another launcher (PMI_SIZE) tells it; 1 for a process started alone.
// SLURM_NTASKS does not count, because the shell of a batch script has it too.
unsigned copies_started();
// Fails with kInvalidArgument if several copies would do the same work ("make the whole region").
core::Result<void> check_one_copy(std::string_view work);

// Loads MPI and joins the other ranks. Fails with kInternal if psygen was built without MPI or its
// libraries are missing.
core::Result<std::unique_ptr<Peers>> join_communicator();

// Signature of psygen_join_mpi, which the MPI library exports: returns a new object, or null and an
// error message.
using JoinMpi = Peers* (*)(std::string& error);

}  // namespace psygen::cluster
