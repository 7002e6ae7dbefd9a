// Keeps the modelers busy (paper, section 5.1: Synthesis Manager). The main thread publishes a
// sorted plan; modelers claim the next request whenever they are free. Replacing the plan cancels
// unclaimed requests. The watchdog abandons requests that never end and replaces hung modelers.
// Remote modelers (remote_modelers.hpp) take only meshes that outweigh their round trip; a request
// that one returns is made here. Main thread only. The planner (planner.hpp) decides the requests;
// land() (mesh_supply.hpp) updates the cache. wait_all(), quiesce() and the destructor block.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "engine/synthesis/modeler.hpp"
#include "engine/synthesis/request.hpp"
#include "engine/synthesis/virtual_modelers.hpp"

namespace psygen::synthesis {

// Options of the modelers.
struct SynthesisOptions {
  unsigned modelers = 0;               // 0: core::usable_processors() − 1, at least 1
  bool hash_content = false;           // fill Completion::content_hash
  double watchdog_seconds = 10;        // a request that runs longer is abandoned; 0: never
  unsigned max_replacements = 8;       // total number of modelers started to replace hung ones
  std::function<double()> clock = {};  // thread-safe; default: core::monotonic_seconds
  // If set, requests take their predicted time by this clock, which the caller advances
  // (virtual_modelers.hpp). It has one modeler; `modelers` threads execute the requests that it
  // claims.
  std::function<double()> virtual_clock = {};
  // Annotation functions by model index; empty ones and models beyond the end have none. Objects
  // that they refer to outlive the manager, as the registry does. Annotated meshes are synthesised
  // in the modeler's memory and copied to their destinations, which may be slow to read.
  std::vector<Annotate> annotate = {};
  // Additional modelers outside this process; null: none. They serve only this manager, and not
  // with a virtual clock.
  RemoteModelers* remote = nullptr;
};

// Number of modelers that `requested` means on this machine (0: default).
unsigned modeler_count_for(unsigned requested);

// Statistics of one modeler.
struct ModelerStats {
  std::uint32_t modeler = 0;  // kMainThreadModeler: execute_here()
  std::uint64_t models = 0, failed = 0, triangles = 0, bytes = 0;
  double cpu_seconds = 0;                // of its thread, while executing requests
  double busy_seconds = 0;               // by the clock, while executing requests
  std::uint64_t locks = 0, retries = 0;  // see ModelerCounters
  bool remote = false;
};

// Statistics of all modelers.
struct SynthesisStats {
  std::uint64_t models = 0, failed = 0, triangles = 0, bytes = 0;
  double cpu_seconds = 0;  // of all modelers
  // `reclaimed` includes requests that remote modelers returned or were abandoned with, and those
  // that a waiting thread took to make them.
  std::uint64_t published = 0, reclaimed = 0, given_up = 0;
  std::vector<ModelerStats> modelers;  // including hung ones
};

// A request that the watchdog abandoned and whose modeler still runs.
struct HungRequest {
  MeshHandle handle;
  MeshKey key;
  std::uint64_t owner = 0;
  std::uint32_t modeler = 0;
  double started_s = 0;
};

// Owns the modelers.
class SynthesisManager {
 public:
  // Starts as many modelers as threads and memory allow; with none, no request is ever finished.
  // `registry` outlives the manager, and any modeler that hangs at the end of the program.
  explicit SynthesisManager(const models::Registry& registry, const SynthesisOptions& options = {});
  // Joins after the running requests finish; drops unclaimed ones. A modeler that exceeds the
  // watchdog's limit is detached: its request's destination must stay valid until the process ends,
  // so such a program should exit without freeing its memory.
  ~SynthesisManager();
  SynthesisManager(const SynthesisManager&) = delete;
  SynthesisManager& operator=(const SynthesisManager&) = delete;

