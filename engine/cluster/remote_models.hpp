// The ranks that make meshes for a flight, as its modelers see them: places of a SynthesisManager
// (synthesis/remote_modelers.hpp), one for each thread of another rank. Measures what a mesh takes
// on its way, and takes only requests that take longer. A thread of its own receives answers while
// some are awaited, and sleeps otherwise. A rank that does not answer, answers what is damaged or
// refuses a request is not used any more. For one session. Rank 0; the others: serve_models().
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
  // Requests that are predicted to take longer, in seconds of a core, may go; not set: longer than
  // their way there and back, which is measured.
  std::optional<double> send_above_s;
  unsigned max_places = 256;  // each has a thread here, which mostly sleeps
};

// What a mesh takes there and back, beside being made.
struct Way {
  double latency_s = 0;         // of a message and its answer, without a mesh
  double bytes_per_second = 0;  // of the mesh
  double seconds(double bytes) const {
    return latency_s + (bytes_per_second > 0 ? bytes / bytes_per_second : 0);
  }
};

// What came of it.
struct RemoteFigures {
  unsigned ranks = 0;            // others than this one
  unsigned lost = 0;             // of these, not used any more
  std::uint64_t meshes = 0;      // that they made
  std::uint64_t bytes = 0;       // of these meshes
  std::uint64_t given_back = 0;  // requests that came back without a mesh
  Way way;                       // the longest of those that were measured
};

class RemoteModels final : public synthesis::RemoteModelers {
 public:
  // `key` and `threads` are those of meet(). Sends some messages to some ranks, which takes
  // milliseconds. Fails with kInternal where the system gives no thread.
  static core::Result<std::unique_ptr<RemoteModels>> start(FlightKey key,
                                                           const std::vector<unsigned>& threads,
                                                           Peers& peers,
                                                           const RemoteOptions& options = {});
  // end(), where it was not called.
  ~RemoteModels() override;

  // The modelers have ended: tells the others that no more comes and waits until they have said
  // so. False where one does not within some seconds: then the job has to be aborted.
  bool end();
  RemoteFigures figures() const;

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
    std::uint64_t ticket = 0;  // of what it waits for; 0: nothing
    bool is_cancelled = false;
    std::optional<synthesis::RemoteMesh> answer;
    std::condition_variable changed;
  };

  RemoteModels(FlightKey key, Peers& peers, const RemoteOptions& options);
  void add_places(const std::vector<unsigned>& threads, unsigned most);
  void measure_way();
  std::optional<double> ping_s(unsigned rank, std::uint64_t bytes);
  bool await_byes();
  void receive_answers();
  void deliver(Parcel&& parcel);
  void lose(unsigned rank, const std::string& why);

  const FlightKey key_;
  Peers& peers_;
  const std::optional<double> send_above_s_;
  Way way_;
  std::deque<Place> places_;
  std::uint64_t ticket_ = 0;
  mutable std::mutex mutex_;  // of the places and what follows
  std::condition_variable wanted_;
  std::vector<bool> is_lost_;  // by rank
  unsigned awaited_ = 0;       // answers
  bool is_over_ = false;
  bool has_ended_ = false;
  std::atomic<std::uint64_t> meshes_{0}, bytes_{0}, given_back_{0};
  std::thread receiver_;
};

}  // namespace psygen::cluster
