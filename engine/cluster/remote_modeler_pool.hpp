// Remote modelers of a flight: slots of a SynthesisManager (synthesis/remote_modelers.hpp), one for
// each thread of another rank. Measures the round trip of a mesh and accepts only requests that
// take longer. A receiver thread runs while answers are awaited and sleeps otherwise. A rank that
// does not respond, sends damaged data or rejects a request is not used any more. For one session.
// Runs on rank 0; the other ranks run run_model_server().
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "engine/cluster/meeting.hpp"
#include "engine/cluster/peers.hpp"
#include "engine/synthesis/remote_modelers.hpp"

namespace psygen::cluster {

struct RemoteOptions {
  // Only requests predicted to take longer than this go to other ranks, in seconds of a core.
  // Default: the measured round trip of the mesh.
  std::optional<double> send_above_s;
  unsigned max_places = 256;  // each has a thread here that mostly sleeps
};

// Round trip of a mesh, without its synthesis.
struct Way {
  double latency_s = 0;         // of a request and an answer without a mesh
  double bytes_per_second = 0;  // bandwidth for the mesh
  double seconds(double bytes) const {
    return latency_s + (bytes_per_second > 0 ? bytes / bytes_per_second : 0);
  }
};

// Statistics of the remote modelers.
struct RemoteStats {
  unsigned ranks = 0;            // other than this one
  unsigned lost = 0;             // ranks not used any more
  std::uint64_t meshes = 0;      // made by other ranks
  std::uint64_t bytes = 0;       // size of these meshes
  std::uint64_t given_back = 0;  // requests that returned without a mesh
  Way way;                       // the slowest round trip measured
};

class RemoteModelerPool final : public synthesis::RemoteModelers {
 public:
  // `key` and `threads` come from meet(). Measures the round trip to some ranks, which takes
  // milliseconds. Fails with kInternal if the system cannot start a thread.
  static core::Result<std::unique_ptr<RemoteModelerPool>> start(
      CompatibilityKey key, const std::vector<unsigned>& threads, Peers& peers,
      const RemoteOptions& options = {});
  // Calls end() unless it was called.
  ~RemoteModelerPool() override;

  // Call after the modelers have ended. Tells the other ranks that no more requests follow and
  // waits for their replies. Returns false if a rank does not reply within some seconds; the caller
  // then aborts the job.
  bool end();
  RemoteStats figures() const;

  // See synthesis::RemoteModelers.
  unsigned count() const override { return static_cast<unsigned>(places_.size()); }
  bool takes(const models::ModelType& type, const synthesis::Request& request) const override;
  synthesis::RemoteMesh make(unsigned place, const models::ModelType& type,
                             const synthesis::Request& request) override;
  bool is_usable(unsigned place) const override;
  void cancel(unsigned place, bool stalled) override;

 private:
  struct Place {
    unsigned rank = 0;
    std::uint64_t ticket = 0;  // of the pending request; 0: none
    bool is_cancelled = false;
    std::optional<synthesis::RemoteMesh> answer;
    std::condition_variable changed;
  };

  RemoteModelerPool(CompatibilityKey key, Peers& peers, const RemoteOptions& options);
  void add_places(const std::vector<unsigned>& threads, unsigned most);
  void measure_round_trip();
  std::optional<double> ping_s(unsigned rank, std::uint64_t bytes);
  bool wait_for_shutdown();
  void receive_answers();
  void deliver(Parcel&& parcel);
  void lose(unsigned rank, const std::string& why);

  const CompatibilityKey key_;
  Peers& peers_;
  const std::optional<double> send_above_s_;
  Way way_;
  std::deque<Place> places_;
  std::uint64_t ticket_ = 0;
  mutable std::mutex mutex_;  // guards the slots and the members below
  std::condition_variable wanted_;
  std::vector<bool> is_lost_;  // by rank
  unsigned awaited_ = 0;       // answers
  bool is_over_ = false;
  bool has_ended_ = false;
  std::atomic<std::uint64_t> meshes_{0}, bytes_{0}, given_back_{0};
  std::thread receiver_;
};

}  // namespace psygen::cluster
