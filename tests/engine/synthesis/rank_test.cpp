#include "engine/synthesis/rank.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "engine/core/hash.hpp"

namespace psygen::synthesis {
namespace {

TEST(Rank, GroupsComeFirstThenTheMajorThenTheDistance) {
  const std::vector<Rank> ordered{
      Rank::by_layer(RankGroup::kVisibleHole, 0, 0.0F),
      Rank::by_layer(RankGroup::kVisibleHole, 0, 5.0F),
      Rank::by_layer(RankGroup::kVisibleHole, 3, 1.0F),
      Rank::hole(4, 0, 0.0F),
      Rank::hole(4, 1, 0.0F),
      Rank::hole(5, 0, 0.0F),
      Rank::hole(1000, 1u << 30, 1e30F),
      Rank::by_layer(RankGroup::kVisibleFine, 0, 0.0F),
      Rank::by_layer(RankGroup::kVisibleCoarse, 0, 0.0F),
      Rank::by_layer(RankGroup::kDrawn, 9, 1e6F),
      Rank::by_deadline(0.0F, 1.0F),
      Rank::by_deadline(0.5F, 1.0F),
      Rank::by_deadline(0.5F, 100.0F),
      Rank::by_deadline(1e9F, 1.0F),
      Rank::by_layer(RankGroup::kPrefetch, 0, 0.0F),
      Rank::by_layer(RankGroup::kPrefetch, 4000000000u, 0.0F),
      Rank::unwanted(),
  };
  for (std::size_t i = 0; i + 1 < ordered.size(); ++i)
    EXPECT_LT(ordered[i], ordered[i + 1]) << i;
  EXPECT_EQ(ordered[12].group(), RankGroup::kPredicted);
}

TEST(Rank, HostileDistancesAndDeadlinesStayInTheirGroup) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf, -1.0F}) {
    EXPECT_EQ(Rank::by_layer(RankGroup::kDrawn, 1, bad).group(), RankGroup::kDrawn);
    EXPECT_EQ(Rank::by_deadline(bad, bad).group(), RankGroup::kPredicted);
  }
  EXPECT_EQ(Rank::by_layer(RankGroup::kDrawn, 1, -1.0F),
            Rank::by_layer(RankGroup::kDrawn, 1, 0.0F));
  EXPECT_GT(Rank::by_layer(RankGroup::kDrawn, 1, nan), Rank::by_layer(RankGroup::kDrawn, 1, 1e30F));
}

std::vector<Rank> many_ranks() {
  std::vector<Rank> ranks;
  for (int group = 0; group <= 6; ++group) {
    for (std::uint32_t layer = 0; layer < 3; ++layer) {
      for (const float distance : {1.0F, 10.0F})
        ranks.push_back(Rank::by_layer(static_cast<RankGroup>(group), layer, distance));
    }
  }
  return ranks;
}

TEST(Rank, ARequestMayEvictOnlyStrictlyWorseMeshes) {
  for (const Rank request : many_ranks()) {
    for (const Rank victim : many_ranks()) {
      if (!may_evict(request, victim)) continue;
      if (victim.group() == RankGroup::kVisibleFine) {
        EXPECT_LE(request.group(), RankGroup::kVisibleFine) << "a hole, or its replacement";
      } else {
        EXPECT_GT(victim, request);
      }
    }
  }
}

TEST(Rank, TwoMeshesCanNeverEvictEachOtherInTurn) {
  // Once evicted, a visible mesh is a hole with the same layer and distance.
  for (const Rank request : many_ranks()) {
    for (const Rank victim : many_ranks()) {
      if (!is_visible(request.group()) || !is_visible(victim.group())) continue;
      if (!may_evict(request, victim)) continue;
      const std::uint64_t key = victim.bits() & ((std::uint64_t{1} << 56) - 1);
      const Rank back(RankGroup::kVisibleHole, static_cast<std::uint32_t>(key >> 32),
                      std::bit_cast<float>(static_cast<std::uint32_t>(key)));
      // A mesh that was too fine returns smaller, once: see the next test.
      if (victim.group() == RankGroup::kVisibleFine) continue;
      EXPECT_FALSE(may_evict(back, request));
    }
  }
}

