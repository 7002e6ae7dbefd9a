#include "engine/models/kit/quad_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

namespace psygen::models {
namespace {

struct Number {
  std::uint64_t value = 0;
  struct Summary {
    std::uint64_t sum = 0;
    void add(const Summary& part) { sum += part.sum; }
  };
  bool empty() const { return value == 0; }
  std::uint64_t hash() const { return core::mix64(value); }
  Summary summary() const { return {value}; }
};
using Map = QuadMap<Number>;

QuadCoord any_place(std::mt19937& random) {
  // Dense around the origin, where signs change, and a few positions at the ends of the world.
  std::uniform_int_distribution<std::int32_t> near(-6, 6), all(INT32_MIN, INT32_MAX);
  const bool far = random() % 8 == 0;
  const core::BlockCoord block{far ? all(random) : near(random), far ? all(random) : near(random)};
  QuadCoord place = QuadCoord::of(block);
  for (std::uint32_t up = random() % 4; up > 0; --up)
    place = place.parent();
  return place;
}

using Expected = std::map<std::tuple<std::uint32_t, std::uint64_t, std::uint64_t>, std::uint64_t>;

TEST(QuadCoord, BlocksAndCornersAreInverse) {
  for (const core::BlockCoord block :
       {core::BlockCoord{0, 0}, core::BlockCoord{-1, 5}, core::BlockCoord{INT32_MIN, INT32_MAX}})
    EXPECT_EQ(QuadCoord::of(block).corner(), block);
  EXPECT_TRUE(QuadCoord::of({-1, -1}, 3).covers(QuadCoord::of({-8, -1})));
  EXPECT_FALSE(QuadCoord::of({-1, -1}, 3).covers(QuadCoord::of({0, -1})));
}

TEST(QuadMap, BehavesLikeAMapAndCopiesStayAsTheyWere) {
  std::mt19937 random(7);
  Map map;
  Expected expected;
  std::vector<std::pair<Map, Expected>> copies;
  for (int i = 0; i < 4000; ++i) {
    const QuadCoord place = any_place(random);
    const std::uint64_t value = random() % 3 == 0 ? 0 : 1 + random() % 1000;
    map.set(place, {value});
    if (value == 0) expected.erase({place.level, place.x, place.z});
    if (value != 0) expected[{place.level, place.x, place.z}] = value;
    if (i % 500 == 0) copies.emplace_back(map, expected);
  }
  copies.emplace_back(map, expected);
  for (const auto& [copy, content] : copies) {
    std::uint64_t sum = 0;
    for (const auto& [key, value] : content) {
      const auto [level, x, z] = key;
      const Number* found = copy.find({level, x, z});
      ASSERT_NE(found, nullptr);
      EXPECT_EQ(found->value, value);
      sum += value;
    }
    std::size_t count = 0;
    Map::each_difference(Map(), copy,
                         [&](const QuadCoord&, const Number*, const Number*) { ++count; });
    EXPECT_EQ(count, content.size());
    ASSERT_NE(copy.root(), nullptr);
    EXPECT_EQ(copy.root()->summary.sum, sum);
  }
}

TEST(QuadMap, EqualContentHasEqualHashesWithAnyHistory) {
  std::mt19937 random(3);
  std::vector<std::pair<QuadCoord, std::uint64_t>> content;
  for (int i = 0; i < 200; ++i) {
    const QuadCoord place = any_place(random);
    if (std::ranges::find(content, place, &std::pair<QuadCoord, std::uint64_t>::first) ==
        content.end())
      content.emplace_back(place, 1 + random() % 1000);
  }
  Map first;
  for (const auto& [place, value] : content)
    first.set(place, {value});
  for (int round = 0; round < 5; ++round) {
    std::ranges::shuffle(content, random);
    Map map;
    for (const auto& [place, value] : content) {
      const QuadCoord detour = any_place(random);
      const Number* before = map.find(detour);
      const Number kept = before != nullptr ? *before : Number{};
      map.set(detour, {value + 77});
      map.set(detour, kept);
      map.set(place, {value});
    }
    EXPECT_EQ(map.root()->hash, first.root()->hash);
    for (const auto& [place, value] : content) {
      const auto* cell = map.at_or_below(place);
      const auto* same = first.at_or_below(place);
      ASSERT_TRUE(cell != nullptr && same != nullptr);
      EXPECT_EQ(cell->hash, same->hash);
    }
  }
  Map other = first;
  other.set(content[0].first, {content[0].second + 1});
  EXPECT_NE(other.root()->hash, first.root()->hash);
  for (const auto& [place, value] : content)
    other.set(place, {});
  EXPECT_TRUE(other.empty());
}

TEST(QuadMap, AValueAtAnotherPositionChangesTheHashOfEverySquareAroundIt) {
  Map here, beside;
  here.set(QuadCoord::of({12, 7}), {5});
  beside.set(QuadCoord::of({13, 7}), {5});
  for (std::uint32_t level = 1; level <= QuadCoord::kMaxLevel; ++level) {
    QuadCoord around = QuadCoord::of({12, 7});
    while (around.level < level)
      around = around.parent();
    ASSERT_NE(here.at_or_below(around), nullptr);
    ASSERT_NE(beside.at_or_below(around), nullptr);
    EXPECT_NE(here.at_or_below(around)->hash, beside.at_or_below(around)->hash) << level;
  }
  // The same pair of values, moved together.
  here.set(QuadCoord::of({14, 7}), {6});
  beside.set(QuadCoord::of({15, 7}), {6});
  EXPECT_NE(here.root()->hash, beside.root()->hash);
}

TEST(QuadMap, DifferencesAreTheSquaresWhoseValuesDiffer) {
  std::mt19937 random(11);
  for (int round = 0; round < 50; ++round) {
    Map before;
    for (int i = 0; i < 60; ++i)
      before.set(any_place(random), {1 + random() % 9});
    Map after = before;
    for (int i = 0; i < static_cast<int>(random() % 8); ++i)
      after.set(any_place(random), {random() % 3});
    std::map<std::tuple<std::uint32_t, std::uint64_t, std::uint64_t>, int> reported;
    Map::each_difference(before, after, [&](const QuadCoord& p, const Number* a, const Number* b) {
      EXPECT_EQ(before.find(p), a);
      EXPECT_EQ(after.find(p), b);
      ++reported[{p.level, p.x, p.z}];
    });
    const auto expect_reported = [&](const Map& one, const Map& two) {
      Map::each_difference(Map(), one, [&](const QuadCoord& p, const Number*, const Number* value) {
        const bool differs = two.find(p) != value;
        EXPECT_EQ((reported[{p.level, p.x, p.z}]), differs ? 1 : 0);
      });
    };
    expect_reported(before, after);
    expect_reported(after, before);
  }
}

}  // namespace
}  // namespace psygen::models
