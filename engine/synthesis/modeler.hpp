// A worker that executes one request at a time (paper, section 5.1: Modeler). It claims from the
// board, writes into the destination of the request, and queues a completion; it sees nothing else.
// Once the main thread has given it up, as its model hangs, it only reports when it let go of the
// destination, and ends. The mesh of a remote one is made elsewhere (remote_modelers.hpp): its
// thread touches the destination only once the bytes are here. So what it was given up with is free
// at once. No locks between requests, but for remote ones where a mesh is asked for or given back.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "engine/synthesis/completion_queue.hpp"
#include "engine/synthesis/plan_board.hpp"
#include "engine/synthesis/remote_modelers.hpp"

namespace psygen::synthesis {

// The number of the modeler that the main thread itself is (SynthesisManager::execute_here).
inline constexpr std::uint32_t kMainThreadModeler = UINT32_MAX;

// What all modelers share. Held by each of them, so that one that hangs outlives the manager
// safely.
struct Workshop {
  const models::Registry* registry = nullptr;
  std::function<double()> clock;  // called from all threads
  bool hash_content = false;
  std::vector<Annotate> annotate;  // by model; see SynthesisOptions
  PlanBoard board;
  std::atomic<bool> stop{false};
  // Modelers give up their priority before the next request; a thread cannot get it back.
  std::atomic<bool> lowest_priority{false};
  // Only for a main thread that waits for completions: a modeler locks only while `waiting`, and
  // only when it has found nothing more to do. Never between two requests.
  std::atomic<bool> waiting{false};
  std::mutex mutex;
  std::condition_variable finished;
  // Requests that remote modelers could not have made, for the main thread; under `mutex`.
  std::vector<Request> returned;
  std::atomic<bool> has_returned{false};
};

// Where the meshes of a remote modeler are made; of others nowhere.
struct RemotePlace {
  RemoteModelers* modelers = nullptr;
  unsigned number = 0;
};

// Counters with one writer, the modeler, readable from anywhere.
struct ModelerCounters {
  std::atomic<std::uint64_t> models{0}, failed{0}, triangles{0}, bytes{0};
  std::atomic<double> cpu_seconds{0}, busy_seconds{0};
  // What modelers could hold each other up with: locks taken, and claims that had to look again
  // because the plan was replaced meanwhile.
  std::atomic<std::uint64_t> locks{0}, retries{0};
};

// One modeler. Its functions are for its own thread unless they say otherwise.
class Modeler {
 public:
  Modeler(std::uint32_t number, std::shared_ptr<PlanBoard::Reader> reader, RemotePlace place = {})
      : number_(number), reader_(std::move(reader)), place_(place) {}

  // The thread's function: works until workshop.stop or until it was given up.
  void run(Workshop& workshop);

  // Executes one request in the calling thread; for a modeler that has no thread of its own.
  void perform(Workshop& workshop, const Request& request);

  // Main thread. If the present request runs since before `limit_s` (workshop clock): gives it up
  // and fills `out` with its failed completion.
  bool give_up_if_older(double limit_s, double now_s, Completion& out);
  // Main thread: whether a request that runs now was started before `limit_s`.
  bool is_older(double limit_s) const;
  // Main thread, once a remote modeler was given up: what it was given up with. Nobody touches its
  // destination.
  const Request& abandoned() const { return current_; }

  // Whether the main thread has given it up: the request and what the hook refers to may be gone.
  // Any thread.
  bool is_given_up() const {
    return (state_.load(std::memory_order_acquire) & kPhaseMask) == kGivenUp;
  }

  // Its number, its view of the board, its completions and its counters.
  std::uint32_t number() const { return number_; }
  bool is_remote() const { return place_.modelers != nullptr; }
  const RemotePlace& place() const { return place_; }
  const std::shared_ptr<PlanBoard::Reader>& reader() const { return reader_; }
  CompletionQueue& queue() { return queue_; }
  const ModelerCounters& counters() const { return counters_; }
  // Requests whose completions are queued, late ones not counted.
  std::uint64_t finished() const { return finished_.load(std::memory_order_seq_cst); }
  // The thread touches nothing any more and can be joined at once.
  bool exited() const { return exited_.load(std::memory_order_acquire); }

 private:
  // kWriting: of a remote mesh that is here; it ends soon and is not given up.
  enum Phase : std::uint64_t {
    kIdle = 0,
    kWorking = 1,
    kGivenUp = 2,
    kWriting = 3,
    kPhaseMask = 3
  };
  std::uint32_t epoch_of(const Workshop& workshop) const;
  void sleep(const Workshop& workshop, std::uint32_t epoch) const;
  bool claim(Workshop& workshop);
  void begin(double now_s);
  // False if the request was given up meanwhile.
  bool execute(Workshop& workshop);
  bool execute_there(Workshop& workshop);
  void give_back(Workshop& workshop);
  void finish(Completion&& c);
  void write_remote_mesh(const Workshop& workshop, const Annotate* annotate, RemoteMesh& mesh,
                         Completion& c);
  Warmth warmth_at(double now_s);
  bool write_mesh(const models::ModelType& type, const models::MeshView& mesh, Completion& c);
  void write_noted_mesh(const models::ModelType& type, const Annotate& annotate, Completion& c);
  models::MeshView scratch();
  void wake_waiting(Workshop& workshop);
  void count(const Completion& completion);

  const std::uint32_t number_;
  const std::shared_ptr<PlanBoard::Reader> reader_;
  const RemotePlace place_;
  Request current_;  // written while idle only
  std::uint64_t serial_ = 0;
  std::vector<std::size_t> warm_;   // codes that were run since it last did nothing
  double finished_s_ = 0;           // the last request, by the workshop's clock
  double cpu_s_ = 0;                // the thread's processor time where the present request begins
  std::vector<std::byte> scratch_;  // where meshes are made that are noted
  alignas(64) std::atomic<std::uint64_t> state_{kIdle};  // serial number of the request · 4 + phase
  std::atomic<double> started_s_{0};
  std::atomic<std::uint64_t> finished_{0};
  std::atomic<bool> exited_{false};
  ModelerCounters counters_;
  CompletionQueue queue_;
};

}  // namespace psygen::synthesis
