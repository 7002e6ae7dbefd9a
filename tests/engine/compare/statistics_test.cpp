// The expected values were computed by exact counting in Python:
// fisher: sum(comb(nb, k) * comb(na, h - k) for k in range(b, min(h, nb) + 1)) / comb(na + nb, h)
// swap_test: the signs in {1, -1}^8 with sum(sign * (b - a)) >= sum(b - a), as Fractions
// minima_test: the labellings in {0, 1}^7 whose ratio or tail is at least that of no exchange;
// the ratio of windows of min(10, frames) frames, the tail of windows of 3
#include "engine/compare/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace psygen::compare {
namespace {

// Seven pairs of runs of four frames.
const Times kRunsA{{10, 20, 30, 12}, {11, 19, 33, 12}, {10, 22, 31, 12}, {12, 20, 30, 14},
                   {11, 21, 29, 12}, {10, 23, 35, 13}, {13, 20, 31, 12}};
const Times kRunsB{{11, 22, 33, 13}, {12, 20, 35, 12}, {10, 24, 31, 15}, {14, 21, 33, 12},
                   {11, 22, 30, 13}, {11, 26, 38, 12}, {13, 23, 33, 14}};

TEST(FisherMore, IsTheHypergeometricTail) {
  EXPECT_NEAR(fisher_more(0, 8, 6, 8), 0.0034965034965034965, 1e-12);
  EXPECT_NEAR(fisher_more(1, 8, 6, 8), 0.02027972027972028, 1e-12);
  EXPECT_NEAR(fisher_more(3, 8, 3, 8), 0.6958041958041958, 1e-12);
  EXPECT_NEAR(fisher_more(0, 12, 12, 12), 3.698011505253395e-07, 1e-15);
  EXPECT_NEAR(fisher_more(8, 8, 0, 8), 1.0, 1e-12);
}

TEST(SwapTest, CountsLabellingsAtLeastAsExtreme) {
  const std::vector<double> a{10.1, 9.8, 10.4, 10.0, 9.9, 10.2, 10.3, 9.7};
  const std::vector<double> b{10.6, 10.0, 10.3, 10.9, 10.1, 10.0, 11.0, 10.2};
  EXPECT_EQ(swap_test(a, b), 8.0 / 256);
  EXPECT_EQ(swap_test(a, a), 1.0) << "all labellings are equal";
  EXPECT_EQ(swap_test(std::vector<double>(8, 1.0), std::vector<double>(8, 2.0)), 1.0 / 256);
}

TEST(MinimaTest, ComparesTheSumsOfTheMinimaOfWindows) {
  const MinimaTest test = minima_test(kRunsA, kRunsB);
  EXPECT_NEAR(test.ratio, 19.0 / 18, 1e-12) << "four frames are one window: 76 and 72";
  EXPECT_EQ(test.p_slower, 8.0 / 128);
  EXPECT_EQ(test.p_faster, 128.0 / 128);
  EXPECT_LT(test.low, 19.0 / 18);
  EXPECT_GT(test.high, 19.0 / 18);
}

TEST(TailTest, ComparesTheSecondShortestOfWindowsOfThreeFrames) {
  const TailTest test = tail_test(kRunsA, kRunsB);
  EXPECT_NEAR(test.ratio, 65.0 / 61, 1e-12) << "of the first of two windows";
  EXPECT_NEAR(test.p, 2.0 / 128, 0.006) << "of all labellings; three standard deviations of 4096";
}

TEST(RareFrames, TakeLongestRelativeToTheirLowerQuartileOverAllRuns) {
  const Times runs{{10, 20, 30, 12}, {20, 22, 31, 12}, {12, 19, 90, 14}, {12, 20, 30, 11}};
  const std::vector<double> rare = rare_frames(runs);
  ASSERT_EQ(rare.size(), 4u);
  EXPECT_NEAR(rare[0], std::log(1.0), 1e-12) << "quartiles 12, 20, 30, 12";
  EXPECT_NEAR(rare[1], std::log(5.0 / 3), 1e-12);
  EXPECT_NEAR(rare[2], std::log(3.0), 1e-12);
  EXPECT_NEAR(rare[3], std::log(1.0), 1e-12);
}

TEST(MinimaTest, TheIntervalHoldsAKnownRatioAndShrinksWithTheNoise) {
  const auto runs = [](double factor, double noise, unsigned seed) {
    Times times;
    for (unsigned run = 0; run < 8; ++run) {
      times.emplace_back();
      for (unsigned k = 0; k < 60; ++k) {
        const unsigned random = (seed + run * 977 + k * 331) * 2654435761U >> 8;
        times.back().push_back(factor * (10 + k % 7) * (1 + noise * (random % 1000) / 1000.0));
      }
    }
    return times;
  };
  const MinimaTest quiet = minima_test(runs(1, 0.05, 1), runs(1.1, 0.05, 99));
  EXPECT_LT(quiet.low, 1.1);
  EXPECT_GT(quiet.high, 1.1);
  EXPECT_EQ(quiet.p_slower, 1.0 / 256);
  const MinimaTest loud = minima_test(runs(1, 0.8, 1), runs(1.1, 0.8, 99));
  EXPECT_GT(loud.high - loud.low, quiet.high - quiet.low);
}

TEST(MannWhitney, IsExact) {
  const std::vector<double> low = {1, 2, 3, 4, 5}, high = {6, 7, 8, 9, 10},
                            mixed = {0, 2.5, 7, 8, 9};
  EXPECT_NEAR(mann_whitney(low, high), 2.0 / 252, 1e-12);
  EXPECT_EQ(mann_whitney(low, high), mann_whitney(high, low));
  EXPECT_NEAR(mann_whitney(low, std::vector<double>{0.5}), 2.0 / 6, 1e-12);
  EXPECT_EQ(mann_whitney(low, low), 1);
  // Counts the orders of both sets: 10 values choose 5, with at most the 8 pairs of this one.
  int few = 0;
  for (unsigned order = 0; order < 1024; ++order) {
    int pairs = 0, seen_a = 0, seen_b = 0;
    for (unsigned i = 0; i < 10; ++i)
      (order >> i & 1) != 0 ? ++seen_b, pairs += seen_a : ++seen_a;
    few += seen_b == 5 && pairs <= 8 ? 1 : 0;
  }
  EXPECT_NEAR(mann_whitney(low, mixed), 2 * few / 252.0, 1e-12);
}

TEST(MannWhitney, CountsTiesAgainstADifference) {
  const std::vector<double> a = {1, 2, 3, 4, 5}, b = {5, 6, 7, 8, 9};
  EXPECT_NEAR(mann_whitney(a, b), 2 * 2 / 252.0, 1e-12) << "half a pair counts as one";
  const std::vector<double> many_a(100, 1.0), many_b(100, 2.0);
  EXPECT_LT(mann_whitney(many_a, many_b), 1e-50);
}

}  // namespace
}  // namespace psygen::compare
