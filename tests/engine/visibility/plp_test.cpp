#include "engine/visibility/plp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <set>
#include <tuple>

#include "tests/engine/visibility/scenes.hpp"

namespace psygen::visibility {
namespace {

using testing::GridScene;
using testing::random_pose;

core::RandomStream stream(std::uint32_t index) {
  return {23, 0, 0, index, core::Purpose::kPosition};
}

PlpInput input_of(const GridScene& scene, std::uint32_t max_visits = UINT32_MAX) {
  const GridCell start = nearest_cell({0, 0}, scene.width, scene.depth, scene.pose.position.block);
  return {scene.width, scene.depth, start.x, start.z, scene.bounds, &scene.frustum, max_visits};
}

PlpResult run(const GridScene& scene, std::uint32_t max_visits = UINT32_MAX) {
  PlpResult result;
  run_plp(input_of(scene, max_visits), result);
  return result;
}

std::vector<std::uint32_t> neighbours(const GridScene& scene, std::uint32_t cell) {
  std::vector<std::uint32_t> found;
  const int x = static_cast<int>(cell % scene.width), z = static_cast<int>(cell / scene.width);
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int nx = x + dx, nz = z + dz;
      if ((dx == 0 && dz == 0) || nx < 0 || nz < 0 || nx >= static_cast<int>(scene.width) ||
          nz >= static_cast<int>(scene.depth))
        continue;
      found.push_back(static_cast<std::uint32_t>(nz) * scene.width +
                      static_cast<std::uint32_t>(nx));
    }
  }
  return found;
}

float distance(const core::Bounds& box) {
  const glm::vec3 p = glm::clamp(glm::vec3(0.0F), box.min, box.max);
  return p.x * p.x + p.y * p.y + p.z * p.z;
}

// The definition of PLP, written down with an ordered set as the front.
struct Oracle {
  using Key = std::tuple<int, bool, float, std::uint32_t>;  // layer, out of view, distance, cell
  std::vector<Key> visited;
  std::set<Key> front;

  Oracle(const GridScene& scene, std::uint32_t start, std::uint32_t budget) {
    std::set<std::uint32_t> clean;
    for (std::uint32_t cell = 0; cell < scene.bounds.size(); ++cell)
      clean.insert(cell);
    const auto push = [&](std::uint32_t cell, int layer) {
      if (clean.erase(cell) == 0) return;
      const core::Bounds& box = scene.bounds[cell];
      front.insert({layer, !intersects(scene.frustum, box), distance(box), cell});
    };
    push(start, 0);
    while (!front.empty() && visited.size() < budget) {
      visited.push_back(*front.begin());
      front.erase(front.begin());
      for (const std::uint32_t n : neighbours(scene, std::get<3>(visited.back())))
        push(n, std::get<0>(visited.back()) + 1);
    }
  }
};

void expect_equal(const PlpResult& result, const Oracle& oracle) {
  std::vector<std::uint32_t> visible, prefetch, front;
  std::vector<std::uint16_t> layer(result.layer.size(), kUnvisited);
  for (const auto& [l, out_of_view, d, cell] : oracle.visited) {
    (out_of_view ? prefetch : visible).push_back(cell);
    layer[cell] = static_cast<std::uint16_t>(l);
  }
  for (const auto& key : oracle.front)
    front.push_back(std::get<3>(key));
  EXPECT_EQ(result.visible, visible);
  EXPECT_EQ(result.prefetch, prefetch);
  EXPECT_EQ(result.front, front);
  EXPECT_EQ(result.layer, layer);
}

TEST(Plp, EqualsItsDefinitionOnRandomScenesAndBudgets) {
  core::RandomStream random = stream(0);
  for (int i = 0; i < 40; ++i) {
    const auto width = static_cast<std::uint32_t>(random.next_integer(1, 24));
    const auto depth = static_cast<std::uint32_t>(random.next_integer(1, 24));
    const GridScene scene(width, depth, random_pose(random, width, depth));
    const auto budget = static_cast<std::uint32_t>(random.next_integer(0, width * depth + 5));
    const PlpInput input = input_of(scene, budget);
    PlpResult result;
    run_plp(input, result);
    expect_equal(result, Oracle(scene, input.start_z * width + input.start_x, budget));
  }
}

