#include "engine/synthesis/planner.hpp"

#include <algorithm>
#include <numeric>

#include "engine/core/assert.hpp"

namespace psygen::synthesis {

// Position of the unclaimed request of this mesh in reclaimed_, or kNone.
std::uint32_t Planner::reclaimed_position(MeshHandle handle) const {
  const auto it = std::lower_bound(
      by_slot_.begin(), by_slot_.end(), handle.slot,
      [&](std::uint32_t position, Slot slot) { return reclaimed_[position].handle.slot < slot; });
  return it != by_slot_.end() && reclaimed_[*it].handle == handle ? *it : kNone;
}

// Keeps the `count` of new_[first …] that are served first.
void Planner::keep_first(std::size_t first, std::size_t count, Policy policy, PlanReport& report) {
  if (new_.size() - first <= count) return;
  const auto begin = new_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto last = begin + static_cast<std::ptrdiff_t>(count);
  std::nth_element(begin, last, new_.end(), [policy](const Item& a, const Item& b) {
    return served_before(policy, a.order, b.order);
  });
  report.deferred += static_cast<std::uint32_t>(new_.end() - last);
  new_.erase(last, new_.end());
}

void Planner::leave_for_later(const PlanLimits& limits, Policy policy, PlanReport& report) {
  // Served by predicted time, not by rank.
  if (policy == Policy::kShortest || policy == Policy::kLongest) return;
  const auto hidden = std::partition(new_.begin(), new_.end(), [](const Item& item) {
    return is_visible(item.order.rank.group());
  });
  keep_first(static_cast<std::size_t>(hidden - new_.begin()), limits.max_new_hidden, policy,
             report);
  keep_first(0, limits.max_new, policy, report);
}

void Planner::note_arrived(const SynthesisManager& manager) {
  arrived_.clear();
  for (const Completion& c : manager.arrived())
    arrived_.push_back(c.handle.slot);
  std::ranges::sort(arrived_);
}

// Returns true if a modeler has claimed an urgent mesh and not finished it. Modelers get only the
// processor time that other threads leave, so it may take long; this thread then makes a duplicate.
bool Planner::is_blocked(const Want& want, MeshHandle handle, const GeometryCache& cache) const {
  return handle && is_urgent(want, cache) && cache.get(handle)->state == MeshState::kRequested &&
         reclaimed_position(handle) == kNone && !std::ranges::binary_search(arrived_, handle.slot);
}

// Fills items_ with the wants that need a request, in serving order, and marks reservations to
// keep.
void Planner::sort_out(std::span<const Want> wants, GeometryCache& cache, const CostModel& cost,
                       const PlanLimits& limits, Policy policy, PlanReport& report) {
  by_slot_.resize(reclaimed_.size());
  std::iota(by_slot_.begin(), by_slot_.end(), 0u);
  std::sort(by_slot_.begin(), by_slot_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return reclaimed_[a].handle.slot < reclaimed_[b].handle.slot;
  });
  kept_.assign(reclaimed_.size(), false);
  items_.clear();
  new_.clear();
  for (std::uint32_t i = 0; i < wants.size(); ++i) {
    const Want& want = wants[i];
    PSYGEN_ASSERT(want.parameters != nullptr, "a wanted mesh needs parameters");
    // First come, first served: earlier requests precede new ones.
    Item item{{want.rank, want.deadline_s, 0.0, reclaimed_.size() + i}, i, want.key, {}, {}, {}};
    MeshHandle handle = cache.find(item.key);
    if (is_blocked(want, handle, cache)) {
      ++report.in_flight;
      cache.adopt(handle, want.owner, want.rank);
      item.key = duplicate_of(item.key);
      handle = cache.find(item.key);
    }
    if (handle) {
      const MeshState state = cache.get(handle)->state;
      if (state == MeshState::kRequested) item.reclaimed = reclaimed_position(handle);
      if (item.reclaimed == kNone) {
        ++(state == MeshState::kReady    ? report.ready
           : state == MeshState::kFailed ? report.failed
                                         : report.in_flight);
        if (state == MeshState::kRequested) cache.adopt(handle, want.owner, want.rank);
        continue;
      }
      kept_[item.reclaimed] = true;
    }
    if (item.reclaimed == kNone) {
      new_.push_back(item);
      continue;
    }
    item.work = reclaimed_[item.reclaimed].work;
    item.cost = cost.predict_request(want.key.model, want.key.level, item.work);
    item.order.predicted_seconds = item.cost.warm_s();
    item.order.arrival = item.reclaimed;
    items_.push_back(item);
  }
  leave_for_later(limits, policy, report);
  for (Item& item : new_) {
    const Want& want = wants[item.want];
    item.work = cost.work(want.key.model, *want.parameters, want.key.level, &item.size);
    item.cost = cost.predict_request(want.key.model, want.key.level, item.work);
    item.order.predicted_seconds = item.cost.warm_s();
    items_.push_back(item);
  }
  std::sort(items_.begin(), items_.end(), [policy](const Item& a, const Item& b) {
    return served_before(policy, a.order, b.order);
  });
  last_first_.clear();
  for (const Item& item : items_) {
    if (item.reclaimed != kNone) last_first_.push_back(item.reclaimed);
  }
}

void Planner::give_back_unwanted(GeometryCache& cache, PlanReport& report) {
  for (std::size_t i = 0; i < reclaimed_.size(); ++i) {
    if (kept_[i]) continue;
    cache.cancel(reclaimed_[i].handle);
    ++report.cancelled;
  }
}

