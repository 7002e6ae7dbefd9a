#include "engine/synthesis/rank.hpp"

#include <gtest/gtest.h>

#include <limits>
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

TEST(Rank, ARequestMayEvictOnlyWhatIsStrictlyWorse) {
  for (const Rank request : many_ranks()) {
    for (const Rank victim : many_ranks()) {
      if (!may_evict(request, victim) || victim.group() == RankGroup::kVisibleFine) continue;
      EXPECT_GT(victim, request);
    }
  }
}

// The layer and distance of a visible mesh, in another group; a hole takes the most urgent turn.
Rank as(RankGroup group, Rank rank) {
  const std::uint64_t key = rank.bits() & ((std::uint64_t{1} << 48) - 1);
  return {group, static_cast<std::uint32_t>(key >> 32),
          std::bit_cast<float>(static_cast<std::uint32_t>(key))};
}

TEST(Rank, TwoMeshesCannotGoOnEvictingEachOther) {
  // Once evicted a visible mesh is a hole, and what a request is granted is drawn no finer than
  // wanted: only what was too fine can be taken by what is farther, and only once.
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

TEST(Rank, AHoleTakesWhatIsFartherWhateverItsTurn) {
  const Rank hole = Rank::hole(30, 1, 20.0F);
  EXPECT_TRUE(may_evict(hole, Rank::by_layer(RankGroup::kDrawn, 2, 10.0F)));
  EXPECT_TRUE(may_evict(hole, Rank::by_layer(RankGroup::kDrawn, 1, 30.0F)));
  EXPECT_FALSE(may_evict(hole, Rank::by_layer(RankGroup::kDrawn, 1, 10.0F)));
  EXPECT_FALSE(may_evict(hole, Rank::by_layer(RankGroup::kDrawn, 0, 30.0F)));
}

TEST(Rank, WhatIsTooFineGoesBeforeAllElseThatIsVisibleAndAfterWhatIsNot) {
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
