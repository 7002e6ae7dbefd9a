// The cache: owner of every mesh and of the one hard byte budget (paper, section 5.1: Cache). Space
// is reserved before synthesis, to the byte, so that resident meshes, reservations in flight and
// ranges that the GPU still reads never exceed the budget together. Under pressure it evicts the
// worst rank first, and refuses rather than let two meshes evict each other without end (rank.hpp).
//
// Main thread only; modelers see nothing but the destination of a reservation. Not a scheduler
// (planner.hpp) and not an allocator (core::GeometryMemory). Look-ups O(1); evicting costs one
// selection over all ready meshes per batch of requests, not a heap operation per mesh.
#pragma once

#include <any>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/core/geometry_memory.hpp"
#include "engine/models/registry.hpp"
#include "engine/synthesis/key_index.hpp"
#include "engine/synthesis/mesh_key.hpp"
#include "engine/synthesis/rank.hpp"
#include "engine/synthesis/unwanted_meshes.hpp"

namespace psygen::synthesis {

// All that the cache knows of one mesh.
struct MeshRecord {
  MeshKey key;
  models::MeshSize size;
  core::GeometryRange range;     // where to draw it from; index_count 0 where indices are shared
  models::MeshView destination;  // what the modeler writes; only while requested
  core::Bounds tight;            // of the vertices written; only when ready
  std::any note;                 // what its modeler noted of it; only when ready, not in the budget
  std::uint64_t owner = 0;       // the caller's name for the one that asked, e.g. an entity
  Rank rank;
  std::uint32_t generation = 0;
  MeshState state = MeshState::kEmpty;
  bool prefetched = false;     // became ready while invisible and has not been seen yet
  bool released = false;       // given up by its owner while a modeler writes it
  bool still_writing = false;  // failed, but a hung modeler holds the destination
};

// A mesh that was taken to make room.
struct Eviction {
  std::uint64_t owner = 0;
  MeshKey key;
  MeshHandle handle;  // stale by now
};

// Figures of the cache: of now, and counts since it was made.
struct CacheStats {
  std::uint64_t budget_bytes = 0;
  std::uint64_t capacity_bytes = 0;  // of the memory: below the budget where the system has no more
  std::uint64_t limit_bytes = 0;     // the budget, or less for a while after memory ran out
  std::uint64_t bytes = 0;           // used now, everything counted
  std::uint64_t visible_bytes = 0;   // of meshes whose rank is that of something visible
  std::uint64_t unwanted_bytes = 0;  // of ready meshes that are unwanted
  std::uint64_t peak_bytes = 0;
  std::uint64_t hits = 0, misses = 0;  // of look_up()
  std::uint64_t evictions = 0;
  std::uint64_t regenerations = 0;    // reservations of meshes evicted before (see EvictedKeys)
  std::uint64_t prefetched = 0;       // meshes that became ready before they were visible
  std::uint64_t prefetch_hits = 0;    // those of them that became visible afterwards
  std::uint64_t triangles = 0;        // of all meshes that became ready
  std::uint64_t triangles_drawn = 0;  // of those of them that were ever drawn
  std::uint64_t refusals = 0;         // reservations refused because of the budget
  std::uint64_t out_of_memory = 0;    // reservations that the memory itself refused
  std::uint64_t failures = 0;
  std::uint32_t ready = 0, requested = 0, failed = 0;  // meshes now
};

// Remembers which keys were evicted, in constant space: a direct-mapped table of 2^16 fingerprints.
// Forgets on collision, so that regenerations are under-counted rather than over-counted.
class EvictedKeys {
 public:
  EvictedKeys() : table_(kSize) {}
  void insert(std::uint64_t hash) { table_[hash % kSize] = hash | 1; }
  bool take(std::uint64_t hash) {
    std::uint64_t& entry = table_[hash % kSize];
    const bool found = entry == (hash | 1);
    if (found) entry = 0;
    return found;
  }

 private:
  static constexpr std::size_t kSize = 1u << 16;
  std::vector<std::uint64_t> table_;
};

// One cache in one memory.
class GeometryCache {
 public:
  static constexpr std::size_t kMaxFailures = 1u << 16;  // remembered; the oldest are forgotten
  static constexpr std::uint32_t kMaxVertices = 65536;   // 16-bit indices
  static constexpr std::uint32_t kMaxIndices = 1u << 26;

  // `memory` and `registry` outlive the cache.
  GeometryCache(core::GeometryMemory& memory, const models::Registry& registry,
                std::uint64_t budget_bytes);
  // Gives every range back; requires that no modeler runs, except hung ones whose range is kept.
  ~GeometryCache();
  GeometryCache(const GeometryCache&) = delete;
  GeometryCache& operator=(const GeometryCache&) = delete;

  // The mesh with this key, requested, ready or failed; kNoMesh if it is empty.
  MeshHandle find(const MeshKey& key) const;
  // find(), counted: a hit if it is ready, else a miss.
  MeshHandle look_up(const MeshKey& key);
  // Its record, or nullptr if the handle is stale. Valid until the next reserve().
  const MeshRecord* get(MeshHandle handle) const;
  // Why a failed mesh failed; empty if it did not.
  std::string_view failure_reason(MeshHandle handle) const;
  // All slots; those whose state is kEmpty are free. For statistics and debug views.
  std::span<const MeshRecord> records() const { return records_; }
  const models::Registry& registry() const { return registry_; }

