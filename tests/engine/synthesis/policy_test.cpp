#include "engine/synthesis/policy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace psygen::synthesis {
namespace {

const std::vector<ScheduleKey> kKeys{
    {Rank::by_layer(RankGroup::kPrefetch, 1, 10), 9.0F, 0.1, 0},
    {Rank::by_deadline(2.0F, 10), 2.0F, 0.5, 1},
    {Rank::by_layer(RankGroup::kVisibleCoarse, 1, 10), 0.0F, 0.9, 2},
    {Rank::by_layer(RankGroup::kVisibleHole, 5, 10), 0.0F, 0.3, 3},
    {Rank::by_layer(RankGroup::kVisibleHole, 5, 10), 0.0F, 0.2, 4},
    {Rank::by_layer(RankGroup::kPrefetch, 2, 10), 3.0F, 0.4, 5},
};

std::vector<std::size_t> order_by(Policy policy) {
  std::vector<std::size_t> order(kKeys.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::reverse(order.begin(), order.end());
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return served_before(policy, kKeys[a], kKeys[b]); });
  return order;
}

using Order = std::vector<std::size_t>;

TEST(Policy, FifoServesInTheOrderOfArrival) {
  EXPECT_EQ(order_by(Policy::kFifo), (Order{0, 1, 2, 3, 4, 5}));
}
TEST(Policy, PlpServesByRankAndThenTheShorter) {
  EXPECT_EQ(order_by(Policy::kPlp), (Order{4, 3, 2, 1, 0, 5}));
}
TEST(Policy, ShortestAndLongestServeByPredictedTimeAlone) {
  EXPECT_EQ(order_by(Policy::kShortest), (Order{0, 4, 3, 5, 1, 2}));
  EXPECT_EQ(order_by(Policy::kLongest), (Order{2, 1, 5, 3, 4, 0}));
}
TEST(Policy, DeadlineServesTheVisibleFirstAndThenTheEarliest) {
  EXPECT_EQ(order_by(Policy::kDeadline), (Order{4, 3, 2, 1, 5, 0}));
}

TEST(Policy, NamesAndPoliciesMapToEachOther) {
  for (const Policy policy : kAllPolicies)
    EXPECT_EQ(policy_from(name_of(policy)), policy);
  EXPECT_EQ(policy_from("shorttest"), std::nullopt);
  EXPECT_EQ(policy_from(""), std::nullopt);
}

}  // namespace
}  // namespace psygen::synthesis
