// The geometry cache: owner of every mesh and of the hard byte budget (paper, section 5.1: Cache).
// It reserves memory before synthesis, to the byte. Resident meshes, reservations in flight and
// ranges that the GPU still reads never exceed the budget together. Under pressure it evicts the
// worst rank first, and rejects requests rather than let two meshes evict each other without end
// (rank.hpp).
//
// Main thread only; modelers see only the destination of a reservation. Not a scheduler
// (planner.hpp) and not an allocator (core::GeometryMemory). Lookups are O(1). Eviction costs one
// selection over all ready meshes per batch of requests, not a heap operation per mesh.
#pragma once

#include <algorithm>
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
#include "engine/synthesis/mesh_key.hpp"
#include "engine/synthesis/rank.hpp"

namespace psygen::synthesis {

// Queue of unwanted ready meshes, in the order in which they became unwanted. Stores handles only:
// some meshes may be wanted again, or freed.
class UnwantedMeshes {
 public:
  // Adds a mesh. Only the last entry of a slot counts.
  void push(MeshHandle mesh) {
    if (mesh.slot >= turns_.size()) turns_.resize(std::size_t{mesh.slot} + 1);
    turns_[mesh.slot] = ++turn_;
    queue_.push_back({mesh, turn_});
    if (queue_.size() <= 2 * turns_.size()) return;
    std::erase_if(queue_, [this](const Entry& entry) { return !is_last(entry); });
  }

  // Removes and returns the mesh that has been unwanted for longest.
  std::optional<MeshHandle> pop() {
    while (!queue_.empty()) {
      const Entry first = queue_.front();
      queue_.pop_front();
      if (is_last(first)) return first.mesh;
    }
    return std::nullopt;
  }
  // Number of entries, at most two for each slot.
  std::size_t entries() const { return queue_.size(); }

 private:
  struct Entry {
    MeshHandle mesh;
    std::uint64_t turn;
  };
  bool is_last(const Entry& entry) const { return turns_[entry.mesh.slot] == entry.turn; }

  std::deque<Entry> queue_;
  std::vector<std::uint64_t> turns_;  // per slot: sequence number of its last entry
  std::uint64_t turn_ = 0;
};

// Everything that the cache stores about one mesh.
struct MeshRecord {
  MeshKey key;
  models::MeshSize size;
  core::GeometryRange range;     // draw range; index_count is 0 for shared indices
  models::MeshView destination;  // written by the modeler; only while requested
  core::Bounds tight;            // of the written vertices; only when ready
  std::any note;                 // value of its Annotate; only when ready, not in the budget
  std::uint64_t owner = 0;       // the caller's id of the requester, such as an entity
  Rank rank;
  std::uint32_t generation = 0;
  MeshState state = MeshState::kEmpty;
  bool prefetched = false;     // became ready while invisible and has not been visible yet
  bool released = false;       // released by its owner while a modeler writes it
  bool still_writing = false;  // failed, but a hung modeler may still write the destination
};

// A mesh that was evicted.
struct Eviction {
  std::uint64_t owner = 0;
  MeshKey key;
  MeshHandle handle;  // already stale
};

// Statistics of the cache: current values, and counts since its creation.
struct CacheStats {
  std::uint64_t budget_bytes = 0;
  std::uint64_t capacity_bytes = 0;  // of the memory: below the budget if the system has less
  std::uint64_t limit_bytes = 0;     // the budget, or temporarily less after memory ran out
  std::uint64_t bytes = 0;           // currently used, including reservations and returning ranges
  std::uint64_t visible_bytes = 0;   // of meshes with a visible rank
  std::uint64_t unwanted_bytes = 0;  // of ready meshes that are unwanted
  std::uint64_t peak_bytes = 0;
  std::uint64_t hits = 0, misses = 0;  // of look_up()
  std::uint64_t evictions = 0;
  std::uint64_t regenerations = 0;    // reservations of keys evicted before (see EvictedKeys)
  std::uint64_t prefetched = 0;       // meshes that became ready before they were visible
  std::uint64_t prefetch_hits = 0;    // prefetched meshes that became visible later
  std::uint64_t triangles = 0;        // of all meshes that became ready
  std::uint64_t triangles_drawn = 0;  // of those meshes that were ever drawn
  std::uint64_t refusals = 0;         // reservations rejected because of the budget
  std::uint64_t out_of_memory = 0;    // reservations that failed in the memory itself
  std::uint64_t failures = 0;
  std::uint32_t ready = 0, requested = 0, failed = 0;  // meshes now
};

// Remembers evicted keys in constant space: a direct-mapped table of 2^16 fingerprints. Forgets on
// collision, so regenerations are under-counted, never over-counted.
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