  // Replaces the plan. Modelers claim requests from the front. The next reclaim() returns the
  // unclaimed requests of the previous plan.
  void publish(std::vector<Request>&& plan);
  // Executes an unpublished request in the calling thread; its completion is collected like any
  // other. For the few small meshes whose absence is visible: modelers at the lowest priority may
  // not get a processor for a while.
  void execute_here(const Request& request);
  // Replaces SynthesisOptions::annotate. Requires that nothing is outstanding.
  void set_notes(std::vector<Annotate> annotate) { workshop_->annotate = std::move(annotate); }
  // Limits modelers from now on to processor time that other threads leave: nice 19 per thread,
  // where the system supports it. Call when frames begin; before, the thread that waits for meshes
  // has nothing else to do. With a virtual clock the caller waits for the modelers, so their
  // priority stays.
  void lower_priority() {
    if (!virtual_) workshop_->lowest_priority.store(true, std::memory_order_relaxed);
  }
  // Closes the plan and returns the unclaimed requests in order. All others were or will be
  // collected.
  std::vector<Request> reclaim();
  // Completions that had arrived when the plan was last closed; the next collect() returns them.
  std::span<const Completion> arrived() const { return arrived_; }
  // Appends the completions that have arrived, in order per modeler; returns their number. Runs the
  // watchdog. Each claimed request has exactly one completion (plus a `late` one if abandoned).
  std::size_t collect(std::vector<Completion>& out);
  // Blocks until every published request is finished or abandoned; a virtual clock stands still
  // during the call. For tools, tests and the lazy paradigm; the tick never calls it. Returns false
  // if no local modeler is left to finish them (remote ones may still work), or once `go_on`
  // returns false. `go_on` is called about 50 times a second, but never with a virtual clock, which
  // waits for nothing. `helps`: the calling thread makes meshes of types that may run on a main
  // thread meanwhile, unless there are remote modelers.
  bool wait_all(const std::function<bool()>& go_on = {}, bool helps = false);
  // Requires an empty plan. Blocks until all claimed requests are finished or abandoned, remote
  // ones included. Returns requests that remote modelers returned; no modeler makes them any more.
  std::vector<Request> quiesce();

  // Number of published requests that are neither reclaimed nor finished.
  std::uint64_t outstanding() const;
  // Number of local modelers, or of modelers of the virtual clock.
  unsigned modeler_count() const {
    return virtual_ && !active_.empty() ? virtual_->count() : local_count();
  }
  unsigned remote_count() const { return static_cast<unsigned>(active_.size()) - local_count(); }
  // Returns true if a request is also offered to remote modelers.
  bool is_offered_remotely(const Request& request) const;
  // Reason why fewer modelers than requested started; empty otherwise.
  const std::string& shortage() const { return shortage_; }
  const std::vector<HungRequest>& hung() const { return hung_; }
  // True if no abandoned modeler accesses anything any more, as of the last collect().
  bool is_idle() const { return retired_.empty(); }
  SynthesisStats stats() const;

 private:
  struct Worker {
    std::shared_ptr<Modeler> modeler;
    std::thread thread;
  };
  SynthesisManager(const models::Registry& registry, const SynthesisOptions& options,
                   unsigned most);
  static ModelerStats stats_of(const Modeler& modeler);
  void publish_to_threads(std::vector<Request>&& plan);
  void drain();
  void drain_threads(std::vector<Completion>& out);
  bool wait_for_threads(const std::function<bool()>& go_on = {}, bool helps = false);
  bool await_finished();
  bool make_next_here();
  std::uint64_t outstanding_in_threads() const;
  bool execute_jobs(const std::vector<VirtualModelers::Job>& jobs);
  core::Result<void> start_modeler(RemoteSlot place = {});
  void start_remote(RemoteModelers& remote);
  unsigned local_count() const;
  void take_returned();
  bool publish_returned();
  bool give_up_local(const Worker& worker, double now_s);
  bool give_up_remote(const Worker& worker, double now_s);
  void run_watchdog();
  void drain_retired(std::vector<Completion>& out);
  void close_plan();
  void leave(Worker& worker);

  std::shared_ptr<Workshop> workshop_;
  std::optional<VirtualModelers> virtual_;
  std::function<double()> virtual_clock_;
  RemoteModelers* remote_ = nullptr;
  std::shared_ptr<PlanQueue::Reader> own_reader_;  // of make_next_here()
  Modeler here_{kMainThreadModeler, nullptr};
  double watchdog_seconds_;
  unsigned replacements_left_;
  std::uint32_t next_number_ = 0;
  std::string shortage_;
  std::vector<Worker> active_;
  std::vector<Worker> retired_;  // hung, or returned from it and not yet joined
  std::vector<HungRequest> hung_;
  std::vector<Completion> abandoned_;  // not yet collected
  std::vector<Completion> arrived_;    // not yet collected
  std::vector<Request> unclaimed_;     // of closed plans, not yet returned
  std::vector<Request> returned_;      // remote modelers did not make them
  std::vector<ModelerStats> buried_;   // of modelers that have ended
  std::uint64_t published_ = 0, reclaimed_ = 0, given_up_ = 0, buried_finished_ = 0;
};

}  // namespace psygen::synthesis
