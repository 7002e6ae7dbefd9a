#include "engine/scene/nodes/ground_occluder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "engine/core/hash.hpp"

namespace psygen::scene {
namespace {

constexpr float kLowM = -20, kRangeM = 200;

// A mesh of n × n vertices and its skirt with these heights, 0 … 65535.
template <class Height>
std::vector<core::TerrainVertex> mesh_of_heights(std::size_t n, const Height& height) {
  std::vector<core::TerrainVertex> vertices(n * n + 4 * (n - 1));
  for (std::size_t z = 0; z < n; ++z) {
    for (std::size_t x = 0; x < n; ++x)
      vertices[z * n + x].height = vertices[z * n + x].coarse_height =
          static_cast<std::uint16_t>(height(x, z));
  }
  return vertices;
}

float metres(std::uint16_t height) {
  return kLowM + static_cast<float>(height) * (kRangeM / 65535.0F);
}

// The height of the mesh along a grid line, `at` in cells.
float on_line(const std::vector<core::TerrainVertex>& v, std::size_t first, std::size_t step,
              float at, std::size_t n) {
  const auto cell = std::min(static_cast<std::size_t>(at), n - 2);
  const float along = at - static_cast<float>(cell);
  const auto height = [&](std::size_t i) {
    const core::TerrainVertex& vertex = v[first + i * step];
    return metres(std::min(vertex.height, vertex.coarse_height));
  };
  return height(cell) * (1 - along) + height(cell + 1) * along;
}

// With `n` vertices a side.
models::TerrainGrid grid_of(std::size_t n) {
  return models::TerrainGrid(static_cast<int>(n), 0);
}

GroundOccluder occluder_of(std::span<const core::TerrainVertex> vertices, std::size_t n,
                           float lower_by_m = 0) {
  return ground_occluder(vertices, grid_of(n), kLowM, kRangeM, lower_by_m);
}

constexpr std::size_t kSides[] = {4u, 8u, 9u, 20u, 21u, 22u, 59u, 64u};

TEST(GroundOccluder, OfFlatGroundLiesOnIt) {
  for (const std::size_t n : kSides) {
    const GroundOccluder occluder =
        occluder_of(mesh_of_heights(n, [](auto, auto) { return 30000; }), n);
    ASSERT_EQ(occluder.points, std::min<std::size_t>(n, 22));
    EXPECT_EQ(occluder.place.front(), 0.0F);
    EXPECT_EQ(occluder.place[occluder.points - 1], 1.0F);
    for (std::size_t i = 0; i < occluder.points * occluder.points; ++i)
      EXPECT_FLOAT_EQ(occluder.height_m[i], metres(30000));
    for (int i = 0; i < grid_of(n).tiles_per_side() * grid_of(n).tiles_per_side(); ++i)
      EXPECT_FLOAT_EQ(occluder.top_m[static_cast<std::size_t>(i)], metres(30000));
  }
}

// Maximum height of lines above the mesh, and minimum depth below it.
struct Clearance {
  float above = -1e9F, below = 1e9F;
};

Clearance clearance_of(const GroundOccluder& occluder,
                       const std::vector<core::TerrainVertex>& vertices, std::size_t n) {
  Clearance all;
  const auto cells = static_cast<float>(n - 1);
  const std::size_t points = occluder.points;
  for (std::size_t line = 0; line < points; ++line) {
    const auto fixed = static_cast<std::size_t>(std::lround(occluder.place[line] * cells));
    for (std::size_t i = 0; i + 1 < points; ++i) {
      for (int step = 0; step <= 20; ++step) {
        const float t = static_cast<float>(step) / 20;
        const float at = cells * (occluder.place[i] * (1 - t) + occluder.place[i + 1] * t);
        const auto& h = occluder.height_m;
        const float along_x = h[line * points + i] * (1 - t) + h[line * points + i + 1] * t;
        const float along_z = h[i * points + line] * (1 - t) + h[(i + 1) * points + line] * t;
        for (const float off : {along_x - on_line(vertices, fixed * n, 1, at, n),
                                along_z - on_line(vertices, fixed, n, at, n)}) {
          all.above = std::max(all.above, off);
          all.below = std::min(all.below, -off);
        }
      }
    }
  }
  return all;
}

TEST(GroundOccluder, HasNoLineAboveTheGround) {
  for (const std::size_t n : kSides) {
    SCOPED_TRACE(testing::Message() << n << " vertices a side");
    core::RandomStream random(7, static_cast<std::uint32_t>(n), 0, 0, core::Purpose::kStructure);
    auto vertices = mesh_of_heights(n, [&](auto, auto) { return random.next_real(0, 65535); });
    for (core::TerrainVertex& vertex : vertices)
      vertex.coarse_height = static_cast<std::uint16_t>(random.next_real(0, 65535));
    const Clearance clear = clearance_of(occluder_of(vertices, n), vertices, n);
    EXPECT_LE(clear.above, 1e-3F);
    EXPECT_LE(clear.below, 1e-3F) << "and touch it";
    EXPECT_LE(clearance_of(occluder_of(vertices, n, 1.5F), vertices, n).above, -1.5F + 1e-3F);
  }
}

TEST(GroundOccluder, OfAsManyPointsAsVerticesIsTheGroundItself) {
  core::RandomStream random(7, 0, 0, 0, core::Purpose::kStructure);
  const auto vertices = mesh_of_heights(22, [&](auto, auto) { return random.next_real(0, 65535); });
  const GroundOccluder occluder = occluder_of(vertices, 22);
  for (std::size_t i = 0; i < 22 * 22; ++i)
    EXPECT_FLOAT_EQ(occluder.height_m[i], metres(vertices[i].height));
}

TEST(GroundOccluder, OfARidgeHidesOnlyTheBoxesBehindIt) {
  const auto vertices = mesh_of_heights(22, [](auto, auto z) { return z == 6 ? 60000 : 20000; });
  const GroundOccluder occluder = ground_occluder(vertices, grid_of(22), 0, kRangeM, 0.0F);
  visibility::Horizon horizon;
  // North of the camera, which is 80 m up; the ridge is 183 m high and 343 m away.
  add_lines(occluder, glm::vec3(-100, -80, -400), 200, horizon);
  EXPECT_TRUE(horizon.hides({{-20, -80, -900}, {20, 230, -800}}));
  EXPECT_FALSE(horizon.hides({{-20, -80, -900}, {20, 250, -800}}));
  EXPECT_FALSE(horizon.hides({{-20, -80, -250}, {20, 200, -240}}));
  EXPECT_FALSE(horizon.hides({{-20, -80, 800}, {20, 20, 900}}));
}

TEST(GroundOccluder, HoldsForBothShapesOfMorphingGround) {
  auto vertices = mesh_of_heights(22, [](auto, auto) { return 40000; });
  for (core::TerrainVertex& vertex : vertices)
    vertex.coarse_height = 30000;
  const GroundOccluder falls = occluder_of(vertices, 22);
  for (core::TerrainVertex& vertex : vertices)
    vertex.coarse_height = 50000;
  const GroundOccluder rises = occluder_of(vertices, 22);
  EXPECT_FLOAT_EQ(falls.height_m[100], metres(30000));
  EXPECT_FLOAT_EQ(falls.top_m[4], metres(40000));
  EXPECT_FLOAT_EQ(rises.height_m[100], metres(40000));
  EXPECT_FLOAT_EQ(rises.top_m[4], metres(50000));
}

TEST(GroundOccluder, KnowsTheHeightOfEachTile) {
  for (const std::size_t n : kSides) {
    const models::TerrainGrid grid = grid_of(n);
    const int side = grid.tiles_per_side();
    for (int tile = 0; tile < side * side; ++tile) {
      const int column = tile % side, row = tile / side;
      const auto vertices = mesh_of_heights(n, [&](std::size_t x, std::size_t z) {
        return static_cast<int>(x) == grid.tile_line(column) + 1 &&
                       static_cast<int>(z) == grid.tile_line(row) + 1
                   ? 60000
                   : 10000;
      });
      const GroundOccluder occluder = occluder_of(vertices, n);
      EXPECT_FLOAT_EQ(occluder.top_m[static_cast<std::size_t>(tile)], metres(60000)) << n;
    }
  }
}

}  // namespace
}  // namespace psygen::scene
