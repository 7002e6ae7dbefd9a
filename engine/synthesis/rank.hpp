// How important a mesh is now, as one integer that sorts: smaller is more important. Ordered by
// group, then by an integer of the group (PLP layer, or deadline), then by distance. The cache
// evicts the largest rank first; the planner requests the smallest first.
//
// Two laws make eviction safe. What is visible is taken only when nothing invisible is left,
// because the visible groups come first. And a request takes only what may_evict() allows: what is
// strictly worse, or what is drawn finer than it need be and can come back smaller. So evictions in
// turn end, and unwanted detail never holds memory.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>

namespace psygen::synthesis {

// What a mesh or a request is for, most important first.
enum class RankGroup : std::uint8_t {
  kVisibleHole = 0,    // in view, drawn at no level
  kVisibleFine = 1,    // in view, drawn finer than wanted; of a request: what frees that room
  kVisibleCoarse = 2,  // in view, drawn, but not by the mesh that is wanted
  kDrawn = 3,          // in view and drawn now; of a request: the same anew
  kPredicted = 4,      // will be in view, by deadline
  kPrefetch = 5,       // around the camera, by PLP layer
  kUnwanted = 6,       // not asked for; kept while there is room
};
// Whether it is of something in view.
constexpr bool is_visible(RankGroup group) {
  return group <= RankGroup::kDrawn;
}

// Default: unwanted().
class Rank {
 public:
  static constexpr std::uint32_t kMaxMajor = (1u << 24) - 1;
  static constexpr std::uint32_t kLayerBits = 16, kMaxLayer = (1u << kLayerBits) - 1;

  constexpr Rank() = default;
  // `major` is clamped to 24 bits; `distance_m` >= 0 keeps about 1.5 % of precision, so that small
  // movements of the camera do not reorder everything. NaN counts as infinitely far.
  Rank(RankGroup group, std::uint32_t major, float distance_m)
      : bits_((std::uint64_t{static_cast<std::uint8_t>(group)} << 56) |
              (std::uint64_t{std::min(major, kMaxMajor)} << 32) | ordered(distance_m)) {}

  // In view or prefetched: by PLP layer, then distance. What is in view has at most 16 bits of
  // layer.
  static Rank by_layer(RankGroup group, std::uint32_t layer, float distance_m) {
    return {group, is_visible(group) ? std::min(layer, kMaxLayer) : layer, distance_m};
  }
  // In view and drawn at no level: by `turn` (small is urgent, up to 255), then as by_layer().
  static Rank hole(std::uint32_t turn, std::uint32_t layer, float distance_m) {
    return {RankGroup::kVisibleHole,
            (std::min(turn, 255u) << kLayerBits) | std::min(layer, kMaxLayer), distance_m};
  }
  // Predicted visible in `deadline_s` seconds (0 … about 4 hours, kept in milliseconds).
  static Rank by_deadline(float deadline_s, float distance_m) {
    const double ms = std::isnan(deadline_s) ? double{kMaxMajor} : double{deadline_s} * 1000.0;
    return {RankGroup::kPredicted,
            static_cast<std::uint32_t>(std::clamp(ms, 0.0, double{kMaxMajor})), distance_m};
  }
  static constexpr Rank unwanted() { return Rank(); }
  // The rank of bits() that were written down.
  static constexpr Rank from_bits(std::uint64_t bits) {
    Rank rank;
    rank.bits_ = bits;
    return rank;
  }

  // The group, and all of it as an integer that sorts alike.
  constexpr RankGroup group() const { return static_cast<RankGroup>(bits_ >> 56); }
  constexpr std::uint64_t bits() const { return bits_; }
  friend constexpr auto operator<=>(Rank, Rank) = default;

 private:
  static std::uint32_t ordered(float distance_m) {
    if (std::isnan(distance_m)) return UINT32_MAX;
    return std::bit_cast<std::uint32_t>(std::max(distance_m, 0.0F) + 0.0F) & 0xFFFE0000u;
  }
  std::uint64_t bits_ = std::uint64_t{static_cast<std::uint8_t>(RankGroup::kUnwanted)} << 56;
};
static_assert(sizeof(Rank) == 8);

// Where a ready mesh stands in the order of eviction, larger goes first: unwanted meshes are all
// alike, and all visible groups are one, of which those that are too fine go first; then layer and
// distance count.
constexpr std::uint64_t eviction_order(Rank rank) {
  if (rank.group() == RankGroup::kUnwanted) return Rank::unwanted().bits();
  if (!is_visible(rank.group())) return rank.bits();
  constexpr std::uint64_t kKeyMask = (std::uint64_t{1} << (32 + Rank::kLayerBits)) - 1;
  const std::uint64_t fine = rank.group() == RankGroup::kVisibleFine ? 1 : 0;
  return (std::uint64_t{static_cast<std::uint8_t>(RankGroup::kDrawn)} << 56) | (fine << 55) |
         (rank.bits() & kKeyMask);
}

// Whether a request of rank `request` may take the place of a ready mesh of rank `victim`. An
// invisible one only if strictly worse. One that is too fine only for a hole, or for what replaces
// one that is too fine. Another visible one only for a hole that is strictly nearer by layer and
// distance. Refining what is drawn never costs anything that is visible.
constexpr bool may_evict(Rank request, Rank victim) {
  if (!is_visible(victim.group())) return victim > request;
  const bool hole = request.group() == RankGroup::kVisibleHole;
  if (victim.group() == RankGroup::kVisibleFine)
    return hole || request.group() == RankGroup::kVisibleFine;
  return hole && eviction_order(victim) > eviction_order(request);
}

}  // namespace psygen::synthesis
