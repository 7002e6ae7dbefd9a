// The processes of a job, its ranks, and all that they tell each other. Behind it is MPI
// (mpi_peers.cpp, loaded at run time), or a test. Where a message cannot be sent, the whole job
// ends: no call returns an error. Calls that say "all ranks" wait for all of them, in the same
// order everywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::cluster {

using Bytes = std::vector<std::byte>;

// What another rank has sent to this one.
struct Parcel {
  unsigned from = 0;
  Bytes bytes;
};

class Peers {
 public:
  virtual ~Peers() = default;
  // 0 … count() − 1, and how many there are; how many run on this machine.
  virtual unsigned rank() const = 0;
  virtual unsigned count() const = 0;
  virtual unsigned count_here() const = 0;
  virtual std::string host() const = 0;  // of this machine
  // All ranks: what each of them gives, by rank. Main thread.
  virtual std::vector<std::string> exchange(const std::string& mine) = 0;
  // The next number of a counter that all ranks share, from 0 on. One-sided: no rank has to answer.
  // Any thread.
  virtual std::uint64_t claim() = 0;
  // Lets claims of others get through where the network needs this process for it. Rank 0 calls it
  // every millisecond, from its main thread.
  virtual void progress() = 0;
  // Sends bytes to another rank; returns once they are on their way. That may take until it calls
  // receive(). Any thread.
  virtual void send(unsigned rank, Bytes bytes) = 0;
  // What has come from any rank, in the order in which each of them sent it; nothing where nothing
  // has. Waits only for the rest of what has begun to come, and not for long. One thread.
  virtual std::optional<Parcel> receive() = 0;
  // Calls of this rank that sent something. Any thread.
  virtual std::uint64_t messages() const = 0;
  // All ranks: the end of the job. Nothing may be called after it. Without it the others are told
  // that this rank has failed.
  virtual void finish() = 0;
  // Ends all ranks.
  virtual void abort() = 0;
};

// Whether this process was started as a rank, by mpirun.
bool is_rank();

// Loads MPI and joins the others. Fails with kInternal where psygen was built without MPI or its
// libraries are missing.
core::Result<std::unique_ptr<Peers>> join_peers();

// The function that the library of MPI exports, psygen_join_mpi: a new object, or nothing and a
// sentence.
using JoinMpi = Peers* (*)(std::string& error);

}  // namespace psygen::cluster
