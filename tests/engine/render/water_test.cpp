// Water over a beach that falls away from the camera: its depth shows, foam lies along its edge,
// and the sun's path of glitter looks as if it were found for each pixel. A cliff behind the water
// is mirrored in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include "engine/image/image_io.hpp"
#include "engine/render/preset.hpp"
#include "tests/engine/render/synthetic_scene.hpp"

namespace psygen::render {
namespace {

using synthetic::kGroundSide;
using synthetic::kPictureSize;

// The ground is 4 m above the water below the camera and 12 m under it 64 m ahead; the edge of the
// water is 16 m ahead.
class WaterOfPresets : public testing::TestWithParam<Preset> {
 protected:
  std::unique_ptr<Renderer> open(Preset preset) {
    auto made = synthetic::open_renderer(preset);
    EXPECT_TRUE(made) << made.error().message;
    if (!made) return nullptr;
    const auto grid = (*made)->upload_shared_indices(synthetic::grid_indices(kGroundSide));
    const auto beach = synthetic::make_terrain(
        (*made)->geometry(), kGroundSide, [](int, int z) { return static_cast<float>(z) / 64.0F; });
    EXPECT_TRUE(grid && beach);
    if (!grid || !beach) return nullptr;
    terrain_.range = *beach;
    terrain_.shared_indices = *grid;
    return std::move(*made);
  }
  void SetUp() override {
    terrain_.origin = {-32.0F, -32.0F, -64.0F};
    terrain_.height_range_m = 16.0F;
    terrain_.near = true;
    input_ = synthetic::look(20.0, -0.9, kPictureSize);
    input_.terrain = {&terrain_, 1};
    input_.block_size_m = 64;
    input_.light.haze_density = 0.0F;
    input_.water = WaterPlane{0.0F, {0.012F, 0.040F, 0.052F}};
  }
  image::Image draw(Renderer& renderer) {
    const auto drawn = renderer.render(input_);
    EXPECT_TRUE(drawn) << drawn.error().message;
    auto picture = renderer.capture();
    EXPECT_TRUE(picture);
    renderer.wait_idle();
    for (const std::string& message : renderer.validation_messages())
      ADD_FAILURE() << message;
    if (!picture) return {};
    return {picture->width, picture->height, std::move(picture->rgba)};
  }
  // Red, green and blue of the middle third of a row.
  static double row(const image::Image& image, std::uint32_t y) {
    double sum = 0;
    for (std::uint32_t x = image.width / 3; x < 2 * image.width / 3; ++x) {
      for (std::size_t c = 0; c < 3; ++c)
        sum += image.rgba[(std::size_t{y} * image.width + x) * 4 + c];
    }
    return sum / (image.width / 3);
  }
  // The row of the picture in which the plane of the water is so many metres ahead.
  std::uint32_t row_ahead(double metres) const {
    const double below = std::atan2(20.0, metres) + input_.pose.pitch;
    const double y = std::tan(below) / std::tan(input_.projection.vertical_fov * 0.5);
    return static_cast<std::uint32_t>(
        std::clamp((0.5 + 0.5 * y) * kPictureSize.height, 0.0, kPictureSize.height - 1.0));
  }

