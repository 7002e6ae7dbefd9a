#include "engine/visibility/plp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "tests/engine/visibility/scenes.hpp"

namespace psygen::visibility {
namespace {

using testing::GridScene;
using testing::random_pose;
using testing::stream;

PlpInput input_of(const GridScene& scene, std::uint32_t max_visits = UINT32_MAX) {
  const auto nearest = [](std::int32_t block, std::uint32_t cells) {
    return static_cast<std::uint32_t>(std::clamp(block, 0, static_cast<std::int32_t>(cells) - 1));
  };
  const core::BlockCoord block = scene.pose.position.block;
  return {.width = scene.width,
          .depth = scene.depth,
          .start_x = nearest(block.x, scene.width),
          .start_z = nearest(block.z, scene.depth),
          .bounds = scene.bounds,
          .frustum = &scene.frustum,
          .max_visits = max_visits};
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

// Computes the keys by their definition, one cell at a time.
std::vector<std::uint32_t> keys_of(const PlpInput& input) {
  const int w = static_cast<int>(input.width), start_x = static_cast<int>(input.start_x),
            start_z = static_cast<int>(input.start_z);
  std::map<int, std::uint32_t> known;
  const std::function<std::uint32_t(int, int)> key_at = [&](int x, int z) -> std::uint32_t {
    const int dx = x - start_x, dz = z - start_z, far = std::max(std::abs(dx), std::abs(dz)),
              near = std::min(std::abs(dx), std::abs(dz));
    if (input.mode == PlpMode::kLayers || far == 0) return static_cast<std::uint32_t>(16 * far);
    if (const auto found = known.find(z * w + x); found != known.end()) return found->second;
    const auto behind = [&](int bx, int bz) {
      const float solidity = input.solidity[static_cast<std::size_t>(bz * w + bx)];
      return key_at(bx, bz) + 16 +
             static_cast<std::uint32_t>(std::lround(16 * input.solidity_layers * solidity));
    };
    const int sx = (dx > 0) - (dx < 0), sz = (dz > 0) - (dz < 0);
    const auto t = static_cast<std::uint32_t>(std::lround(256.0 * near / far));
    std::uint32_t sum = 128;
    if (t > 0) sum += t * behind(x - sx, z - sz);
    if (t < 256)
      sum += (256 - t) * (std::abs(dx) >= std::abs(dz) ? behind(x - sx, z) : behind(x, z - sz));
    return known[z * w + x] = sum / 256;
  };
  std::vector<std::uint32_t> keys;
  for (int cell = 0; cell < w * static_cast<int>(input.depth); ++cell)
    keys.push_back(key_at(cell % w, cell / w));
  return keys;
}

std::vector<float> random_solidity(const GridScene& scene, core::RandomStream& random) {
  std::vector<float> solidity;
  while (solidity.size() < scene.bounds.size())
    solidity.push_back(static_cast<float>(std::floor(random.next_real(0, 9)) / 8));
  return solidity;
}

// PLP by its definition, with an ordered set as the front.
struct Oracle {
  // key, out of view, distance, cell
  using Key = std::tuple<std::uint32_t, bool, float, std::uint32_t>;
  std::vector<Key> visited;
  std::set<Key> front;

  Oracle(const GridScene& scene, const PlpInput& input) {
    const std::vector<std::uint32_t> keys = keys_of(input);
    std::set<std::uint32_t> clean;
    for (std::uint32_t cell = 0; cell < scene.bounds.size(); ++cell)
      clean.insert(cell);
    const auto push = [&](std::uint32_t cell) {
      if (clean.erase(cell) == 0) return;
      const core::Bounds& box = scene.bounds[cell];
      front.insert({keys[cell], !intersects(scene.frustum, box), distance(box), cell});
    };
    push(input.start_z * input.width + input.start_x);
    while (!front.empty() && visited.size() < input.max_visits) {
      visited.push_back(*front.begin());
      front.erase(front.begin());
      for (const std::uint32_t n : neighbours(scene, std::get<3>(visited.back())))
        push(n);
    }
  }
};

void expect_equal_to_definition(const GridScene& scene, const PlpInput& input) {
  PlpResult result;
  run_plp(input, result);
  const Oracle oracle(scene, input);
  std::vector<std::uint32_t> visible, prefetch, front;
  std::set<std::uint32_t> visited;
  for (const auto& [key, out_of_view, d, cell] : oracle.visited) {
    (out_of_view ? prefetch : visible).push_back(cell);
    visited.insert(cell);
    EXPECT_EQ(result.key[cell], key);
  }
  for (const auto& key : oracle.front)
    front.push_back(std::get<3>(key));
  EXPECT_TRUE(std::ranges::is_sorted(oracle.visited));  // keys never decrease
  EXPECT_EQ(result.visible, visible);
  EXPECT_EQ(result.prefetch, prefetch);
  EXPECT_EQ(result.front, front);
  for (std::uint32_t cell = 0; cell < scene.bounds.size(); ++cell)
    EXPECT_EQ(result.layer[cell] != kUnvisited, visited.contains(cell));
}

TEST(Plp, EqualsItsDefinitionOnRandomScenesAndBudgetsInBothModes) {
  core::RandomStream random = stream(23, 0);
  for (int i = 0; i < 80; ++i) {
    const auto width = static_cast<std::uint32_t>(random.next_integer(1, 24));
    const auto depth = static_cast<std::uint32_t>(random.next_integer(1, 24));
    const GridScene scene(width, depth, random_pose(random, width, depth));
    const std::vector<float> solidity = random_solidity(scene, random);
    PlpInput input =
        input_of(scene, static_cast<std::uint32_t>(random.next_integer(0, width * depth + 5)));
    input.mode = i % 2 == 0 ? PlpMode::kLayers : PlpMode::kSolidity;
    input.solidity = solidity;
    input.solidity_layers = static_cast<float>(random.next_integer(0, 20));
    expect_equal_to_definition(scene, input);
  }
}

TEST(Plp, EqualsItsDefinitionOnLargeLayersThatAreSortedByBuckets) {
  const GridScene scene(90, 90, {{{45, 44}, {10, 200, 50}}, 2.1, -0.5});
  expect_equal_to_definition(scene, input_of(scene));
}

TEST(Plp, EqualsItsDefinitionIfMostCellsAreEquallyFar) {
  // The boxes of all cells reach up to the camera, except for a few far ones that stretch the
  // range.
  GridScene scene(60, 60, {{{30, 30}, {10, 20, 50}}, 0.4, 0});
  for (std::size_t i = 0; i < scene.bounds.size(); ++i) {
    if (i % 97 != 0) scene.bounds[i] = {glm::vec3(-1), glm::vec3(1)};
  }
  expect_equal_to_definition(scene, input_of(scene));
}

TEST(Plp, WithEqualSolidityEqualsLayersForAnyBudget) {
  core::RandomStream random = stream(23, 6);
  for (int i = 0; i < 30; ++i) {
    const GridScene scene(40, 33, random_pose(random, 40, 33));
    const std::vector<float> solidity(scene.bounds.size(),
                                      i % 5 == 0 ? 0.0F : static_cast<float>(random.next_unit()));
    PlpInput input = input_of(scene, static_cast<std::uint32_t>(random.next_integer(0, 1500)));
    PlpResult layers, solid;
    run_plp(input, layers);
    input.mode = PlpMode::kSolidity;
    input.solidity = solidity;
    run_plp(input, solid);
    EXPECT_EQ(solid.visible, layers.visible);
    EXPECT_EQ(solid.prefetch, layers.prefetch);
    EXPECT_EQ(solid.front, layers.front);
    EXPECT_EQ(solid.layer, layers.layer);
    if (i % 5 == 0) {
      EXPECT_EQ(solid.key, layers.key);  // nothing is solid
    }
  }
}

TEST(Plp, MoreSolidCellsLowerNoKeyAndRaiseOnlyThoseBehindThem) {
  core::RandomStream random = stream(23, 7);
  const GridScene scene(31, 31, {{{15, 15}, {30, 30, 30}}, 0, 0});
  std::vector<float> solidity = random_solidity(scene, random);
  PlpInput input = input_of(scene);
  input.mode = PlpMode::kSolidity;
  input.solidity = solidity;
  PlpResult before, after;
  run_plp(input, before);
  const std::uint32_t changed = 15 * 31 + 20;  // five cells to the right of the camera
  solidity[changed] = 2;                       // counts as 1
  run_plp(input, after);
  for (std::uint32_t cell = 0; cell < scene.bounds.size(); ++cell) {
    const int dx = static_cast<int>(cell % 31) - 15, dz = static_cast<int>(cell / 31) - 15;
    EXPECT_GE(after.key[cell], before.key[cell]);
    if (dx <= 5 || std::abs(dz) >= dx) {
      EXPECT_EQ(after.key[cell], before.key[cell]);
    }
  }
  EXPECT_GT(after.key[changed + 1], before.key[changed + 1]);
}

TEST(Plp, CellsBehindAWallComeAfterOpenGroundThatIsFartherAway) {
  const GridScene scene(41, 41, {{{20, 20}, {32, 30, 32}}, 0.78, 0});
  std::vector<float> solidity(scene.bounds.size(), 0.0F);
  for (std::uint32_t z = 0; z < 41; ++z)
    solidity[z * 41 + 23] = 1;  // a wall from end to end, three cells to the right
  PlpInput input = input_of(scene);
  input.mode = PlpMode::kSolidity;
  input.solidity = solidity;
  PlpResult result;
  run_plp(input, result);
  EXPECT_EQ(result.key[20 * 41 + 23], 3U * 16);                   // the wall itself is visible
  EXPECT_EQ(result.key[20 * 41 + 24], (4U + 8) * 16);             // eight layers later
  EXPECT_GT(result.key[20 * 41 + 24], result.key[10 * 41 + 20]);  // than ten cells ahead
}

TEST(Plp, SolidityThatIsNotANumberOrBelowZeroCountsAsNone) {
  const GridScene scene(9, 9, {{{4, 4}, {32, 30, 32}}, 0.78, 0});
  const std::vector<float> solidity(81, std::numeric_limits<float>::quiet_NaN()),
      negative(81, -3.0F);
  PlpInput input = input_of(scene);
  const PlpResult layers = run(scene);
  input.mode = PlpMode::kSolidity;
  for (const auto* values : {&solidity, &negative}) {
    input.solidity = *values;
    PlpResult result;
    run_plp(input, result);
    EXPECT_EQ(result.key, layers.key);
  }
}

TEST(Plp, LayersAreBreadthFirst) {
  core::RandomStream random = stream(23, 1);
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
  core::RandomStream random = stream(23, 2);
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

TEST(Plp, FromHighAboveTheHorizonIsFoundAlthoughNoNeighbourIsInView) {
  // 600 m up, looking level: the ground comes into view kilometres ahead.
  const GridScene scene(101, 101, {{{50, 50}, {32, 600, 32}}, 0, 0});
  const PlpResult result = run(scene);
  for (const std::uint32_t n : neighbours(scene, 50 * 101 + 50))
    EXPECT_EQ(result.in_view[n], 0);
  EXPECT_GT(result.visible.size(), 1000U);
}

TEST(Plp, KeysNeverDecreaseWithinTheVisibleAndThePrefetchedCells) {
  core::RandomStream random = stream(23, 3);
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
  core::RandomStream random = stream(23, 4);
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

TEST(Plp, AnEmptyGridHasNothingToVisit) {
  const Frustum frustum{};
  PlpResult result;
  run_plp({0, 0, 0, 0, {}, &frustum, 10}, result);
  EXPECT_TRUE(result.visible.empty());
  EXPECT_TRUE(result.layer.empty());
}

TEST(Plp, AReusedResultDoesNotDependOnItsPast) {
  core::RandomStream random = stream(23, 5);
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
