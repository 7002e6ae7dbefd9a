// The importance of a mesh as one integer; smaller is more important. Ordered by group, then by an
// integer of the group (PLP layer, or deadline), then by distance. The cache evicts the largest
// rank first; the planner requests the smallest first.
//
// Two rules make eviction safe. A visible mesh is evicted only when no invisible one is left,
// because the visible groups come first. A request evicts only meshes that may_evict() allows:
// strictly worse ones, or meshes drawn finer than necessary, which can return smaller. So mutual
// eviction ends, and unnecessary detail never holds memory.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>

namespace psygen::synthesis {

// Purpose of a mesh or a request, most important first.
enum class RankGroup : std::uint8_t {
  kVisibleHole = 0,  // in view, not drawn at any level
  // In view, drawn finer than wanted; a request of this group replaces it with a smaller mesh.
  kVisibleFine = 1,    //
  kVisibleCoarse = 2,  // in view and drawn, but not by the wanted mesh
  kDrawn = 3,          // in view and drawn; a request of this group makes the mesh again
  kPredicted = 4,      // in view soon, by deadline
  kPrefetch = 5,       // around the camera, by PLP layer
  kUnwanted = 6,       // not requested; kept while memory is free
};
// Returns true if the group is in view.
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

  // In view or prefetched: by PLP layer, then distance. A layer in view is limited to 16 bits.
  static Rank by_layer(RankGroup group, std::uint32_t layer, float distance_m) {
    return {group, is_visible(group) ? std::min(layer, kMaxLayer) : layer, distance_m};
  }
  // In view and not drawn: by `turn` (smaller is more urgent, up to 255), then as by_layer().
  static Rank hole(std::uint32_t turn, std::uint32_t layer, float distance_m) {
    return {RankGroup::kVisibleHole,
            (std::min(turn, 255u) << kLayerBits) | std::min(layer, kMaxLayer), distance_m};
  }
  // In view in `deadline_s` seconds (0 … about 4 hours, stored in milliseconds).
  static Rank by_deadline(float deadline_s, float distance_m) {
    const double ms = std::isnan(deadline_s) ? double{kMaxMajor} : double{deadline_s} * 1000.0;
    return {RankGroup::kPredicted,
            static_cast<std::uint32_t>(std::clamp(ms, 0.0, double{kMaxMajor})), distance_m};
  }
  static constexpr Rank unwanted() { return Rank(); }
  // The rank with the given bits().
  static constexpr Rank from_bits(std::uint64_t bits) {
    Rank rank;
    rank.bits_ = bits;
    return rank;
  }

  // The group, and the whole rank as an integer of the same order.
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

// Key by which ready meshes are evicted, largest first. Unwanted meshes are equal. All visible
// groups form one, in which meshes that are too fine go first; then layer and distance count.
constexpr std::uint64_t eviction_order(Rank rank) {
  if (rank.group() == RankGroup::kUnwanted) return Rank::unwanted().bits();
  if (!is_visible(rank.group())) return rank.bits();
  constexpr std::uint64_t kKeyMask = (std::uint64_t{1} << (32 + Rank::kLayerBits)) - 1;
  const std::uint64_t fine = rank.group() == RankGroup::kVisibleFine ? 1 : 0;
  return (std::uint64_t{static_cast<std::uint8_t>(RankGroup::kDrawn)} << 56) | (fine << 55) |
         (rank.bits() & kKeyMask);
}

// Returns true if a request of rank `request` may evict a ready mesh of rank `victim`. An invisible
// victim must be strictly worse. A victim that is too fine yields to a hole, or to the replacement
// of a mesh that is too fine. Another visible victim yields only to a hole that is strictly nearer
// by layer and distance. Refining a drawn mesh never evicts a visible one.
constexpr bool may_evict(Rank request, Rank victim) {
  if (!is_visible(victim.group())) return victim > request;
  const bool hole = request.group() == RankGroup::kVisibleHole;
  if (victim.group() == RankGroup::kVisibleFine)
    return hole || request.group() == RankGroup::kVisibleFine;
  return hole && eviction_order(victim) > eviction_order(request);
}

}  // namespace psygen::synthesis