// The layer and distance of a visible mesh in another group; a hole takes the most urgent value.
Rank as(RankGroup group, Rank rank) {
  const std::uint64_t key = rank.bits() & ((std::uint64_t{1} << 48) - 1);
  return {group, static_cast<std::uint32_t>(key >> 32),
          std::bit_cast<float>(static_cast<std::uint32_t>(key))};
}

TEST(Rank, TwoMeshesCannotGoOnEvictingEachOther) {
  // A granted request is never drawn finer than wanted. Only a mesh that is too fine can be evicted
  // by a farther one, and only once.
  using enum RankGroup;
  for (const Rank request : many_ranks()) {
    for (const Rank victim : many_ranks()) {
      if (!is_visible(request.group()) || !is_visible(victim.group())) continue;
      if (!may_evict(request, victim)) continue;
      const bool back = may_evict(as(kVisibleHole, victim), as(kDrawn, request));
      EXPECT_TRUE(!back || victim.group() == kVisibleFine);
      EXPECT_FALSE(back && may_evict(as(kVisibleHole, request), as(kDrawn, victim)));
    }
  }
}

// Meshes in view, most of them finer than wanted, in a cache too small even for coarse versions of
// all. Each mesh that is not drawn, or too fine, requests a coarse mesh at its turn.
class CrowdedCache {
 public:
  explicit CrowdedCache(std::uint64_t seed) : random_(seed, 0, 0, 0, core::Purpose::kParameters) {
    while (used_ + kFineBytes <= kBudgetBytes) {
      meshes_.push_back({distance(), kFineBytes});
      used_ += kFineBytes;
    }
    for (int i = 0; i < 40; ++i)
      meshes_.push_back({distance(), 0});
  }

  // Lets every mesh request once, in a new order; returns the number of evictions.
  int round() {
    int evicted = 0;
    for (std::size_t i = meshes_.size(); i > 1; --i)
      std::swap(meshes_[i - 1], meshes_[random_.next_u64() % i]);
    for (Mesh& mesh : meshes_)
      evicted += mesh.bytes == kCoarseBytes ? 0 : serve(mesh);
    return evicted;
  }
  int too_fine() const {
    return static_cast<int>(std::ranges::count(meshes_, kFineBytes, &Mesh::bytes));
  }
  // Returns true if every mesh that is not drawn is farther than all drawn meshes.
  bool nearest_are_drawn() const {
    float farthest_drawn = 0, nearest_hole = 1e9F;
    for (const Mesh& mesh : meshes_) {
      if (mesh.bytes > 0) farthest_drawn = std::max(farthest_drawn, mesh.distance_m);
      if (mesh.bytes == 0) nearest_hole = std::min(nearest_hole, mesh.distance_m);
    }
    return farthest_drawn <= nearest_hole;
  }

 private:
  static constexpr int kFineBytes = 100, kCoarseBytes = 10, kBudgetBytes = 300;
  struct Mesh {
    float distance_m;
    int bytes;
  };