  // `memory` and `registry` outlive the cache.
  GeometryCache(core::GeometryMemory& memory, const models::Registry& registry,
                std::uint64_t budget_bytes);
  // Releases every range. Requires that no modeler runs, except hung ones, whose ranges stay
  // reserved.
  ~GeometryCache();
  GeometryCache(const GeometryCache&) = delete;
  GeometryCache& operator=(const GeometryCache&) = delete;

  // Handle of the mesh with this key if it is requested, ready or failed; else kNoMesh.
  MeshHandle find(const MeshKey& key) const;
  // Like find(), and counts a hit if the mesh is ready, else a miss.
  MeshHandle look_up(const MeshKey& key);
  // Record of the mesh, or nullptr if the handle is stale. Valid until the next reserve().
  const MeshRecord* get(MeshHandle handle) const;
  // Reason why a mesh failed; empty if it has not failed.
  std::string_view failure_reason(MeshHandle handle) const;
  // All slots; those in state kEmpty are free. For statistics and debug views.
  std::span<const MeshRecord> records() const { return records_; }
  const models::Registry& registry() const { return registry_; }

  // Starts a batch of reservations (a tick): enforces the budget, forgets requests that wait for
  // memory, and frees some memory ahead of need while there are unwanted meshes. Memory freed only
  // on demand returns some frames later.
  void begin_batch();

  // Reserves memory for the mesh `key`, exactly as large as its type says, and evicts ready meshes
  // that may_evict() allows. Returns the existing mesh if it is requested or ready. `size`: the
  // size by the type, if the caller knows it. Errors:
  // - kOverBudget: no memory, and nothing worse to evict;
  // - kNotReady: the GPU still reads the meshes evicted for this one;
  // - kOutOfMemory: the allocation failed within the budget, which lowers the limit; or the
  //   type had no memory to tell the size;
  // - kSynthesisFailed: this key failed before (the message has the reason), or its size is
  //   unknown; not retried while it is remembered (kMaxFailures).
  core::Result<MeshHandle> reserve(const MeshKey& key, const models::Parameters& parameters,
                                   std::uint64_t owner, Rank rank,
                                   const std::optional<models::MeshSize>& size = {});

  // The modeler has written the destination: the mesh becomes ready, or is freed if it was
  // released. The note lives as long as the mesh.
  void complete(MeshHandle handle, const core::Bounds& tight, std::any note = {});
  // Synthesis failed; the key is remembered with its reason. With `still_writing`, the destination
  // stays reserved until settle(), because a hung modeler may still write to it.
  void fail(MeshHandle handle, std::string reason, bool still_writing = false);
  void settle(MeshHandle handle);
  // Releases a reservation that no modeler has claimed.
  void cancel(MeshHandle handle);
  // The mesh is no longer needed. A ready one is freed at once, a requested one after its modeler
  // finishes. Failed ones stay remembered.
  void release(MeshHandle handle);

  // These functions and the four above ignore stale handles.
  void set_rank(MeshHandle handle, Rank rank);
  // Records that these meshes are drawn. Statistics count each mesh once.
  void note_drawn(std::span<const MeshHandle> handles);
  // Another owner wants an existing mesh: replaces its owner and rank, and cancels a release.
  void adopt(MeshHandle handle, std::uint64_t owner, Rank rank);

  // Evictions since the last call, in order. Valid until the next call.
  std::span<const Eviction> take_evictions();

  // A smaller budget evicts the worst meshes at once, even visible ones. Reservations in flight and
  // ranges that the GPU reads are freed over the next batches, without blocking.
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
  void keep_headroom();
  bool evict_unwanted();
  Slot take_slot(const MeshKey& key, std::uint64_t owner, Rank rank);
  void free_slot(Slot slot);
  void remember_failure(Slot slot, std::string reason);

  core::GeometryMemory& memory_;
  const models::Registry& registry_;
  std::uint64_t budget_bytes_;
  std::uint64_t limit_bytes_;
  std::uint64_t last_used_bytes_ = 0;
  std::uint64_t returning_bytes_ = 0;  // released, but still reported as used by the memory
  std::uint64_t waiting_bytes_ = 0;    // promised in this batch to requests that wait for them
  std::uint64_t promised_to_ = 0, promised_bytes_ = 0;  // the last promise: hash of the key, bytes
  Room pieces_ = Room::kNow;  // result of make_pieces() in this batch; kNow: not called

  std::vector<MeshRecord> records_;
  std::vector<std::uint8_t> drawn_;       // per slot: 1 once it was drawn
  std::vector<std::uint64_t> evictable_;  // per slot: eviction_order() if ready, else 0
  std::vector<Slot> free_slots_;
  std::unordered_map<MeshKey, Slot> index_;
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