// Releases the reservation that is served last, to make memory for a better one.
bool Planner::give_back_last(GeometryCache& cache, PlanReport& report) {
  while (!last_first_.empty()) {
    const std::uint32_t position = last_first_.back();
    last_first_.pop_back();
    if (!kept_[position]) continue;  // already carried into the plan, or named by two wants
    kept_[position] = false;
    cache.cancel(reclaimed_[position].handle);
    ++report.cancelled;
    return true;
  }
  return false;
}

// Returns the edit layer that a request with these parameters must keep alive.
std::shared_ptr<const models::EditLayer> Planner::edits_for(
    const models::Parameters& parameters) const {
  if (parameters.edits() == nullptr) return nullptr;
  PSYGEN_CHECK(parameters.edits() == edits_.get(),
               "wanted meshes must use the edit layer set last");
  return edits_;
}

void Planner::add(const Item& item, const Want& want, GeometryCache& cache, PlanReport& report) {
  if (item.reclaimed != kNone && kept_[item.reclaimed]) {
    kept_[item.reclaimed] = false;  // the plan owns it now
    Request& request = reclaimed_[item.reclaimed];
    request.owner = want.owner;
    request.cost = item.cost;
    cache.adopt(request.handle, want.owner, want.rank);
    append(request, want, cache);
    ++report.carried;
    report.predicted_seconds += item.order.predicted_seconds;
    return;
  }
  if (cache.find(item.key)) return;  // a second want of this mesh
  auto handle = cache.reserve(item.key, *want.parameters, want.owner, want.rank, item.size);
  const bool hole = want.rank.group() == RankGroup::kVisibleHole;
  const auto gives_way = [&] {  // the memory of a reservation is free at once
    return handle.error().code == core::ErrorCode::kOverBudget ||
           (hole && handle.error().code == core::ErrorCode::kNotReady);
  };
  while (!handle && gives_way() && give_back_last(cache, report)) {
    handle = cache.reserve(item.key, *want.parameters, want.owner, want.rank, item.size);
  }
  if (!handle) {
    const core::ErrorCode code = handle.error().code;
    ++(code == core::ErrorCode::kSynthesisFailed ? report.failed
       : code == core::ErrorCode::kNotReady      ? report.waiting
                                                 : report.refused);
    const bool refused =
        code == core::ErrorCode::kOverBudget || code == core::ErrorCode::kOutOfMemory;
    if (refused && is_visible(want.rank.group())) ++report.refused_visible;
    if (code == core::ErrorCode::kNotReady) waiting_seconds_ += item.order.predicted_seconds;
    return;
  }
  const MeshRecord& record = *cache.get(*handle);
  append({*handle, item.key, *want.parameters, record.destination, record.size, item.work,
          item.cost, want.owner, edits_for(*want.parameters)},
         want, cache);
  ++report.reserved;
  report.predicted_seconds += item.order.predicted_seconds;
}

// Executes urgent requests until the time is used up; the others keep their places in the plan. A
// model predicted to exceed the remaining time is not started here, unless it is wanted at once.
// Only the prediction counts: first access to memory can take as long as a hundred models, and must
// not leave the next ones undone.
void Planner::execute_here(SynthesisManager& manager, double seconds, PlanReport& report) {
  double left_s = seconds;
  for (const Here& here : here_) {
    Request& request = plan_[here.at];
    const double predicted_s = request.cost.of(Warmth::kAfterSleep);
    if (predicted_s >= left_s && !here.at_once) continue;
    manager.execute_here(request);
    left_s -= predicted_s;
    request.handle = {};
    ++report.executed;
  }
  if (report.executed > 0)
    std::erase_if(plan_, [](const Request& request) { return !request.handle; });
}

PlanReport Planner::plan(std::span<const Want> wants, GeometryCache& cache, const CostModel& cost,
                         SynthesisManager& manager, const PlanLimits& limits, Policy policy) {
  PlanReport report;
  reclaimed_ = manager.reclaim();
  cache.begin_batch();
  here_up_to_.reset();
  if (limits.seconds_here > 0) here_up_to_ = limits.here_up_to;
  note_arrived(manager);
  sort_out(wants, cache, cost, limits, policy, report);
  give_back_unwanted(cache, report);

  plan_.clear();
  here_.clear();
  waiting_seconds_ = 0;
  const double enough = limits.seconds_ahead * std::max(manager.modeler_count(), 1u);
  // Remote modelers limit their own share of the plan.
  const unsigned remote = manager.remote_count();
  const double enough_remote = remote > 0 ? limits.seconds_ahead * remote : 0;
  double offered_seconds = 0;
  std::size_t next = 0;
  for (; next < items_.size(); ++next) {
    const double here_seconds = report.predicted_seconds - std::min(offered_seconds, enough_remote);
    if (here_seconds + waiting_seconds_ >= enough || plan_.size() >= limits.max_requests ||
        report.refused >= limits.max_refusals) {
      break;
    }
    const std::size_t before = plan_.size();
    add(items_[next], wants[items_[next].want], cache, report);
    if (enough_remote > 0 && plan_.size() > before && manager.is_offered_remotely(plan_.back()))
      offered_seconds += items_[next].order.predicted_seconds;
  }
  report.deferred += static_cast<std::uint32_t>(items_.size() - next);
  while (give_back_last(cache, report)) {
  }
  execute_here(manager, limits.seconds_here, report);
  report.published = static_cast<std::uint32_t>(plan_.size());
  manager.publish(std::exchange(plan_, {}));
  return report;
}

}  // namespace psygen::synthesis