TEST(Plp, EqualsItsDefinitionOnLargeLayersThatAreSortedByBuckets) {
  const GridScene scene(90, 90, {{{45, 44}, {10, 200, 50}}, 2.1, -0.5});
  expect_equal(run(scene), Oracle(scene, 44 * 90 + 45, UINT32_MAX));
}

TEST(Plp, EqualsItsDefinitionWhereMostCellsAreEquallyFar) {
  // Boxes of all cells reach up to the camera, but for a few far ones that stretch the range.
  GridScene scene(60, 60, {{{30, 30}, {10, 20, 50}}, 0.4, 0});
  for (std::size_t i = 0; i < scene.bounds.size(); ++i) {
    if (i % 97 != 0) scene.bounds[i] = {glm::vec3(-1), glm::vec3(1)};
  }
  expect_equal(run(scene), Oracle(scene, 30 * 60 + 30, UINT32_MAX));
}

TEST(Plp, LayersAreBreadthFirst) {
  core::RandomStream random = stream(1);
  for (int i = 0; i < 10; ++i) {
    const GridScene scene(19, 12, random_pose(random, 19, 12));
    const PlpInput input = input_of(scene);
    std::vector<std::uint16_t> expected(scene.bounds.size(), kUnvisited);
    std::deque<std::uint32_t> queue{input.start_z * scene.width + input.start_x};
    expected[queue.front()] = 0;
    while (!queue.empty()) {
      const std::uint32_t cell = queue.front();
      queue.pop_front();
      for (const std::uint32_t n : neighbours(scene, cell)) {
        if (expected[n] != kUnvisited) continue;
        expected[n] = static_cast<std::uint16_t>(expected[cell] + 1);
        queue.push_back(n);
      }
    }
    EXPECT_EQ(run(scene).layer, expected);
  }
}

TEST(Plp, FindsExactlyTheCellsThatBruteForceFindsAndEachOnce) {
  core::RandomStream random = stream(2);
  std::size_t seen = 0;
  for (int i = 0; i < 60; ++i) {
    const GridScene scene(21, 17, random_pose(random, 21, 17));
    const PlpResult result = run(scene);
    std::vector<std::uint32_t> visible = result.visible, expected;
    for (std::uint32_t cell = 0; cell < scene.bounds.size(); ++cell) {
      if (intersects(scene.frustum, scene.bounds[cell])) expected.push_back(cell);
    }
    std::ranges::sort(visible);
    EXPECT_EQ(visible, expected);
    EXPECT_EQ(visible.size() + result.prefetch.size(), scene.bounds.size());
    EXPECT_TRUE(result.front.empty());
    for (std::uint32_t cell = 0; cell < scene.bounds.size(); ++cell)
      EXPECT_EQ(result.in_view[cell] == 1, std::ranges::binary_search(expected, cell));
    seen += visible.size();
  }
  EXPECT_GT(seen, 1000U);
}

TEST(Plp, FromAboveTheGroundTheHorizonIsFoundThoughNoNeighbourIsInView) {
  // 600 m up, looking level: the ground comes into view kilometres ahead.
  const GridScene scene(101, 101, {{{50, 50}, {32, 600, 32}}, 0, 0});
  const PlpResult result = run(scene);
  for (const std::uint32_t n : neighbours(scene, 50 * 101 + 50))
    EXPECT_EQ(result.in_view[n], 0);
  EXPECT_GT(result.visible.size(), 1000U);
}

TEST(Plp, KeysNeverDecreaseWithinTheVisibleAndThePrefetchedCells) {
  core::RandomStream random = stream(3);
  for (int i = 0; i < 10; ++i) {
    const GridScene scene(30, 30, random_pose(random, 30, 30));
    const PlpResult result = run(scene);
    for (const auto* list : {&result.visible, &result.prefetch}) {
      EXPECT_TRUE(std::ranges::is_sorted(*list, {}, [&](std::uint32_t cell) {
        return std::tuple(result.layer[cell], distance(scene.bounds[cell]));
      }));
    }
  }
}