  // Starts a batch of reservations (a tick): enforces the budget, forgets who waits for room, and
  // keeps a little room free for this batch and the next ones, as long as there is something that
  // unwanted: memory that is freed only when it is needed comes back some frames later.
  void begin_batch();

  // Room for the mesh `key`, exactly as large as its type says, evicting ready meshes that
  // may_evict() allows. Returns the mesh there is if it is requested or ready already. Errors:
  //   kOverBudget       no room: nothing worse to evict
  //   kNotYet           the GPU still reads what was evicted for it
  //   kOutOfMemory      the memory refused although the budget had room; the limit is lowered
  //   kSynthesisFailed  this key failed before (the reason is in the message), or its size cannot
  //                     be had; not retried while it is remembered (kMaxFailures)
  // `size`: what the type says, where the caller has asked already.
  core::Result<MeshHandle> reserve(const MeshKey& key, const models::Parameters& parameters,
                                   std::uint64_t owner, Rank rank,
                                   const std::optional<models::MeshSize>& size = {});

  // The destination is written: the mesh is ready (or gone, if it was released meanwhile). The note
  // stays as long as the mesh.
  void complete(MeshHandle handle, const core::Bounds& tight, std::any note = {});
  // Synthesis failed; the key is remembered with its reason. With `still_writing` the destination
  // is kept until settle(), because a hung modeler may write to it yet.
  void fail(MeshHandle handle, std::string reason, bool still_writing = false);
  void settle(MeshHandle handle);
  // Gives back a reservation that no modeler claimed.
  void cancel(MeshHandle handle);
  // The mesh is no longer needed: a ready one goes at once, a requested one as soon as its
  // modeler is done. Failed ones stay remembered.
  void release(MeshHandle handle);

  // Stale handles are ignored by all of these and by the four above.
  void set_rank(MeshHandle handle, Rank rank);
  // These meshes are drawn now. For the statistics: a mesh counts once.
  void note_drawn(std::span<const MeshHandle> handles);
  // Somebody (else) wants a mesh that is there: takes over its owner and rank, undoes a release.
  void adopt(MeshHandle handle, std::uint64_t owner, Rank rank);

  // What was evicted since the last call, in order. Valid until the next call.
  std::span<const Eviction> take_evictions();

  // A smaller budget evicts the worst at once, even what is visible; reservations in flight and
  // ranges that the GPU reads are waited for without blocking, over the next batches.
  void set_budget(std::uint64_t bytes);
  std::uint64_t budget_bytes() const { return budget_bytes_; }
  CacheStats stats() const;

 private:
  enum class Room : std::uint8_t { kNow, kLater, kNone };
  struct Candidate {
    std::uint64_t order;
    Slot slot;
  };
  MeshRecord* live(MeshHandle handle);
  core::Result<models::MeshSize> size_of(const MeshKey& key, const models::Parameters& parameters,
                                         const std::optional<models::MeshSize>& known);
  core::Result<core::GeometryReservation> reserve_memory(const models::MeshSize& size, Rank rank);
  Room make_room(std::uint64_t need, Rank rank);
  Room make_pieces(std::uint64_t need, Rank rank);
  bool evict(std::uint64_t bytes, const Rank* request);
  void select_candidates(std::size_t count);
  void evict_slot(Slot slot);
  void enforce_budget();
  void observe_memory();
  void give_back(MeshRecord& r);
  void give_back(const core::GeometryRange& range);
  void count_bytes(const MeshRecord& r, std::int64_t sign);
  void keep_room_free();
  bool evict_unwanted();
  Slot take_slot(const MeshKey& key, std::uint64_t owner, Rank rank);
  void free_slot(Slot slot);
  void remember_failure(Slot slot, std::string reason);

  core::GeometryMemory& memory_;
  const models::Registry& registry_;
  std::uint64_t budget_bytes_;
  std::uint64_t limit_bytes_;
  std::uint64_t last_used_bytes_ = 0;
  std::uint64_t returning_bytes_ = 0;  // released, but the memory still reports them as used
  std::uint64_t waiting_bytes_ = 0;    // promised in this batch to requests that must wait for them
  std::uint64_t promised_to_ = 0, promised_bytes_ = 0;  // the last promise: hash of the key, bytes
  Room pieces_ = Room::kNow;  // what make_pieces() found in this batch; kNow: not asked

  std::vector<MeshRecord> records_;
  std::vector<std::uint8_t> drawn_;       // per slot: 1 once it was drawn
  std::vector<std::uint64_t> evictable_;  // per slot: eviction_order() if ready, else 0
  std::vector<Slot> free_slots_;
  KeyIndex index_;
  UnwantedMeshes unwanted_;
  std::vector<Candidate> candidates_;  // the worst ready meshes, worst first
  std::size_t next_candidate_ = 0;
  bool candidates_valid_ = false, candidates_complete_ = false;
  std::unordered_map<Slot, std::string> reasons_;
  std::deque<MeshHandle> failure_order_;
  EvictedKeys evicted_keys_;
  std::vector<Eviction> evictions_, taken_evictions_;
  CacheStats stats_;
};

}  // namespace psygen::synthesis
