// From what is wanted to a plan. Every tick the caller says what it wants now; the planner takes
// back what no modeler claimed of the last plan, keeps the reservations that are still wanted,
// gives the others back, reserves for the next ones in the order of a policy until the modelers
// have enough to do for a while, and publishes. So a request is never stale for longer than a tick,
// and memory is reserved only for what is about to be written.
//
// Main thread. O(n log n) for n wants. Not the judge of what is wanted (visibility, scene).
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

// A mesh that is wanted, and how urgently.
struct Want {
  MeshKey key;
  const models::Parameters* parameters = nullptr;  // read during plan() only; see set_edits()
  std::uint64_t owner = 0;
  Rank rank;             // of the request; also decides what it may evict
  float deadline_s = 0;  // seconds from now until it is visible; for Policy::kDeadline
  bool at_once = false;  // made by this thread if it may be, even beyond PlanLimits::seconds_here
};

// Limits of one plan.
struct PlanLimits {
  double seconds_ahead = 0.25;  // predicted work per modeler in one plan, remote ones too
  std::uint32_t max_requests = 4096;
  std::uint32_t max_refusals = 16;  // reservations refused by the budget before giving up
  // For what is wanted in the groups up to `here_up_to` and whose type may run on the main thread:
  // as much of it as fits is executed, in order, before plan() returns. What a modeler holds is
  // made a second time, under another key (spare_of).
  double seconds_here = 0;
  RankGroup here_up_to = RankGroup::kVisibleHole;
  // New reservations in one plan. Where the policy is led by rank, no others are looked at: each
  // costs some microseconds (sizes, prediction, room), and wants may come by the thousand.
  std::uint32_t max_new = UINT32_MAX;
  // Of these, what is not visible: what comes in a flood, as when new ground comes near, can be
  // spread over some ticks without putting off what is seen.
  std::uint32_t max_new_hidden = UINT32_MAX;
};

// What planning did.
struct PlanReport {
  std::uint32_t published = 0;  // requests in the new plan: carried + reserved − executed
  std::uint32_t carried = 0;    // unclaimed ones of the last plan that are wanted still
  std::uint32_t reserved = 0;
  std::uint32_t executed = 0;   // of carried + reserved, executed at once and not published
  std::uint32_t cancelled = 0;  // reservations given back
  std::uint32_t ready = 0, in_flight = 0, failed = 0;  // wants that need no request
  std::uint32_t refused = 0;                           // no room
  std::uint32_t refused_visible = 0;  // of these: the caller should want coarser levels
  std::uint32_t waiting = 0;          // room is on its way; want them again in the next tick
  std::uint32_t deferred = 0;         // beyond the limits; want them again in the next tick
  double predicted_seconds = 0;       // of the whole plan, one core
};

// Makes the plans of one cache. Keeps what is requested from plan to plan.
class Planner {
 public:
  // From now on the parameters of wants refer to this layer, or to none. Requests keep their own.
  void set_edits(std::shared_ptr<const models::EditLayer> edits) { edits_ = std::move(edits); }
  // Replaces the manager's plan. Wants may repeat a key (the first in the order counts). A ready or
  // failed mesh is left as it is; a requested one takes over rank and owner of its want.
  PlanReport plan(std::span<const Want> wants, GeometryCache& cache, const CostModel& cost,
                  SynthesisManager& manager, const PlanLimits& limits = {},
                  Policy policy = Policy::kDeadline);

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;
  struct Item {
    ScheduleKey order;
    std::uint32_t want;
    MeshKey key;  // of the want, or its spare
    Work work;
    RequestCost cost;
    std::optional<models::MeshSize> size;  // of new ones, if their type told it
    std::uint32_t reclaimed = kNone;       // position in reclaimed_
  };

  void sort_out(std::span<const Want> wants, GeometryCache& cache, const CostModel& cost,
                const PlanLimits& limits, Policy policy, PlanReport& report);
  void note_arrived(const SynthesisManager& manager);
  bool is_held_up(const Want& want, MeshHandle handle, const GeometryCache& cache) const;
  // Whether this thread may make it itself.
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
  std::vector<bool> kept_;              // of reclaimed_: wanted, and not given back
  std::vector<Item> items_;
  std::vector<Item> new_;                  // those of them that need a reservation
  std::vector<std::uint32_t> last_first_;  // wanted ones of reclaimed_ in serving order
  std::vector<Request> plan_;
  double waiting_seconds_ = 0;  // predicted, of requests that wait for room
  std::optional<RankGroup> here_up_to_;
  std::vector<Slot> arrived_;  // of finished requests that have not landed yet, sorted
  struct Here {
    std::size_t at;  // in plan_
    bool at_once;
  };
  std::vector<Here> here_;  // executed by this thread as far as time allows
};

}  // namespace psygen::synthesis
