// The part of GeometryCache that enforces the budget: accounts for used and returning bytes and
// selects meshes to evict. Unwanted meshes are evicted ahead of need, oldest first. The eviction
// order of all others is selected once per batch and then walked.
#include <algorithm>
#include <utility>

#include "engine/synthesis/geometry_cache.hpp"

namespace psygen::synthesis {
namespace {
constexpr std::size_t kCandidateBatch = 256;
// Fractions 1/n of the limit. If less than kMinFreePart is free, kFreePart is freed; if the
// memory has only pieces that are too small, kPiecesPart.
constexpr std::uint64_t kMinFreePart = 64, kFreePart = 24, kPiecesPart = 8;
}  // namespace

void GeometryCache::begin_batch() {
  waiting_bytes_ = promised_bytes_ = 0;
  pieces_ = Room::kNow;
  limit_bytes_ =
      std::min({budget_bytes_, memory_.capacity_bytes(), limit_bytes_ + budget_bytes_ / 64 + 1});
  enforce_budget();
  keep_headroom();
}

void GeometryCache::keep_headroom() {
  observe_memory();
  const auto lacks = [this](std::uint64_t free_bytes) {
    return last_used_bytes_ + free_bytes > limit_bytes_ + returning_bytes_;
  };
  if (!lacks(limit_bytes_ / kMinFreePart)) return;
  while (lacks(limit_bytes_ / kFreePart) && evict_unwanted()) {
  }
}

// Evicts the mesh that has been unwanted for longest. Returns false if there is none.
bool GeometryCache::evict_unwanted() {
  while (const std::optional<MeshHandle> mesh = unwanted_.pop()) {
    const MeshRecord* r = get(*mesh);
    if (r == nullptr || r->state != MeshState::kReady || r->rank.group() != RankGroup::kUnwanted)
      continue;
    candidates_valid_ = false;
    evict_slot(mesh->slot);
    return true;
  }
  return false;
}

// Handles fragmentation: the budget suffices, but no free piece of memory is large enough. Frees an
// eighth once per batch, including bytes that return already: meshes allocated together are then
// freed together.
GeometryCache::Room GeometryCache::make_pieces(std::uint64_t need, Rank rank) {
  ++stats_.out_of_memory;
  if (pieces_ != Room::kNow) return pieces_;
  limit_bytes_ = std::min(limit_bytes_, std::max(last_used_bytes_, budget_bytes_ / 16));
  const std::uint64_t goal =
      limit_bytes_ / kPiecesPart - std::min(limit_bytes_ / kPiecesPart, returning_bytes_);
  const std::uint64_t least = stats_.unwanted_bytes - std::min(stats_.unwanted_bytes, goal);
  while (stats_.unwanted_bytes > least && evict_unwanted()) {
  }
  const Room room = make_room(need, rank);
  pieces_ = returning_bytes_ > 0 ? Room::kLater : Room::kNone;
  return room == Room::kNone ? pieces_ : room;
}

void GeometryCache::set_budget(std::uint64_t bytes) {
  budget_bytes_ = bytes;
  limit_bytes_ = bytes;
  enforce_budget();
}

// A range that a frame in flight still reads stays in used_bytes() after its release. Those bytes
// return without further eviction, so they are counted separately.
void GeometryCache::observe_memory() {
  const std::uint64_t used = memory_.used_bytes();
  if (used < last_used_bytes_) {
    returning_bytes_ -= std::min(returning_bytes_, last_used_bytes_ - used);
  }
  last_used_bytes_ = used;
  stats_.peak_bytes = std::max(stats_.peak_bytes, used);
}

void GeometryCache::count_bytes(const MeshRecord& r, std::int64_t sign) {
  const auto bytes = static_cast<std::uint64_t>(sign * std::int64_t{r.range.bytes});
  if (is_visible(r.rank.group())) stats_.visible_bytes += bytes;
  if (r.rank.group() == RankGroup::kUnwanted && r.state == MeshState::kReady)
    stats_.unwanted_bytes += bytes;
}

void GeometryCache::give_back(MeshRecord& r) {
  count_bytes(r, -1);
  give_back(std::exchange(r.range, {}));
}

void GeometryCache::give_back(const core::GeometryRange& range) {
  observe_memory();
  memory_.release(range);
  returning_bytes_ += range.bytes;
  observe_memory();
}

core::Result<core::GeometryReservation> GeometryCache::reserve_memory(const models::MeshSize& size,
                                                                      Rank rank) {
  const std::uint32_t own_indices = size.own_index_count();
  const std::uint64_t need = memory_.charged_bytes(size.layout, size.vertex_count, own_indices);
  const auto refuse = [this](Room room) {
    stats_.refusals += room == Room::kNone ? 1 : 0;
    return room == Room::kLater
               ? core::fail(core::ErrorCode::kNotReady, "the memory for a mesh is not free yet")
               : core::fail(core::ErrorCode::kOverBudget,
                            "the geometry budget has no room for a mesh");
  };
  if (const Room room = make_room(need, rank); room != Room::kNow) return refuse(room);
  auto place = memory_.reserve(size.layout, size.vertex_count, own_indices);
  if (!place) {
    const Room room = make_pieces(need, rank);
    if (room == Room::kLater) return refuse(room);
    if (room == Room::kNone) return place;
    place = memory_.reserve(size.layout, size.vertex_count, own_indices);
    if (!place && pieces_ == Room::kLater) return refuse(pieces_);
    if (!place) return place;
  }
  if (memory_.used_bytes() > budget_bytes_) {  // the memory charged more than it had announced
    give_back(place->range);
    return refuse(Room::kNone);
  }
  observe_memory();
  return place;
}

// Returns whether `need` bytes can be reserved now. Evicts only if that frees enough, either now or
// after the GPU has finished reading; in that case the bytes are promised to this request.
GeometryCache::Room GeometryCache::make_room(std::uint64_t need, Rank rank) {
  observe_memory();
  if (need > limit_bytes_) return Room::kNone;
  const auto wanted = [&] { return last_used_bytes_ + waiting_bytes_ + need; };
  if (wanted() <= limit_bytes_) return Room::kNow;
  const std::uint64_t coming = limit_bytes_ + returning_bytes_;
  if (wanted() > coming && !evict(wanted() - coming, &rank)) return Room::kNone;
  if (wanted() <= limit_bytes_) return Room::kNow;
  waiting_bytes_ += need;
  return Room::kLater;
}

void GeometryCache::enforce_budget() {
  observe_memory();
  const std::uint64_t allowed = budget_bytes_ + returning_bytes_;
  if (last_used_bytes_ > allowed) evict(last_used_bytes_ - allowed, nullptr);
}

// Evicts the worst meshes until `bytes` are returning. For a request: all or nothing, and only
// meshes that it may evict. Without a request (a smaller budget): any mesh.
bool GeometryCache::evict(std::uint64_t bytes, const Rank* request) {
  for (std::size_t count = kCandidateBatch;; count *= 4) {
    if (!candidates_valid_) select_candidates(count);
    std::uint64_t found = 0;
    std::size_t end = next_candidate_;
    while (end < candidates_.size() && found < bytes) {
      const MeshRecord& r = records_[candidates_[end].slot];
      if (request != nullptr && !may_evict(*request, r.rank)) return false;
      found += r.range.bytes;
      ++end;
    }
    const bool enough = found >= bytes;
    if (enough || (request == nullptr && candidates_complete_)) {
      while (next_candidate_ < end)
        evict_slot(candidates_[next_candidate_++].slot);
      return enough;
    }
    if (candidates_complete_) return false;
    candidates_valid_ = false;
  }
}

void GeometryCache::select_candidates(std::size_t count) {
  candidates_.clear();
  next_candidate_ = 0;
  for (Slot s = 0; s < evictable_.size(); ++s) {
    if (evictable_[s] != 0) candidates_.push_back({evictable_[s], s});
  }
  const auto worse = [](const Candidate& a, const Candidate& b) {
    return a.order != b.order ? a.order > b.order : a.slot < b.slot;
  };
  candidates_complete_ = candidates_.size() <= count;
  if (!candidates_complete_) {
    const auto middle = candidates_.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(candidates_.begin(), middle, candidates_.end(), worse);
    candidates_.resize(count);
  }
  std::sort(candidates_.begin(), candidates_.end(), worse);
  candidates_valid_ = true;
}

void GeometryCache::evict_slot(Slot slot) {
  MeshRecord& r = records_[slot];
  evictions_.push_back({r.owner, r.key, {slot, r.generation}});
  evicted_keys_.insert(hash_of(r.key));
  ++stats_.evictions;
  --stats_.ready;
  give_back(r);
  evictable_[slot] = 0;  // already removed from the candidates, which stay valid
  free_slot(slot);
}

}  // namespace psygen::synthesis
