// Supplies meshes; the only front of this folder. The caller says every tick what it wants, plans,
// and lands what has arrived. Kept meshes are ranked, and the worst ones are evicted when memory is
// needed. The cost model, the planner, the modelers and the cache are private parts with tests of
// their own. It does not decide what is wanted (visibility and scene do).
//
// Main thread only. Nothing blocks except wait() and the destructor.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/synthesis/cost_model.hpp"
#include "engine/synthesis/geometry_cache.hpp"
#include "engine/synthesis/landing.hpp"
#include "engine/synthesis/planner.hpp"
#include "engine/synthesis/synthesis_manager.hpp"

namespace psygen::synthesis {

// One for each scene.
class MeshSupply {
 public:
  // Nothing else may be called before open().
  MeshSupply() = default;
  // Ends the modelers, then gives all memory back.
  ~MeshSupply() = default;
  MeshSupply(const MeshSupply&) = delete;
  MeshSupply& operator=(const MeshSupply&) = delete;

  // Starts with an empty cache of at most `budget_bytes` in `memory`. Both outlive the supply.
  // Once.
  void open(const models::Registry& registry, core::GeometryMemory& memory,
            std::uint64_t budget_bytes);
  // Measures the model types on this machine; see CostModel::calibrate().
  CalibrationReport calibrate(std::span<const CostSample> samples,
                              const std::function<void(double)>& progress);
  // Starts as many modelers as there are threads for; returns how many. Once.
  unsigned start_modelers(const SynthesisOptions& options);
  // Why there are fewer modelers than asked for; empty if there are not.
  const std::string& shortage() const { return manager_->shortage(); }
  // From now on modelers get only the processor time that no other program wants.
  void lower_priority() { manager_->lower_priority(); }

  // What is there -------------------------------------------------------------------------------
  MeshHandle find(const MeshKey& key) const { return cache_->find(key); }
  // As find(), and counts a hit or a miss.
  MeshHandle look_up(const MeshKey& key) { return cache_->look_up(key); }
  // nullptr if the handle is stale. Valid until the next plan().
  const MeshRecord* get(MeshHandle handle) const { return cache_->get(handle); }
  // The record, if the mesh is there and ready, else nullptr.
  const MeshRecord* ready(MeshHandle handle) const;

  // What is wanted ------------------------------------------------------------------------------
  // From now on the parameters of wants refer to this layer of edits, or to none. Requests that
  // were made before keep theirs.
  void set_edits(std::shared_ptr<const models::EditLayer> edits) {
    planner_.set_edits(std::move(edits));
  }
  // Forgets the wants of the last tick.
  void begin_wants() { wants_.clear(); }
  // Its parameters must live until the next begin_wants().
  void want(const Want& want) { wants_.push_back(want); }
  // What was wanted since begin_wants(), in that order.
  std::span<const Want> wants() const { return wants_; }
  // Replaces the plan of the modelers by one for these wants; see Planner::plan().
  PlanReport plan(const PlanLimits& limits, Policy policy);
  // The same for some of them, or for others.
  PlanReport plan(std::span<const Want> wants, const PlanLimits& limits, Policy policy);
  // Predicted seconds of one core, with warm caches.
  double predict(const Want& want) const;
  // What is known of the costs of types. Other models may learn from a copy, in any thread.
  const CostModel& costs() const { return *cost_; }

  // What has come -------------------------------------------------------------------------------
  // Takes what modelers have finished since the last call. Returns it; it waits for land().
  std::span<const Completion> collect();
  // Whether something was collected and not landed.
  bool has_arrived() const { return !arrived_.empty(); }
  struct Landed {
    std::vector<Completion> completions;  // oldest first, failed ones too
    std::uint64_t bytes = 0;              // of the meshes that are ready now
  };
  // Makes the oldest of what was collected ready, until `max_bytes` are reached or exceeded.
  Landed land(std::uint64_t max_bytes);

  // Other types -----------------------------------------------------------------------------------
  // To be called before types of the registry change. Gives up what no modeler has begun, waits for
  // the rest and makes it ready. What was requested must be wanted anew. False if a modeler hangs:
  // then the types that it uses must live on.
  bool come_to_rest();
  // To be called once they have changed, and before anything else. What was learnt of types with
  // the same name is kept. `annotate` as in SynthesisOptions.
  void take_over_types(std::vector<Annotate> annotate);

  // What is kept --------------------------------------------------------------------------------
  // How important a mesh is from now on. Stale handles are ignored here and below.
  void rank(MeshHandle handle, Rank rank) { cache_->set_rank(handle, rank); }
  // Another owner wants a mesh that is there.
  void adopt(MeshHandle handle, std::uint64_t owner, Rank rank) {
    cache_->adopt(handle, owner, rank);
  }
  // Gives a mesh back at once.
  void forget(MeshHandle handle) { cache_->release(handle); }
  // What was evicted since the last call. Valid until the next call.
  std::span<const Eviction> take_evictions() { return cache_->take_evictions(); }
  // These meshes are drawn now, for the statistics.
  void note_drawn(std::span<const MeshHandle> handles) { cache_->note_drawn(handles); }
  // Changes the budget; see GeometryCache::set_budget().
  void set_budget(std::uint64_t bytes) { cache_->set_budget(bytes); }

  // Waiting and figures -------------------------------------------------------------------------
  // Blocks until every request is finished or given up; see SynthesisManager::wait_all().
  bool wait(const std::function<bool()>& go_on = {}) { return manager_->wait_all(go_on); }
  // Requests that are planned and not finished.
  std::uint64_t outstanding() const { return manager_->outstanding(); }
  // Requests whose modelers hung and were given up.
  const std::vector<HungRequest>& hung() const { return manager_->hung(); }
  // Figures of the cache and of the modelers, since open().
  CacheStats stats() const { return cache_->stats(); }
  SynthesisStats modeler_stats() const { return manager_->stats(); }
  // All slots of the cache; free ones are empty.
  std::span<const MeshRecord> records() const { return cache_->records(); }

 private:
  // Modelers write into the memory of the cache: they end before it.
  std::unique_ptr<GeometryCache> cache_;
  std::unique_ptr<CostModel> cost_;
  Planner planner_;
  std::unique_ptr<SynthesisManager> manager_;
  std::vector<Want> wants_;
  std::vector<Completion> arrived_;  // not landed yet, oldest first
};

}  // namespace psygen::synthesis
