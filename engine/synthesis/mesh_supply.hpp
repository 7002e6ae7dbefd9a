// Supplies meshes; the only interface of this folder. Every tick the caller states the wanted
// meshes, plans, and makes finished meshes ready. Ready meshes are ranked; the worst ones are
// evicted when memory is needed. The cost model, the planner, the modelers and the cache are
// private parts with their own tests. Visibility and scene decide which meshes are wanted.
//
// Main thread only. Nothing blocks except wait(), help() and the destructor.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/synthesis/cost_model.hpp"
#include "engine/synthesis/geometry_cache.hpp"
#include "engine/synthesis/planner.hpp"
#include "engine/synthesis/request.hpp"
#include "engine/synthesis/synthesis_manager.hpp"

namespace psygen::synthesis {

// Counts of one land() call, in meshes.
struct LandingReport {
  std::uint32_t ready = 0;
  std::uint32_t failed = 0;   // threw, or abandoned
  std::uint32_t settled = 0;  // hung modelers that released their destination
  std::uint64_t bytes = 0;    // of the meshes that became ready
};

// Completes or fails each mesh in the cache, which happens only here; stale handles are dropped.
// `cost`, if not null, learns from every success on this machine. Completions may come in any
// order, except that a late one follows its abandoned one. Notes are stored in the records of their
// meshes.
LandingReport land(std::span<Completion> completions, GeometryCache& cache, CostModel* cost);

// One for each scene.
class MeshSupply {
 public:
  // No other function may be called before open().
  MeshSupply() = default;
  // Ends the modelers, then frees all memory.
  ~MeshSupply() = default;
  MeshSupply(const MeshSupply&) = delete;
  MeshSupply& operator=(const MeshSupply&) = delete;

  // Starts with an empty cache of at most `budget_bytes` in `memory`. Both outlive the supply. Call
  // once.
  void open(const models::Registry& registry, core::GeometryMemory& memory,
            std::uint64_t budget_bytes);
  // Measures the model types on this machine; see CostModel::calibrate().
  CalibrationReport calibrate(std::span<const CostSample> samples, double seconds_limit,
                              const std::function<void(double)>& progress);
  // Starts the modelers that the system has threads for; returns their number. Call once.
  unsigned start_modelers(const SynthesisOptions& options);
  // Reason why fewer modelers than requested started; empty otherwise.
  const std::string& shortage() const { return manager_->shortage(); }
  // Limits modelers from now on to processor time that no other program uses.
  void lower_priority() { manager_->lower_priority(); }

  // Lookup --------------------------------------------------------------------------------------
  MeshHandle find(const MeshKey& key) const { return cache_->find(key); }
  // Like find(), and counts a hit or a miss.
  MeshHandle look_up(const MeshKey& key) { return cache_->look_up(key); }
  // Record of the mesh, or nullptr if the handle is stale. Valid until the next plan().
  const MeshRecord* get(MeshHandle handle) const { return cache_->get(handle); }
  // Record of the mesh if it is ready, else nullptr.
  const MeshRecord* ready(MeshHandle handle) const;

  // Wanted meshes -------------------------------------------------------------------------------
  // Sets the edit layer, possibly null, that the parameters of future wants refer to. Earlier
  // requests keep theirs.
  void set_edits(std::shared_ptr<const models::EditLayer> edits) {
    planner_.set_edits(std::move(edits));
  }
  // Forgets the wanted meshes of the last tick.
  void begin_wants() { wants_.clear(); }
  // Its parameters must live until the next begin_wants().
  void want(const Want& want) { wants_.push_back(want); }
  // Meshes wanted since begin_wants(), in that order.
  std::span<const Want> wants() const { return wants_; }
  // Replaces the plan of the modelers with one for these meshes; see Planner::plan().
  PlanReport plan(const PlanLimits& limits, Policy policy);
  // Plans for the given meshes instead of wants().
  PlanReport plan(std::span<const Want> wants, const PlanLimits& limits, Policy policy);
  // Predicted seconds of one core, with warm caches.
  double predict(const Want& want) const;
  // The cost model of all types. Other models may copy from it in any thread.
  const CostModel& costs() const { return *cost_; }

  // Finished meshes -----------------------------------------------------------------------------
  // Collects the meshes finished since the last call and returns them; land() makes them ready.
  std::span<const Completion> collect();
  // Returns true if a collected mesh has not been made ready.
  bool has_arrived() const { return !arrived_.empty(); }
  struct Landed {
    std::vector<Completion> completions;  // oldest first, including failed ones
    std::uint64_t bytes = 0;              // of the meshes that became ready
  };
  // Makes the oldest collected meshes ready, until `max_bytes` are reached or exceeded.
  Landed land(std::uint64_t max_bytes);

  // Change of model types -------------------------------------------------------------------------
  // Call before types of the registry change. Drops unclaimed requests, waits for the others and
  // makes them ready. Dropped meshes must be requested again. Returns false if a modeler hangs: the
  // types that it uses must then stay alive.
  bool quiesce();
  // Call after the types have changed, before any other function. Learned costs are kept for types
  // with the same name. `annotate` as in SynthesisOptions.
  void adopt_types(std::vector<Annotate> annotate);

  // Cached meshes -------------------------------------------------------------------------------
  // Sets the rank of a mesh. This function and those below ignore stale handles.
  void rank(MeshHandle handle, Rank rank) { cache_->set_rank(handle, rank); }
  // Another owner wants an existing mesh.
  void adopt(MeshHandle handle, std::uint64_t owner, Rank rank) {
    cache_->adopt(handle, owner, rank);
  }
  // Frees a mesh at once.
  void forget(MeshHandle handle) { cache_->release(handle); }
  // Evictions since the last call. Valid until the next call.
  std::span<const Eviction> take_evictions() { return cache_->take_evictions(); }
  // Records that these meshes are drawn, for statistics.
  void note_drawn(std::span<const MeshHandle> handles) { cache_->note_drawn(handles); }
  // Changes the budget; see GeometryCache::set_budget().
  void set_budget(std::uint64_t bytes) { cache_->set_budget(bytes); }

  // Waiting and statistics ----------------------------------------------------------------------
  // Blocks until every request is finished or abandoned; see SynthesisManager::wait_all().
  bool wait(const std::function<bool()>& go_on = {}) { return manager_->wait_all(go_on); }
  // The same, and this thread makes meshes meanwhile, unless the clock is virtual or other ranks
  // help.
  bool help(const std::function<bool()>& go_on = {}) { return manager_->wait_all(go_on, true); }
  // Number of planned requests that are not finished.
  std::uint64_t outstanding() const { return manager_->outstanding(); }
  // Abandoned requests whose modelers hang.
  const std::vector<HungRequest>& hung() const { return manager_->hung(); }
  // Statistics of the cache and of the modelers, since open().
  CacheStats stats() const { return cache_->stats(); }
  SynthesisStats modeler_stats() const { return manager_->stats(); }
  // All slots of the cache; free ones are empty.
  std::span<const MeshRecord> records() const { return cache_->records(); }

 private:
  // Declared first: modelers write into the cache's memory, so they must end before it.
  std::unique_ptr<GeometryCache> cache_;
  std::unique_ptr<CostModel> cost_;
  Planner planner_;
  std::unique_ptr<SynthesisManager> manager_;
  std::vector<Want> wants_;
  std::vector<Completion> arrived_;  // not ready yet, oldest first
};

}  // namespace psygen::synthesis
