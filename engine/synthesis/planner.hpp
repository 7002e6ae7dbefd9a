// Turns the wanted meshes of a tick into a plan. The planner reclaims the unclaimed requests of the
// last plan, keeps the reservations that are still wanted and releases the others. It then reserves
// memory in the order of a policy until the modelers have enough work for a while, and publishes
// the plan. So no request is stale for longer than a tick, and memory is reserved only for meshes
// about to be written.
//
// Main thread. O(n log n) for n wanted meshes. Visibility and scene decide which meshes are wanted.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/synthesis/cost_model.hpp"
#include "engine/synthesis/geometry_cache.hpp"
#include "engine/synthesis/policy.hpp"
#include "engine/synthesis/synthesis_manager.hpp"

namespace psygen::synthesis {

// A wanted mesh and its urgency.
struct Want {
  MeshKey key;
  const models::Parameters* parameters = nullptr;  // read only during plan(); see set_edits()
  std::uint64_t owner = 0;
  Rank rank;             // of the request; also limits what it may evict
  float deadline_s = 0;  // seconds from now until it is visible; for Policy::kDeadline
  bool at_once = false;  // made by this thread if allowed, even beyond PlanLimits::seconds_here
};

// Limits of one plan.
struct PlanLimits {
  double seconds_ahead = 0.25;  // predicted work per modeler in one plan, remote ones too
  std::uint32_t max_requests = 4096;
  std::uint32_t max_refusals = 16;  // reservations rejected by the budget before planning stops
  // Seconds that this thread may spend before plan() returns. It executes wanted meshes of the
  // groups up to `here_up_to` whose types may run on the main thread, in order, as far as time
  // allows. It makes a duplicate, under another key (duplicate_of), of a mesh that a modeler holds.
  double seconds_here = 0;
  RankGroup here_up_to = RankGroup::kVisibleHole;
  // New reservations in one plan. If the policy orders by rank, no further ones are considered:
  // each costs some microseconds (sizes, prediction, memory), and a tick may have thousands.
  std::uint32_t max_new = UINT32_MAX;
  // New reservations of invisible meshes. A burst, such as new ground that comes near, is spread
  // over some ticks without delaying visible meshes.
  std::uint32_t max_new_hidden = UINT32_MAX;
};

// Counts of one plan.
struct PlanReport {
  std::uint32_t published = 0;  // requests in the new plan: carried + reserved − executed
  std::uint32_t carried = 0;    // unclaimed requests of the last plan that are still wanted
  std::uint32_t reserved = 0;
  std::uint32_t executed = 0;   // of carried + reserved: executed at once and not published
  std::uint32_t cancelled = 0;  // released reservations
  std::uint32_t ready = 0, in_flight = 0, failed = 0;  // wants that need no request
  std::uint32_t refused = 0;                           // no memory
  std::uint32_t refused_visible = 0;  // of these, visible: the caller should want coarser levels
  std::uint32_t waiting = 0;          // memory is being freed; want them again in the next tick
  std::uint32_t deferred = 0;         // beyond the limits; want them again in the next tick
  double predicted_seconds = 0;       // of the whole plan, one core
};

// Makes the plans of one cache. Keeps requested meshes from plan to plan.
class Planner {
 public:
  // Sets the edit layer, possibly null, that the parameters of future wants refer to. Requests keep
  // theirs.
  void set_edits(std::shared_ptr<const models::EditLayer> edits) { edits_ = std::move(edits); }
  // Replaces the manager's plan. Wants may repeat a key; the first in serving order counts. Ready
  // and failed meshes stay as they are; a requested one takes rank and owner of its want.
  PlanReport plan(std::span<const Want> wants, GeometryCache& cache, const CostModel& cost,
                  SynthesisManager& manager, const PlanLimits& limits = {},
                  Policy policy = Policy::kDeadline);

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;
  struct Item {
    ScheduleKey order;
    std::uint32_t want;
    MeshKey key;  // of the want, or of its duplicate
    Work work;
    RequestCost cost;
    std::optional<models::MeshSize> size;  // of new ones, if the type provides it
    std::uint32_t reclaimed = kNone;       // position in reclaimed_
  };

  void sort_out(std::span<const Want> wants, GeometryCache& cache, const CostModel& cost,
                const PlanLimits& limits, Policy policy, PlanReport& report);
  void note_arrived(const SynthesisManager& manager);
  bool is_blocked(const Want& want, MeshHandle handle, const GeometryCache& cache) const;
  // Returns true if this thread may make the mesh itself.
  bool is_urgent(const Want& want, const GeometryCache& cache) const {
    return here_up_to_ && want.rank.group() <= *here_up_to_ &&
           cache.registry()[want.key.model].may_run_on_main_thread();
  }
  void leave_for_later(const PlanLimits& limits, Policy policy, PlanReport& report);
  void keep_first(std::size_t first, std::size_t count, Policy policy, PlanReport& report);
  std::uint32_t reclaimed_position(MeshHandle handle) const;
  void give_back_unwanted(GeometryCache& cache, PlanReport& report);
  bool give_back_last(GeometryCache& cache, PlanReport& report);
  void add(const Item& item, const Want& want, GeometryCache& cache, PlanReport& report);
  void append(const Request& request, const Want& want, const GeometryCache& cache) {
    if (is_urgent(want, cache)) here_.push_back({plan_.size(), want.at_once});
    plan_.push_back(request);
  }
  void execute_here(SynthesisManager& manager, double seconds, PlanReport& report);

  std::shared_ptr<const models::EditLayer> edits_for(const models::Parameters& parameters) const;

  std::shared_ptr<const models::EditLayer> edits_;
  std::vector<Request> reclaimed_;
  std::vector<std::uint32_t> by_slot_;  // positions in reclaimed_, sorted by slot
  std::vector<bool> kept_;              // of reclaimed_: wanted and not released
  std::vector<Item> items_;
  std::vector<Item> new_;                  // those items that need a reservation
  std::vector<std::uint32_t> last_first_;  // wanted ones of reclaimed_ in serving order
  std::vector<Request> plan_;
  double waiting_seconds_ = 0;  // predicted, of requests that wait for memory
  std::optional<RankGroup> here_up_to_;
  std::vector<Slot> arrived_;  // of finished requests that are not ready yet, sorted
  struct Here {
    std::size_t at;  // in plan_
    bool at_once;
  };
  std::vector<Here> here_;  // executed by this thread as far as time allows
};

}  // namespace psygen::synthesis
