// How important a mesh is now, as one integer that sorts: smaller is more important. Ordered by
// group, then by an integer of the group (PLP layer, or deadline), then by distance. The cache
// evicts the largest rank first; the planner requests the smallest first.
//
// Two laws make eviction safe. What is visible is taken only when nothing invisible is left,
// because the visible groups come first. And a request takes only what may_evict() allows, which is
// a strict order: two meshes can never evict each other in turn.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>

namespace psygen::synthesis {

enum class RankGroup : std::uint8_t {
  kVisibleHole = 0,    // in view, drawn at no level
  kVisibleCoarse = 1,  // in view, drawn, but coarser than wanted
  kDrawn = 2,          // in view and drawn now
  kPredicted = 3,      // will be in view, by deadline
  kPrefetch = 4,       // around the camera, by PLP layer
  kUnwanted = 5,       // nobody asks for it; kept while there is room
};
constexpr bool is_visible(RankGroup group) {
  return group <= RankGroup::kDrawn;
}

class Rank {
 public:
  static constexpr std::uint32_t kMaxMajor = (1u << 24) - 1;

  constexpr Rank() = default;
  // `major` is clamped to 24 bits; `distance_m` >= 0 keeps about 1.5 % of precision, so that small
  // movements of the camera do not reorder everything. NaN counts as infinitely far.
  Rank(RankGroup group, std::uint32_t major, float distance_m)
      : bits_((std::uint64_t{static_cast<std::uint8_t>(group)} << 56) |
              (std::uint64_t{std::min(major, kMaxMajor)} << 32) | ordered(distance_m)) {}

  // In view or prefetched: by PLP layer, then distance.
  static Rank by_layer(RankGroup group, std::uint32_t layer, float distance_m) {
    return {group, layer, distance_m};
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

// Where a ready mesh stands in the order of eviction, larger goes first: all visible groups are
// one, in which only layer and distance count.
constexpr std::uint64_t eviction_order(Rank rank) {
  constexpr std::uint64_t kKeyMask = (std::uint64_t{1} << 56) - 1;
  constexpr std::uint64_t kDrawn = std::uint64_t{static_cast<std::uint8_t>(RankGroup::kDrawn)}
                                   << 56;
  return is_visible(rank.group()) ? (kDrawn | (rank.bits() & kKeyMask)) : rank.bits();
}

// Whether a request of rank `request` may take the place of a ready mesh of rank `victim`. An
// invisible one only if strictly worse; a visible one only for a hole that is strictly nearer by
// layer and distance; refining what is drawn never costs anything that is visible.
constexpr bool may_evict(Rank request, Rank victim) {
  if (!is_visible(victim.group())) return victim > request;
  return request.group() == RankGroup::kVisibleHole &&
         eviction_order(victim) > eviction_order(request);
}

}  // namespace psygen::synthesis
