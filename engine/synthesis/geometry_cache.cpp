#include "engine/synthesis/geometry_cache.hpp"

#include <fmt/format.h>

#include <utility>

#include "engine/synthesis/synthesise.hpp"

namespace psygen::synthesis {

GeometryCache::GeometryCache(core::GeometryMemory& memory, const models::Registry& registry,
                             std::uint64_t budget_bytes)
    : memory_(memory),
      registry_(registry),
      budget_bytes_(budget_bytes),
      limit_bytes_(budget_bytes),
      last_used_bytes_(memory.used_bytes()) {}

GeometryCache::~GeometryCache() {
  for (const MeshRecord& r : records_) {
    if (r.range.id != core::kNoGeometry && !r.still_writing) memory_.release(r.range);
  }
}

MeshHandle GeometryCache::find(const MeshKey& key) const {
  const auto found = index_.find(key);
  if (found == index_.end()) return kNoMesh;
  return {found->second, records_[found->second].generation};
}

MeshHandle GeometryCache::look_up(const MeshKey& key) {
  const MeshHandle handle = find(key);
  ++(handle && records_[handle.slot].state == MeshState::kReady ? stats_.hits : stats_.misses);
  return handle;
}

const MeshRecord* GeometryCache::get(MeshHandle handle) const {
  if (handle.slot >= records_.size()) return nullptr;
  const MeshRecord& r = records_[handle.slot];
  return r.generation == handle.generation && r.state != MeshState::kEmpty ? &r : nullptr;
}

MeshRecord* GeometryCache::live(MeshHandle handle) {
  return const_cast<MeshRecord*>(std::as_const(*this).get(handle));
}

std::string_view GeometryCache::failure_reason(MeshHandle handle) const {
  const MeshRecord* r = get(handle);
  if (r == nullptr || r->state != MeshState::kFailed) return {};
  return reasons_.at(handle.slot);
}

core::Result<models::MeshSize> GeometryCache::size_of(
    const MeshKey& key, const models::Parameters& parameters,
    const std::optional<models::MeshSize>& known) {
  using core::ErrorCode;
  if (key.model >= registry_.size()) {
    return core::fail(ErrorCode::kSynthesisFailed, fmt::format("no model type {}", key.model));
  }
  const models::ModelType& type = registry_[key.model];
  if (key.level >= type.level_count()) {
    return core::fail(ErrorCode::kSynthesisFailed,
                      fmt::format("{} has no level {}, the coarsest is {}", type.name(), key.level,
                                  type.level_count() - 1));
  }
  return mesh_size_guarded(type, parameters, key.level, known);
}

core::Result<MeshHandle> GeometryCache::reserve(const MeshKey& key,
                                                const models::Parameters& parameters,
                                                std::uint64_t owner, Rank rank,
                                                const std::optional<models::MeshSize>& known) {
  if (const MeshHandle there = find(key)) {
    if (records_[there.slot].state != MeshState::kFailed) return there;
    return core::fail(core::ErrorCode::kSynthesisFailed, reasons_.at(there.slot));
  }
  const core::Result<models::MeshSize> size = size_of(key, parameters, known);
  if (!size) {
    if (size.error().code == core::ErrorCode::kOutOfMemory)  // it may succeed later
      return tl::unexpected<core::Error>(size.error());
    remember_failure(take_slot(key, owner, rank), size.error().message);
    return core::fail(core::ErrorCode::kSynthesisFailed, size.error().message);
  }
  const std::uint64_t hash = hash_of(key);
  // A repeated request.
  if (hash == promised_to_) waiting_bytes_ -= std::exchange(promised_bytes_, 0);
  const std::uint64_t waiting = waiting_bytes_;
  const core::Result<core::GeometryReservation> place = reserve_memory(*size, rank);
  if (waiting_bytes_ > waiting) {
    promised_to_ = hash;
    promised_bytes_ = waiting_bytes_ - waiting;
  }
  if (!place) return tl::unexpected<core::Error>(place.error());

  const Slot slot = take_slot(key, owner, rank);
  MeshRecord& r = records_[slot];
  r.state = MeshState::kRequested;
  r.size = *size;
  r.range = place->range;
  r.destination = {place->vertices, place->indices};
  count_bytes(r, 1);
  ++stats_.requested;
  if (evicted_keys_.take(hash)) ++stats_.regenerations;
  return MeshHandle{slot, r.generation};
}

void GeometryCache::complete(MeshHandle handle, const core::Bounds& tight, std::any note) {
  MeshRecord* r = live(handle);
  if (r == nullptr || r->state != MeshState::kRequested) return;
  --stats_.requested;
  if (r->released) {
    give_back(*r);
    free_slot(handle.slot);
    return;
  }
  memory_.commit(r->range);
  count_bytes(*r, -1);
  r->state = MeshState::kReady;
  count_bytes(*r, 1);
  r->destination = {};
  r->tight = tight;
  r->note = std::move(note);
  r->prefetched = !is_visible(r->rank.group());
  if (r->prefetched) ++stats_.prefetched;
  ++stats_.ready;
  stats_.triangles += r->size.triangle_count();
  drawn_.resize(records_.size());
  drawn_[handle.slot] = 0;
  evictable_[handle.slot] = eviction_order(r->rank);
  candidates_valid_ = false;
  if (r->rank.group() == RankGroup::kUnwanted) unwanted_.push(handle);
  enforce_budget();
}

void GeometryCache::note_drawn(std::span<const MeshHandle> handles) {
  for (const MeshHandle handle : handles) {
    if (handle.slot >= drawn_.size() || drawn_[handle.slot] != 0) continue;
    const MeshRecord* r = get(handle);
    if (r == nullptr || r->state != MeshState::kReady) continue;
    drawn_[handle.slot] = 1;
    stats_.triangles_drawn += r->size.triangle_count();
  }
}

void GeometryCache::fail(MeshHandle handle, std::string reason, bool still_writing) {
  MeshRecord* r = live(handle);
  if (r == nullptr || r->state != MeshState::kRequested) return;
  --stats_.requested;
  r->destination = {};
  r->still_writing = still_writing;
  if (!still_writing) give_back(*r);
  remember_failure(handle.slot, std::move(reason));
}

void GeometryCache::settle(MeshHandle handle) {
  MeshRecord* r = live(handle);
  if (r == nullptr || !r->still_writing) return;
  r->still_writing = false;
  give_back(*r);
}

void GeometryCache::cancel(MeshHandle handle) {
  MeshRecord* r = live(handle);
  if (r == nullptr || r->state != MeshState::kRequested) return;
  --stats_.requested;
  give_back(*r);
  free_slot(handle.slot);
}

void GeometryCache::release(MeshHandle handle) {
  MeshRecord* r = live(handle);
  if (r == nullptr) return;
  if (r->state == MeshState::kRequested) {
    r->released = true;
  } else if (r->state == MeshState::kReady) {
    --stats_.ready;
    give_back(*r);
    free_slot(handle.slot);
  }
}

void GeometryCache::set_rank(MeshHandle handle, Rank rank) {
  MeshRecord* r = live(handle);
  if (r == nullptr) return;
  const bool was_unwanted = r->rank.group() == RankGroup::kUnwanted;
  count_bytes(*r, -1);
  r->rank = rank;
  count_bytes(*r, 1);
  if (r->state != MeshState::kReady) return;
  if (r->prefetched && is_visible(rank.group())) {
    r->prefetched = false;
    ++stats_.prefetch_hits;
  }
  if (rank.group() == RankGroup::kUnwanted && !was_unwanted) unwanted_.push(handle);
  const std::uint64_t order = eviction_order(rank);
  if (evictable_[handle.slot] != order) {
    evictable_[handle.slot] = order;
    candidates_valid_ = false;
  }
}

void GeometryCache::adopt(MeshHandle handle, std::uint64_t owner, Rank rank) {
  MeshRecord* r = live(handle);
  if (r == nullptr) return;
  r->owner = owner;
  r->released = false;
  set_rank(handle, rank);
}

void GeometryCache::remember_failure(Slot slot, std::string reason) {
  MeshRecord& r = records_[slot];
  r.state = MeshState::kFailed;
  reasons_[slot] = std::move(reason);
  failure_order_.push_back({slot, r.generation});
  ++stats_.failures;
  ++stats_.failed;
  if (failure_order_.size() <= kMaxFailures) return;
  const MeshHandle oldest = failure_order_.front();
  failure_order_.pop_front();
  if (records_[oldest.slot].still_writing) {
    failure_order_.push_back(oldest);
  } else {
    --stats_.failed;
    free_slot(oldest.slot);
  }
}

Slot GeometryCache::take_slot(const MeshKey& key, std::uint64_t owner, Rank rank) {
  Slot slot = static_cast<Slot>(records_.size());
  if (free_slots_.empty()) {
    records_.emplace_back();
    evictable_.push_back(0);
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  MeshRecord& r = records_[slot];
  r.key = key;
  r.owner = owner;
  r.rank = rank;
  index_.emplace(key, slot);
  return slot;
}

void GeometryCache::free_slot(Slot slot) {
  MeshRecord& r = records_[slot];
  index_.erase(r.key);
  if (r.state == MeshState::kFailed) reasons_.erase(slot);
  const std::uint32_t generation = r.generation;
  r = {};
  r.generation = generation + 1;
  if (evictable_[slot] != 0) candidates_valid_ = false;
  evictable_[slot] = 0;
  if (r.generation != UINT32_MAX) free_slots_.push_back(slot);  // an exhausted slot is never reused
}

std::span<const Eviction> GeometryCache::take_evictions() {
  taken_evictions_.clear();
  std::swap(taken_evictions_, evictions_);
  return taken_evictions_;
}

CacheStats GeometryCache::stats() const {
  CacheStats s = stats_;
  s.budget_bytes = budget_bytes_;
  s.capacity_bytes = memory_.capacity_bytes();
  s.limit_bytes = limit_bytes_;
  s.bytes = memory_.used_bytes();
  return s;
}

}  // namespace psygen::synthesis
