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
  EXPECT_EQ(ordered[7].group(), RankGroup::kPredicted);
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
  for (int group = 0; group <= 5; ++group) {
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
      if (!may_evict(request, victim)) continue;
      EXPECT_GT(victim, request);
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
      EXPECT_FALSE(may_evict(back, request));
    }
  }
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