TEST(Plp, WhenTheBudgetEndsEveryCleanNeighbourOfAVisitedCellIsInTheFront) {
  core::RandomStream random = stream(4);
  for (const std::uint32_t budget : {0U, 1U, 2U, 10U, 57U, 120U, 399U}) {
    const GridScene scene(20, 20, random_pose(random, 20, 20));
    const PlpResult result = run(scene, budget);
    EXPECT_EQ(result.visible.size() + result.prefetch.size(), budget);
    const std::set<std::uint32_t> front(result.front.begin(), result.front.end());
    EXPECT_EQ(front.size(), result.front.size());
    for (std::uint32_t cell = 0; cell < scene.bounds.size(); ++cell) {
      if (result.layer[cell] == kUnvisited) continue;
      EXPECT_FALSE(front.contains(cell));
      for (const std::uint32_t n : neighbours(scene, cell))
        EXPECT_TRUE(result.layer[n] != kUnvisited || front.contains(n));
    }
  }
}

TEST(Plp, ABudgetShowsABeginningOfTheUnlimitedOrder) {
  const GridScene scene(25, 25, {{{12, 12}, {3, 30, 60}}, 1, -0.1});
  const PlpResult all = run(scene), some = run(scene, 200);
  ASSERT_LT(some.visible.size(), all.visible.size());
  EXPECT_TRUE(std::equal(some.visible.begin(), some.visible.end(), all.visible.begin()));
  EXPECT_TRUE(std::equal(some.prefetch.begin(), some.prefetch.end(), all.prefetch.begin()));
}

TEST(Plp, ACameraOutsideTheGridStartsFromTheNearestCell) {
  const GridScene scene(8, 8, {{{-20, 3}, {1, 10, 1}}, 1.57, 0});
  const PlpResult result = run(scene);
  EXPECT_EQ(result.layer[3 * 8 + 0], 0);
  EXPECT_EQ(result.layer[3 * 8 + 7], 7);

  PlpInput input = input_of(scene);
  input.start_x = 500;
  input.start_z = 7;
  PlpResult clamped;
  run_plp(input, clamped);
  EXPECT_EQ(clamped.layer[7 * 8 + 7], 0);
}

TEST(Plp, NearestCellWorksAcrossTheSeamOfTheBlockIndices) {
  const core::BlockCoord corner{INT32_MAX - 2, INT32_MIN};
  const GridCell cell = nearest_cell(corner, 10, 10, {INT32_MIN + 1, INT32_MIN + 4});
  EXPECT_EQ(cell.x, 4U);
  EXPECT_EQ(cell.z, 4U);
}

TEST(Plp, AnEmptyGridHasNothingToVisit) {
  const Frustum frustum{};
  PlpResult result;
  run_plp({0, 0, 0, 0, {}, &frustum, 10}, result);
  EXPECT_TRUE(result.visible.empty());
  EXPECT_TRUE(result.layer.empty());
}

TEST(Plp, AResultThatIsUsedAgainIsNotChangedByItsPast) {
  core::RandomStream random = stream(5);
  PlpResult reused;
  for (const std::uint32_t side : {30U, 7U, 30U, 12U}) {
    const GridScene scene(side, side, random_pose(random, side, side));
    run_plp(input_of(scene, side * 20), reused);
    const PlpResult fresh = run(scene, side * 20);
    EXPECT_EQ(reused.visible, fresh.visible);
    EXPECT_EQ(reused.prefetch, fresh.prefetch);
    EXPECT_EQ(reused.front, fresh.front);
    EXPECT_EQ(reused.layer, fresh.layer);
    EXPECT_EQ(reused.in_view, fresh.in_view);
  }
}

}  // namespace
}  // namespace psygen::visibility
