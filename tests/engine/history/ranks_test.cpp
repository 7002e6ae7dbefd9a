#include "engine/history/ranks.hpp"

#include <gtest/gtest.h>

namespace psygen::history {
namespace {

TEST(Ranks, TheTestIsExact) {
  RankTails tails;
  EXPECT_NEAR(tails.p(5, 5, 25), 2.0 / 252, 1e-15);     // all above
  EXPECT_NEAR(tails.p(5, 5, 0), 2.0 / 252, 1e-15);      // all below
  EXPECT_NEAR(tails.p(20, 5, 99), 4.0 / 53130, 1e-15);  // one inversion: two orders of each side
  EXPECT_NEAR(tails.p(5, 20, 99), 4.0 / 53130, 1e-15);
  EXPECT_DOUBLE_EQ(tails.p(7, 6, 21), 1);
}

TEST(Ranks, TiesCountAgainstAChange) {
  RankTails tails;
  EXPECT_DOUBLE_EQ(tails.p(5, 5, 24.5), tails.p(5, 5, 24));
  EXPECT_DOUBLE_EQ(tails.p(5, 5, 0.5), tails.p(5, 5, 1));
}

TEST(Ranks, EqualValuesShareTheirRank) {
  const std::vector<double> values = {3, 1, 3, 2};
  EXPECT_EQ(mid_ranks(values), (std::vector<double>{1, -1.5, 1, -0.5}));
}

TEST(Ranks, TheMedianOfAnEvenNumberIsTheMiddle) {
  EXPECT_DOUBLE_EQ(median(std::vector<double>{4, 1, 3, 2}), 2.5);
  EXPECT_DOUBLE_EQ(median(std::vector<double>{9, 1, 3}), 3);
}

TEST(Ranks, ZIsTheInverseOfP) {
  EXPECT_NEAR(z_of(0.05), -1.959963984540054, 1e-12);
  EXPECT_NEAR(z_of(1e-12), -7.130506146185, 1e-6);
  EXPECT_NEAR(p_of(z_of(0.3)), 0.3, 1e-12);
  EXPECT_DOUBLE_EQ(corrected(-3, 0.8), -1);
}

TEST(Ranks, TheCorrelationIsThatOfNeighbours) {
  std::vector<double> rising, alternating;
  for (int i = 0; i < 30; ++i) {
    rising.push_back(i);
    alternating.push_back(i % 2);
  }
  EXPECT_DOUBLE_EQ(rank_correlation(rising, 0), 0.8);
  EXPECT_DOUBLE_EQ(rank_correlation(alternating, 0), 0);
  EXPECT_DOUBLE_EQ(rank_correlation(std::vector<double>(30, 1.0), 0), 0) << "no scatter at all";
  EXPECT_DOUBLE_EQ(rank_correlation(std::vector<double>(rising.begin(), rising.begin() + 19), 0),
                   0);
}

}  // namespace
}  // namespace psygen::history
