// Keeps the modelers busy (paper, section 5.1: Synthesis Manager). The main thread publishes a
// sorted plan; modelers claim the next request whenever they are free. Cancelling is replacing the
// plan. The watchdog gives up what never ends, and puts a new modeler in place of the one that
// hangs. Remote modelers (remote_modelers.hpp) take only what is worth its way; what one comes back
// without is made here. Main thread only. Does not decide what is requested (planner.hpp), and does
// not touch the cache (landing.hpp). wait_all(), come_to_rest() and the destructor block.
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
  unsigned modelers = 0;               // 0: number of cores − 1, at least 1
  bool hash_content = false;           // fill Completion::content_hash
  double watchdog_seconds = 10;        // a request that runs longer is given up; 0: never
  unsigned max_replacements = 8;       // modelers started in place of hung ones, altogether
  std::function<double()> clock = {};  // thread-safe; default: core::monotonic_seconds
  // If given, modelers take what is predicted of requests by this clock, which the caller moves
  // (virtual_modelers.hpp). It has one modeler; `modelers` threads execute what that claims.
  std::function<double()> virtual_clock = {};
  // What is noted of meshes, by model index; empty ones and those beyond the end note nothing. What
  // they refer to outlives the manager as the registry does. Meshes of these models are synthesised
  // in memory of the modeler's own and copied to their destinations, which may be slow to read.
  std::vector<Annotate> annotate = {};
  // Further modelers that are not threads here; null: none. Of this manager only, and not with a
  // virtual clock.
  RemoteModelers* remote = nullptr;
};

// Number of modelers that `requested` (0: default) stands for on this machine.
unsigned modeler_count_for(unsigned requested);

// Figures of one modeler.
struct ModelerStats {
  std::uint32_t modeler = 0;  // kMainThreadModeler: execute_here()
  std::uint64_t models = 0, failed = 0, triangles = 0, bytes = 0;
  double cpu_seconds = 0;                // of its thread, in requests
  double busy_seconds = 0;               // by the clock, in requests
  std::uint64_t locks = 0, retries = 0;  // see ModelerCounters
  bool remote = false;
};

// Figures of all modelers.
struct SynthesisStats {
  std::uint64_t models = 0, failed = 0, triangles = 0, bytes = 0;
  double cpu_seconds = 0;  // of all modelers
  // Reclaimed: also what remote modelers gave back, or were given up with.
  std::uint64_t published = 0, reclaimed = 0, given_up = 0;
  std::vector<ModelerStats> modelers;  // those that hung included
};

// A request that the watchdog gave up and whose modeler has not come back.
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
  // Starts as many modelers as it gets threads and memory for; with none nothing is ever finished.
  // `registry` outlives the manager, and any modeler that hangs at the end of the program.
  explicit SynthesisManager(const models::Registry& registry, const SynthesisOptions& options = {});
  // Joins within the time of the requests that run now; what is unclaimed is dropped. A modeler
  // that overruns the watchdog is left to itself: its request's destination must stay valid until
  // the process ends (a program in this state should leave without tearing its memory down).
  ~SynthesisManager();
  SynthesisManager(const SynthesisManager&) = delete;
  SynthesisManager& operator=(const SynthesisManager&) = delete;

  // Replaces the plan. Modelers take requests from the front. What was not claimed of the plan
  // before is not lost: the next reclaim() returns it.
  void publish(std::vector<Request>&& plan);
  // Executes a request that was never published, in the calling thread; its completion is collected
  // like any other. For the few small meshes whose absence is seen: modelers at the lowest priority
  // may not get a processor for a while.
  void execute_here(const Request& request);
  // Replaces SynthesisOptions::annotate. Only while nothing is outstanding.
  void set_notes(std::vector<Annotate> annotate) { workshop_->annotate = std::move(annotate); }
  // From now on modelers take only what other threads leave of the processors: nice 19 per thread,
  // where the system can. For when frames begin; before, the thread that waits for meshes has
  // nothing else to do. With a virtual clock the caller waits for them, and they stay as they are.
  void lower_priority() {
    if (!virtual_) workshop_->lowest_priority.store(true, std::memory_order_relaxed);
  }
  // Closes the plan; returns what was not claimed, in order. Everything else was or will be
  // collected.
  std::vector<Request> reclaim();
  // What was finished when the plan was last closed: the next collect() returns it.
  std::span<const Completion> arrived() const { return arrived_; }
  // Appends the completions that have arrived, in order per modeler; returns how many. Runs the
  // watchdog. Each claimed request has exactly one completion (plus a `late` one if abandoned).
  std::size_t collect(std::vector<Completion>& out);
  // Blocks until every published request is finished or given up; a virtual clock stands still
  // meanwhile. For tools, tests and the lazy paradigm; the tick never calls it. False if no modeler
  // is left here to finish them (remote ones may be at work still), and once `go_on`, called some
  // 50 times a second, says so (never by a virtual clock, where nothing is waited for).
  bool wait_all(const std::function<bool()>& go_on = {});
  // Requires that the plan is empty. Blocks until everything that was claimed is finished or given
  // up, by remote modelers too. Returns what these came back without, which nobody makes any more.
  std::vector<Request> come_to_rest();

  // Requests published and neither reclaimed nor finished.
  std::uint64_t outstanding() const;
  // Those that are threads here, or of the virtual clock.
  unsigned modeler_count() const {
    return virtual_ && !active_.empty() ? virtual_->count() : local_count();
  }
  unsigned remote_count() const { return static_cast<unsigned>(active_.size()) - local_count(); }
  // Whether a request is offered to remote modelers, too.
  bool may_go(const Request& request) const;
  // Why not all modelers that were asked for could be started; empty if they were.
  const std::string& shortage() const { return shortage_; }
  const std::vector<HungRequest>& hung() const { return hung_; }
  // No modeler that was given up uses anything any more, as of the last collect().
  bool is_at_rest() const { return retired_.empty(); }
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
  bool wait_for_threads(const std::function<bool()>& go_on = {});
  bool await_finished();
  std::uint64_t outstanding_in_threads() const;
  bool execute_jobs(const std::vector<VirtualModelers::Job>& jobs);
  core::Result<void> start_modeler(RemotePlace place = {});
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
  Modeler here_{kMainThreadModeler, nullptr};
  double watchdog_seconds_;
  unsigned replacements_left_;
  std::uint32_t next_number_ = 0;
  std::string shortage_;
  std::vector<Worker> active_;
  std::vector<Worker> retired_;  // hung, or back from it and not yet joined
  std::vector<HungRequest> hung_;
  std::vector<Completion> abandoned_;  // not yet collected
  std::vector<Completion> arrived_;    // not yet collected
  std::vector<Request> unclaimed_;     // of closed plans, not yet returned
  std::vector<Request> returned_;      // remote modelers have not made them
  std::vector<ModelerStats> buried_;   // figures of modelers that are gone
  std::uint64_t published_ = 0, reclaimed_ = 0, given_up_ = 0, buried_finished_ = 0;
};

}  // namespace psygen::synthesis