  TerrainDraw terrain_;
  FrameInput input_;
};

TEST_P(WaterOfPresets, ShowsItsDepthAndOverDeepGroundNone) {
  const auto renderer = open(GetParam());
  ASSERT_TRUE(renderer);
  const image::Image beach = draw(*renderer);
  input_.terrain = {};
  const image::Image open_water = draw(*renderer);
  // With light per vertex the ground is darker here, and shows nearer to the shore.
  const std::uint32_t shallow = row_ahead(traits_of(GetParam()).pixel_light ? 20 : 18);
  const std::uint32_t deep = row_ahead(45);
  EXPECT_GT(row(beach, shallow), row(open_water, shallow) + 20);
  EXPECT_NEAR(row(beach, deep), row(open_water, deep), 6);
}

// A river or lake over the beach instead of the sea: a sheet at the height of the camera's foot.
class SurfacesOfPresets : public WaterOfPresets {
 protected:
  // Covers 64 m × 64 m ahead, at height 0, with this depth along z: 0 near the camera.
  std::optional<MeshDraw> sheet(Renderer& renderer, double deepest_m, double foam) {
    constexpr int kSide = 9;
    const auto reserved = renderer.geometry().reserve(core::VertexLayout::kModel, kSide * kSide,
                                                      (kSide - 1) * (kSide - 1) * 6);
    if (!reserved) return std::nullopt;
    std::vector<core::WaterVertex> vertices;
    std::vector<std::uint16_t> indices;
    for (int z = 0; z < kSide; ++z) {
      for (int x = 0; x < kSide; ++x) {
        core::WaterVertex v;
        const auto place = [](int i) {
          return static_cast<std::int16_t>(std::lround(32767.0 * (2.0 * i / (kSide - 1) - 1)));
        };
        v.position[0] = place(x), v.position[2] = place(z);
        const double depth_m = deepest_m * (1.0 - z / (kSide - 1.0));
        v.depth = static_cast<std::uint8_t>(
            std::lround(255 * std::sqrt(depth_m / double{core::kWaterVertexDepthM})));
        v.foam = static_cast<std::uint8_t>(std::lround(255 * foam));
        v.flow[0] = 8000;
        vertices.push_back(v);
      }
    }
    for (int z = 0; z + 1 < kSide; ++z) {
      for (int x = 0; x + 1 < kSide; ++x) {
        const int a = z * kSide + x;
        for (const int i : {a, a + kSide, a + 1, a + 1, a + kSide, a + kSide + 1})
          indices.push_back(static_cast<std::uint16_t>(i));
      }
    }
    std::memcpy(reserved->vertices.data(), vertices.data(), reserved->vertices.size());
    std::copy(indices.begin(), indices.end(), reserved->indices.begin());
    renderer.geometry().commit(reserved->range);
    MeshDraw draw;
    draw.range = reserved->range;
    draw.origin = {0.0F, -20.0F, -44.0F};
    draw.box_half_extent = {32.0F, 0.0F, 32.0F};
    return draw;
  }
};

TEST_P(SurfacesOfPresets, HideDeepGroundShowShallowGroundAndLieBehindHighGround) {
  const auto renderer = open(GetParam());
  ASSERT_TRUE(renderer);
  input_.water_colour = input_.water->colour;
  input_.water.reset();
  const image::Image dry = draw(*renderer);
  const auto deep = sheet(*renderer, 12, 0), shallow = sheet(*renderer, 0, 0);
  ASSERT_TRUE(deep && shallow);
  input_.water_surfaces = {&*deep, 1};
  const image::Image over_deep = draw(*renderer);
  input_.water_surfaces = {&*shallow, 1};
  const image::Image over_shallow = draw(*renderer);
  const std::uint32_t far = row_ahead(45), before_edge = row_ahead(13);
  EXPECT_LT(row(over_deep, far), 0.75 * row(dry, far));
  EXPECT_NEAR(row(over_shallow, far), row(dry, far), 0.3 * row(dry, far));
  EXPECT_GT(row(over_shallow, far), row(over_deep, far) + 20);
  // Ground above the surface hides it.
  EXPECT_NEAR(row(over_deep, before_edge), row(dry, before_edge), 1);
}

TEST_P(SurfacesOfPresets, FoamIsBright) {
  const auto renderer = open(GetParam());
  ASSERT_TRUE(renderer);
  input_.water.reset();
  const auto calm = sheet(*renderer, 12, 0), rapid = sheet(*renderer, 12, 1);
  ASSERT_TRUE(calm && rapid);
  input_.water_surfaces = {&*calm, 1};
  const image::Image without = draw(*renderer);
  input_.water_surfaces = {&*rapid, 1};
  EXPECT_GT(row(draw(*renderer), row_ahead(40)), row(without, row_ahead(40)) + 60);
}

INSTANTIATE_TEST_SUITE_P(Presets, SurfacesOfPresets,
                         testing::Values(Preset::kLow, Preset::kMedium, Preset::kHigh,
                                         Preset::kUltra),
                         [](const auto& of) { return std::string(to_string(of.param)); });

TEST_P(WaterOfPresets, HasFoamAlongItsEdge) {
  const auto renderer = open(GetParam());
  ASSERT_TRUE(renderer);
  const image::Image beach = draw(*renderer);
  double at_edge = 0, beyond = 0;
  for (std::uint32_t y = 0; y <= row_ahead(20); ++y)
    beyond = std::max(beyond, row(beach, y));
  for (std::uint32_t y = row_ahead(18); y <= row_ahead(15); ++y)
    at_edge = std::max(at_edge, row(beach, y));
  EXPECT_GT(at_edge, 1.8 * beyond);
}

// Haze is that of the way to the water, not to what lies deep under it.
TEST_P(WaterOfPresets, HidesDeepGroundInHazeToo) {
  const auto renderer = open(GetParam());
  ASSERT_TRUE(renderer);
  input_.light.haze_density = 0.01F;
  const image::Image beach = draw(*renderer);
  input_.terrain = {};
  const image::Image open_water = draw(*renderer);
  for (const double metres : {35.0, 45.0})
    EXPECT_NEAR(row(beach, row_ahead(metres)), row(open_water, row_ahead(metres)), 6);
}

// The cliff is 56 m ahead and 20 m high. The water is 12 m deep before it. At half of the
// resolution the mirrored picture is smaller than its image.
TEST_P(WaterOfPresets, MirrorsACliffWhereItHasWaves) {
  const auto renderer = open(GetParam());
  ASSERT_TRUE(renderer);
  const auto cliff = synthetic::make_terrain(renderer->geometry(), kGroundSide,
                                             [](int, int z) { return z < 8 ? 1.0F : 0.0F; });
  ASSERT_TRUE(cliff);
  const float height = 6.0F;
  input_ = synthetic::look(height, -0.15, kPictureSize);
  input_.block_size_m = 64;
  input_.light.haze_density = 0.0F;
  input_.water = WaterPlane{0.0F, {0.012F, 0.040F, 0.052F}};
  terrain_.range = *cliff;
  terrain_.origin = {-32.0F, -height - 12.0F, -64.0F};
  terrain_.height_range_m = 32.0F;
  const auto row_of_water = [&](double metres) {
    const double below = std::atan2(height, metres) + input_.pose.pitch;
    const double y = std::tan(below) / std::tan(input_.projection.vertical_fov * 0.5);
    return static_cast<std::uint32_t>((0.5 + 0.5 * y) * kPictureSize.height);
  };
  for (const float resolution : {1.0F, 0.5F}) {
    input_.resolution = resolution;
    input_.terrain = {};
    const image::Image open_water = draw(*renderer);
    input_.terrain = {&terrain_, 1};
    const image::Image with_cliff = draw(*renderer);
    const double sky = row(open_water, row_of_water(45));
    const double land = row(with_cliff, row_of_water(45));
    if (traits_of(GetParam()).waves) {
      EXPECT_LT(land, 0.8 * sky) << resolution;
      continue;
    }
    EXPECT_GT(land, sky - 6) << resolution;
    if (traits_of(GetParam()).pixel_light) {
      EXPECT_LT(land, sky + 6) << resolution;
    } else {  // there the foot of the cliff shows: here the ground under the water lies deep
      EXPECT_NEAR(row(with_cliff, row_of_water(18)), row(open_water, row_of_water(18)), 6);
    }
  }
}

// A slab 4 m ahead, above the horizon, hides the place that mirrored rays lead to. They mirror the
// slab, because nothing is known behind it: single ones that mirrored the sky would be bright dots.
TEST_P(WaterOfPresets, MirrorsWhatHidesTheEndOfARay) {
  const auto renderer = open(GetParam());
  ASSERT_TRUE(renderer);
  const auto box = synthetic::make_box(renderer->geometry(), glm::vec3(0.02F));
  ASSERT_TRUE(box);
  MeshDraw slab;
  slab.range = *box;
  slab.origin = {0, 0, -4};
  slab.box_centre = {0, 2.0F, 0};
  slab.box_half_extent = {8, 1.7F, 0.3F};
  input_ = synthetic::look(6.0, -0.15, kPictureSize);
  input_.light.haze_density = 0.0F;
  input_.water = WaterPlane{0.0F, {0.012F, 0.040F, 0.052F}};
  const auto y = (std::atan2(6.0, 45.0) - 0.15) / std::tan(input_.projection.vertical_fov * 0.5);
  const auto at = static_cast<std::uint32_t>((0.5 + 0.5 * y) * kPictureSize.height);
  const image::Image open_water = draw(*renderer);
  input_.models = {&slab, 1};
  const image::Image below_slab = draw(*renderer);
  if (traits_of(GetParam()).waves) {
    EXPECT_LT(row(below_slab, at), 0.8 * row(open_water, at));
  } else {
    EXPECT_NEAR(row(below_slab, at), row(open_water, at), 6);
  }
}

INSTANTIATE_TEST_SUITE_P(All, WaterOfPresets,
                         testing::Values(Preset::kLow, Preset::kMedium, Preset::kHigh,
                                         Preset::kUltra),
                         [](const auto& tested) { return std::string(to_string(tested.param)); });

using GlitterOfWater = WaterOfPresets;

TEST_F(GlitterOfWater, WithLightPerVertexHasTheGlitterOfThatPerPixel) {
  const auto vertices = open(Preset::kLow), pixels = open(Preset::kMedium);
  ASSERT_TRUE(vertices && pixels);
  input_.terrain = {};
  for (const double elevation_deg : {40.0, 24.0, 10.0}) {
    const double e = elevation_deg * 3.14159265 / 180;
    for (const double azimuth : {0.0, 0.3, 0.7}) {
      input_.light.sun_direction = {std::cos(e) * std::sin(azimuth), std::sin(e),
                                    -std::cos(e) * std::cos(azimuth)};
      input_.pose.pitch = -e;
      const image::Image a = draw(*vertices), b = draw(*pixels);
      ASSERT_EQ(a.rgba.size(), b.rgba.size());
      int largest = 0;
      double mean = 0;
      for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        // The sky above, and where it meets the water, have a test of their own.
        if (i / 4 / a.width < row_ahead(1e6) + 2) continue;
        const int apart = std::abs(a.rgba[i] - b.rgba[i]);
        largest = std::max(largest, apart);
        mean += apart / static_cast<double>(a.rgba.size());
      }
      SCOPED_TRACE(testing::Message() << elevation_deg << " deg, " << azimuth);
      EXPECT_LE(largest, 30);
      EXPECT_LE(mean, 2.0);
    }
  }
}

}  // namespace
}  // namespace psygen::render