  float distance() { return std::exp2(static_cast<float>(random_.next_integer(0, 128)) / 16.0F); }
  static Rank rank_of(const Mesh& mesh) {
    const auto layer = static_cast<std::uint32_t>(mesh.distance_m / 20);
    if (mesh.bytes == 0)
      return Rank::hole(static_cast<std::uint32_t>(mesh.distance_m) % 7, layer, mesh.distance_m);
    return Rank::by_layer(mesh.bytes == kFineBytes ? RankGroup::kVisibleFine : RankGroup::kDrawn,
                          layer, mesh.distance_m);
  }
  // Evicts as the cache does: the worst drawn mesh, if the request may evict it.
  int serve(Mesh& mesh) {
    const Rank request = rank_of(mesh);
    int evicted = 0;
    while (used_ + kCoarseBytes > kBudgetBytes) {
      Mesh* worst = nullptr;
      for (Mesh& other : meshes_) {
        if (other.bytes > 0 &&
            (worst == nullptr || eviction_order(rank_of(other)) > eviction_order(rank_of(*worst))))
          worst = &other;
      }
      if (worst == nullptr || !may_evict(request, rank_of(*worst))) return evicted;
      used_ -= std::exchange(worst->bytes, 0);
      ++evicted;
    }
    used_ += kCoarseBytes - std::exchange(mesh.bytes, kCoarseBytes);
    return evicted;
  }

  core::RandomStream random_;
  std::vector<Mesh> meshes_;
  int used_ = 0;
};

TEST(Rank, EvictionsInTurnEndWithTheNearestDrawnAndNothingTooFine) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CrowdedCache cache(seed);
    EXPECT_GT(cache.too_fine(), 0);
    int rounds = 0, evicted = 0, of_round = 1;
    // The cache is stable once a whole round of requests evicts nothing.
    for (; of_round > 0 && rounds < 100; ++rounds)
      evicted += of_round = cache.round();
    EXPECT_LT(rounds, 100) << "evictions never end";
    EXPECT_GT(evicted, 0);
    EXPECT_EQ(cache.too_fine(), 0);
    EXPECT_TRUE(cache.nearest_are_drawn()) << seed;
  }
}

TEST(Rank, AHoleEvictsFartherMeshesWhateverItsTurn) {
  const Rank hole = Rank::hole(30, 1, 20.0F);
  EXPECT_TRUE(may_evict(hole, Rank::by_layer(RankGroup::kDrawn, 2, 10.0F)));
  EXPECT_TRUE(may_evict(hole, Rank::by_layer(RankGroup::kDrawn, 1, 30.0F)));
  EXPECT_FALSE(may_evict(hole, Rank::by_layer(RankGroup::kDrawn, 1, 10.0F)));
  EXPECT_FALSE(may_evict(hole, Rank::by_layer(RankGroup::kDrawn, 0, 30.0F)));
}

TEST(Rank, TooFineMeshesAreEvictedAfterInvisibleAndBeforeOtherVisibleOnes) {
  const Rank near_fine = Rank::by_layer(RankGroup::kVisibleFine, 0, 0.0F);
  const Rank far_drawn = Rank::by_layer(RankGroup::kDrawn, 60000, 1e6F);
  EXPECT_GT(eviction_order(near_fine), eviction_order(far_drawn));
  EXPECT_LT(eviction_order(near_fine), eviction_order(Rank::by_deadline(0.0F, 0.0F)));
  EXPECT_TRUE(may_evict(Rank::hole(30, 9, 1e6F), near_fine));
  EXPECT_TRUE(may_evict(Rank::by_layer(RankGroup::kVisibleFine, 9, 1e6F), near_fine));
  EXPECT_FALSE(may_evict(Rank::by_layer(RankGroup::kVisibleCoarse, 0, 0.0F), near_fine));
  EXPECT_FALSE(may_evict(Rank::by_layer(RankGroup::kVisibleFine, 0, 0.0F), far_drawn));
}

TEST(Rank, RefiningNeverCostsAnythingVisible) {
  const Rank coarse = Rank::by_layer(RankGroup::kVisibleCoarse, 0, 0.0F);
  const Rank far_drawn = Rank::by_layer(RankGroup::kDrawn, 9, 1e6F);
  EXPECT_FALSE(may_evict(coarse, far_drawn));
  EXPECT_TRUE(may_evict(coarse, Rank::by_deadline(0.0F, 0.0F)));
  EXPECT_TRUE(may_evict(Rank::by_layer(RankGroup::kVisibleHole, 0, 0.0F), far_drawn));
}

}  // namespace
}  // namespace psygen::synthesis
