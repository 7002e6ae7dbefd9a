#include "engine/scene/nodes/ground_sunlight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace psygen::scene {
namespace {

// A mesh of n × n vertices with its skirt; the skirt's light does not count.
template <class Share>
std::vector<core::TerrainVertex> lit_mesh(std::size_t n, const Share& share) {
  std::vector<core::TerrainVertex> vertices(n * n + 4 * (n - 1));
  for (core::TerrainVertex& v : vertices)
    v.sun = 77;
  for (std::size_t i = 0; i < n * n; ++i)
    vertices[i].sun = static_cast<std::uint8_t>(share(i % n, i / n));
  return vertices;
}

TEST(GroundSunlight, OfEvenLightIsEven) {
  EXPECT_EQ(sun_at({}, {0.3F, 0.9F}), 1.0F);
  for (const std::size_t n : {2, 5, 16, 17, 64, 128}) {
    const GroundSunlight sun = ground_sunlight(lit_mesh(n, [](auto, auto) { return 51; }), n);
    for (const float x : {-1.0F, 0.0F, 0.01F, 0.5F, 0.99F, 1.0F, 2.0F}) {
      EXPECT_FLOAT_EQ(sun_at(sun, {x, 0.3F}), 0.2F) << n << " " << x;
      EXPECT_FLOAT_EQ(sun_at(sun, {0.3F, x}), 0.2F) << n << " " << x;
      EXPECT_FLOAT_EQ(sun_over(sun, {0.2F, x}, {0.3F, std::max(x, 0.4F)}), 0.2F);
    }
  }
}

TEST(GroundSunlight, FollowsTheVerticesAlongEitherSide) {
  for (const std::size_t n : {16, 22, 64, 128}) {
    const float last = static_cast<float>(n - 1);
    const auto ramp = [&](std::size_t at) { return 255.0F * static_cast<float>(at) / last; };
    const GroundSunlight along_x =
        ground_sunlight(lit_mesh(n, [&](auto x, auto) { return ramp(x); }), n);
    const GroundSunlight along_z =
        ground_sunlight(lit_mesh(n, [&](auto, auto z) { return ramp(z); }), n);
    for (float place = 0.1F; place < 0.9F; place += 0.037F) {
      // A cell may have no vertex in its middle.
      EXPECT_NEAR(sun_at(along_x, {place, 0.2F}), place, 0.55F / last + 0.002F) << n;
      EXPECT_NEAR(sun_at(along_z, {0.2F, place}), place, 0.55F / last + 0.002F) << n;
    }
    EXPECT_NEAR(sun_over(along_x, {0.0F, 0.4F}, {1.0F, 0.5F}), 0.5, 0.01);
    EXPECT_LT(sun_over(along_x, {0.0F, 0.0F}, {0.2F, 1.0F}), 0.2);
    EXPECT_GT(sun_over(along_x, {0.8F, 0.0F}, {1.0F, 1.0F}), 0.8);
    EXPECT_LT(sun_over(along_z, {0.0F, 0.0F}, {1.0F, 0.2F}), 0.2);
  }
}

TEST(GroundSunlight, AtTheEdgeOfAShadowIsDarkOnOneSide) {
  const GroundSunlight sun =
      ground_sunlight(lit_mesh(64, [](auto x, auto) { return x < 32 ? 0 : 255; }), 64);
  EXPECT_EQ(sun_at(sun, {0.4F, 0.5F}), 0.0F);
  EXPECT_EQ(sun_at(sun, {0.6F, 0.5F}), 1.0F);
  EXPECT_FLOAT_EQ(sun_at(sun, {0.5F, 0.5F}), 0.5F);
}

}  // namespace
}  // namespace psygen::scene
