#include "engine/world/ground_blends.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/hash.hpp"

namespace psygen::world {
namespace {

// The text of shaders/ground.glsl as C++: GLM has its functions, and the build appends an F to its
// numbers (CMakeLists.txt).
namespace shader {
using glm::clamp, glm::floor, glm::ivec2, glm::mix, glm::smoothstep, glm::uvec2, glm::vec2,
    glm::vec3;
using uint = std::uint32_t;

// The four numbers as the shader names them.
struct Colour {
  vec3 rgb{0.0F};
  float w = 0;
};
struct Frame {
  Colour grass, forest, dry, sand, rock, snow, canopy, ground_colour;
  vec3 snow_line{0.0F}, canopy_place{0.0F};
} frame;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#include "ground.glsl.inl"
#pragma GCC diagnostic pop
}  // namespace shader

// As render/frame/frame_data.cpp fills it.
void set_frame(const Palette& p) {
  const auto f = [](double v) { return static_cast<float>(v); };
  const auto blend = [&](double v) { return std::max(f(v), 1e-3F); };
  shader::frame.grass = {p.grass, f(p.sand_end_m)};
  shader::frame.forest = {p.forest, f(p.dry_start_m)};
  shader::frame.dry = {p.dry, blend(p.dry_blend_m)};
  shader::frame.sand = {p.sand, blend(p.sand_blend_m)};
  shader::frame.rock = {p.rock, f(p.rock_slope_start)};
  shader::frame.snow = {p.snow, std::max(f(p.rock_slope_full), f(p.rock_slope_start) + 1e-3F)};
  shader::frame.snow_line = {f(p.snow_start_m), blend(p.snow_blend_m), blend(p.snow_slope_max)};
  shader::frame.ground_colour.w = 1;
}

// Each kind has its own colour, so a difference in any blend shows.
Palette telling_palette() {
  Palette p;
  p.grass = {1, 0, 0};
  p.forest = {0, 1, 0};
  p.dry = {0, 0, 1};
  p.sand = {1, 1, 0};
  p.rock = {0, 1, 1};
  p.snow = {1, 0, 1};
  p.sand_end_m = 20;
  p.sand_blend_m = 8;
  p.snow_start_m = 150;
  return p;
}

struct Point {
  float height;
  glm::vec3 normal;
  glm::vec2 place;
};

Point random_point(core::RandomStream& random) {
  const auto r = [&](double low, double high) {
    return static_cast<float>(random.next_real(low, high));
  };
  const float steep = r(0, 1.5);
  const glm::vec3 normal = glm::normalize(glm::vec3(steep * r(-1, 1), 1, steep * r(-1, 1)));
  const float height = r(-20, 220), x = r(0, 2048), z = r(0, 2048);
  return {height, normal, {x, z}};
}

TEST(GroundBlends, AreThoseOfTheShader) {
  const Palette palette = telling_palette();
  set_frame(palette);
  const glm::vec3 colours[] = {palette.grass, palette.forest, palette.dry,
                               palette.sand,  palette.rock,   palette.snow};
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kPosition);
  for (int i = 0; i < 20'000; ++i) {
    const Point at = random_point(random);
    const GroundBlends blends = ground_blends(palette, at.height, at.normal, at.place);
    glm::vec3 colour(0.0F);
    for (std::size_t k = 0; k < kGroundKinds; ++k)
      colour = glm::mix(colour, colours[k], blends[k]);
    const glm::vec3 drawn = shader::ground_albedo(at.height, at.normal, at.place, 0.5F, 0.0F);
    ASSERT_LT(glm::length(drawn - colour), 1e-4F) << at.height;
  }
}

TEST(GroundBlends, RoadsAreThoseOfTheShader) {
  const Palette palette = telling_palette();
  set_frame(palette);
  const glm::vec3 colours[] = {palette.grass, palette.forest, palette.dry,
                               palette.sand,  palette.rock,   palette.snow};
  core::RandomStream random(3, 0, 0, 0, core::Purpose::kPosition);
  for (int i = 0; i < 5000; ++i) {
    const Point at = random_point(random);
    const auto road = static_cast<float>(random.next_real(0.001, 1));
    const GroundBlends blends = ground_blends(palette, at.height, at.normal, at.place, road);
    glm::vec3 colour(0.0F);
    for (std::size_t k = 0; k < kGroundKinds; ++k)
      colour = glm::mix(colour, colours[k], blends[k]);
    const glm::vec3 drawn = shader::ground_albedo(at.height, at.normal, at.place, 0.5F, -road);
    ASSERT_LT(glm::length(drawn - colour), 1e-4F) << at.height;
  }
  const glm::vec3 flat{0, 1, 0};
  EXPECT_EQ(main_kind(ground_blends(palette, 60, flat, {7, 9}, 1)), GroundKind::kRock);
}

TEST(GroundBlends, TheMainKindHasTheLargestShare) {
  const Palette palette = telling_palette();
  core::RandomStream random(2, 0, 0, 0, core::Purpose::kPosition);
  std::array<int, kGroundKinds> count{};
  for (int i = 0; i < 5000; ++i) {
    const Point at = random_point(random);
    const GroundBlends blends = ground_blends(palette, at.height, at.normal, at.place);
    std::array<float, kGroundKinds> share{};
    for (std::size_t k = 0; k < kGroundKinds; ++k) {
      for (std::size_t below = 0; below < k; ++below)
        share[below] *= 1 - blends[k];
      share[k] = blends[k];
    }
    const auto kind = static_cast<std::size_t>(main_kind(blends));
    ++count[kind];
    for (const float s : share)
      ASSERT_LE(s, share[kind] + 1e-6F);
  }
  for (const int n : count)
    EXPECT_GT(n, 0);
}

TEST(GroundBlends, TheFirstOfEqualKindsIsTheMainOne) {
  EXPECT_EQ(main_kind({1, 0, 0, 0, 0, 0}), GroundKind::kGrass);
  EXPECT_EQ(main_kind({1, 0.5F, 0, 0, 0, 0}), GroundKind::kGrass);
  EXPECT_EQ(main_kind({1, 1, 1, 1, 1, 1}), GroundKind::kSnow);
}

}  // namespace
}  // namespace psygen::world
