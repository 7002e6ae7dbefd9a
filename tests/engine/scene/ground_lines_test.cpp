#include "engine/scene/ground_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/core/hash.hpp"

namespace psygen::scene {
namespace {

constexpr float kLowM = -20, kRangeM = 200;

// A mesh of n × n vertices and its skirt with these heights, 0 … 65535.
template <class Height>
std::vector<core::TerrainVertex> mesh(std::size_t n, const Height& height) {
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

TEST(GroundLines, OfFlatGroundLieOnIt) {
  for (const std::size_t n : {8u, 20u, 22u, 59u, 64u}) {
    const GroundLines lines =
        ground_lines(mesh(n, [](auto, auto) { return 30000; }), kLowM, kRangeM, 0.0F);
    EXPECT_EQ(lines.lower_by_m, 0.0F);
    EXPECT_EQ(lines.place.front(), 0.0F);
    EXPECT_EQ(lines.place.back(), 1.0F);
    for (const float height_m : lines.height_m)
      EXPECT_FLOAT_EQ(height_m, metres(30000));
  }
}

TEST(GroundLines, AreNowhereAboveTheMeshByMoreThanTheySay) {
  for (const std::size_t n : {8u, 9u, 20u, 21u, 22u, 59u, 64u}) {
    SCOPED_TRACE(testing::Message() << n << " vertices a side");
    core::RandomStream random(7, static_cast<std::uint32_t>(n), 0, 0, core::Purpose::kStructure);
    auto vertices = mesh(n, [&](auto, auto) { return random.next_real(0, 65535); });
    for (core::TerrainVertex& vertex : vertices)
      vertex.coarse_height = static_cast<std::uint16_t>(random.next_real(0, 65535));
    const GroundLines lines = ground_lines(vertices, kLowM, kRangeM, 1.5F);
    EXPECT_GE(lines.lower_by_m, 1.5F);
    const auto cells = static_cast<float>(n - 1);
    float most = -1e9F;
    for (std::size_t line = 0; line < GroundLines::kPoints; ++line) {
      const auto fixed = static_cast<std::size_t>(std::lround(lines.place[line] * cells));
      for (std::size_t i = 0; i + 1 < GroundLines::kPoints; ++i) {
        for (int step = 0; step <= 20; ++step) {
          const float t = static_cast<float>(step) / 20;
          const float at = cells * (lines.place[i] * (1 - t) + lines.place[i + 1] * t);
          const auto& h = lines.height_m;
          const float along_x = h[line * 8 + i] * (1 - t) + h[line * 8 + i + 1] * t;
          const float along_z = h[i * 8 + line] * (1 - t) + h[(i + 1) * 8 + line] * t;
          most = std::max({most, along_x - on_line(vertices, fixed * n, 1, at, n),
                           along_z - on_line(vertices, fixed, n, at, n)});
        }
      }
    }
    EXPECT_LE(most, lines.lower_by_m - 1.5F + 1e-3F);
    if (n > 8) {
      EXPECT_GT(most, 0.5F * (lines.lower_by_m - 1.5F)) << "and not much lower";
    }
  }
}

TEST(GroundLines, OfARidgeHideWhatLiesBehindItAndNothingBesides) {
  const auto vertices = mesh(22, [](auto, auto z) { return z == 6 ? 60000 : 20000; });
  const GroundLines lines = ground_lines(vertices, 0, kRangeM, 0.0F);
  visibility::Horizon horizon;
  // North of the camera, which is 80 m up; the ridge is 183 m high, 81 m of which its
  // lines do not see.
  const glm::vec3 corner(-100, -80, -400);
  add_lines(lines, corner, 200, horizon);
  EXPECT_TRUE(horizon.hides({{-20, -80, -900}, {20, 20, -800}}));
  EXPECT_FALSE(horizon.hides({{-20, -80, -250}, {20, 200, -240}}));
  EXPECT_FALSE(horizon.hides({{-20, -80, 800}, {20, 20, 900}}));
}

TEST(GroundLines, LieBelowBothShapesOfGroundThatMorphs) {
  auto vertices = mesh(22, [](auto, auto) { return 40000; });
  for (core::TerrainVertex& vertex : vertices)
    vertex.coarse_height = 30000;
  for (const float height_m : ground_lines(vertices, kLowM, kRangeM, 0).height_m)
    EXPECT_FLOAT_EQ(height_m, metres(30000));
}

}  // namespace
}  // namespace psygen::scene
