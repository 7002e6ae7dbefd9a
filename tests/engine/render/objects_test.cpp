// Objects of a game on every path, with every preset: they look like models, but turned, scaled and
// with materials.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/engine/render/on_a_path.hpp"
#include "tests/golden_image.hpp"

namespace psygen::render {
namespace {

using Quaternion = std::array<float, 4>;

Quaternion about(int axis, float radians) {
  Quaternion q{0, 0, 0, std::cos(radians / 2)};
  q[static_cast<std::size_t>(axis)] = std::sin(radians / 2);
  return q;
}

class Objects : public OnAPath {
 protected:
  void SetUp() override {
    OnAPath::SetUp();
    if (!renderer_) return;
    const auto model = synthetic::make_box(renderer_->geometry(), kAlbedo);
    const auto object = synthetic::make_object_box(renderer_->geometry(), kAlbedo);
    ASSERT_TRUE(model && object);
    model_.range = *model;
    object_.range = *object;
    model_.origin = object_.origin = {0.4F, -1, -12};
    input_ = synthetic::look(60, 0, kSize);
    input_.light.cloud_cover = 0;
  }
  Picture draw_models(std::span<const MeshDraw> models) {
    FrameInput input = input_;
    input.models = models;
    return draw(input);
  }
  Picture draw_objects(std::span<const ObjectDraw> objects) {
    FrameInput input = input_;
    input.objects = objects;
    return draw(input);
  }
  ObjectDraw object(glm::vec3 origin, Quaternion rotation = {0, 0, 0, 1}) const {
    ObjectDraw draw = object_;
    draw.origin = origin;
    draw.rotation = rotation;
    return draw;
  }
  // Black and white squares; the dark ones are see-through.
  TextureId checks() {
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x) {
        const std::uint8_t v = (x / 2 + y / 2) % 2 == 0 ? 255 : 30;
        pixels.insert(pixels.end(), {v, v, v, static_cast<std::uint8_t>(v == 255 ? 255 : 0)});
      }
    }
    const auto added = renderer_->add_texture({8, 8, pixels, true});
    EXPECT_TRUE(added);
    return added.value_or(kNoTexture);
  }
  // Round studs.
  TextureId studs() {
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        const float u = static_cast<float>(x % 16) / 8 - 1, v = static_cast<float>(y % 16) / 8 - 1;
        const float inside = u * u + v * v < 0.8F ? 1.0F : 0.0F;
        const auto part = [](float n) { return static_cast<std::uint8_t>(128 + 127 * n); };
        pixels.insert(pixels.end(), {part(0.8F * u * inside), part(-0.8F * v * inside),
                                     part(inside > 0 ? 0.6F : 1.0F), 255});
      }
    }
    const auto added = renderer_->add_texture({64, 64, pixels, false});
    EXPECT_TRUE(added);
    return added.value_or(kNoTexture);
  }
  MaterialId material(const Material& material) {
    const auto added = renderer_->add_material(material);
    EXPECT_TRUE(added);
    return added.value_or(kPlainMaterial);
  }
  static double difference(const Picture& a, const Picture& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
      sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
    return sum / static_cast<double>(a.rgba.size());
  }

  static constexpr glm::vec3 kAlbedo{0.4F, 0.2F, 0.1F};
  MeshDraw model_;
  ObjectDraw object_;
  FrameInput input_;
};

TEST_P(Objects, LookLikeModelsWhereTheyAreNotTurned) {
  model_.box_half_extent = object_.box_half_extent = {2, 3, 1};
  model_.box_centre = object_.box_centre = {0.5F, 0.25F, -1};
  const Picture expected = draw_models({&model_, 1});
  EXPECT_LT(difference(draw_objects({&object_, 1}), expected), 0.01);
  EXPECT_GT(difference(draw_objects({}), expected), 1);
}

TEST_P(Objects, AreTurnedAndScaledAsTheirBoxSays) {
  model_.box_half_extent = {1, 3, 2};
  model_.box_centre = {0, 1, -0.5F};
  const Picture expected = draw_models({&model_, 1});
  object_.rotation = about(1, std::numbers::pi_v<float> / 2);  // +z to +x, +x to -z
  object_.scale = {2, 3, 0.5F};
  object_.box_half_extent = {1, 1, 2};
  object_.box_centre = {0.25F, 1.0F / 3, 0};
  EXPECT_LT(difference(draw_objects({&object_, 1}), expected), 0.05);
}

TEST_P(Objects, FadeLikeModels) {
  object_.fade = 0.4F;
  ObjectDraw other = object_;
  other.fade = -0.4F;
  const std::array both{object_, other};
  object_.fade = 1;
  EXPECT_EQ(draw_objects(both).rgba, draw_objects({&object_, 1}).rgba);
}

TEST_P(Objects, WithHolesShowWhatIsBehindThem) {
  const TextureId texture = checks();
  object_.box_half_extent = {3, 3, 1};
  object_.material = material({.base_texture = texture});
  const Picture whole = draw_objects({&object_, 1});
  object_.material = material({.min_opacity = 0.5F, .base_texture = texture});
  const Picture holes = draw_objects({&object_, 1});
  EXPECT_GT(difference(holes, whole), 1);
  EXPECT_LT(difference(holes, draw_objects({})), 0.8 * difference(whole, draw_objects({})));
}

TEST_P(Objects, ThatEmitLightAreBrighterThanTheSunMakesThem) {
  const Picture before = draw_objects({&object_, 1});
  object_.material = material({.emissive = {0.5F, 0.5F, 0.5F}});
  const Picture after = draw_objects({&object_, 1});
  int darker = 0, brighter = 0;
  for (std::size_t i = 0; i < before.rgba.size(); ++i) {
    darker += after.rgba[i] < before.rgba[i] ? 1 : 0;
    brighter += after.rgba[i] > before.rgba[i] + 20 ? 1 : 0;
  }
  EXPECT_EQ(darker, 0);
  EXPECT_GT(brighter, 1000);
}

TEST_P(Objects, BehindTheCameraOrAWallChangeNothingAndComeBackAtOnce) {
  ObjectDraw wall = object({0, 0, -8});
  wall.box_half_extent = {8, 8, 0.5F};
  wall.name = 1;
  ObjectDraw small = object({0, 0, -20});
  small.name = 2;
  ObjectDraw behind = object({0, 0, 20});
  behind.name = 3;
  const std::array all{wall, small, behind};
  const Picture expected = draw_objects({&wall, 1});
  EXPECT_EQ(draw_objects(all).rgba, expected.rgba);
  const std::array without{small, behind};
  const Picture seen = draw_objects(without);
  EXPECT_EQ(seen.rgba, draw_objects({&small, 1}).rgba);
  EXPECT_NE(seen.rgba, draw_objects({}).rgba);
  if (renderer_->path() != RenderPath::kGpu) return;
  draw_objects(all);
  draw_objects(all);
  const auto drawn = renderer_->drawn_meshes();
  ASSERT_TRUE(drawn);
  EXPECT_EQ(drawn->size(), 1u) << "only the wall";
}

TEST_P(Objects, SurviveEveryViewAndAChangeOfPreset) {
  const std::array objects{object({-3, 0, -12}), object({3, 0, -12}, about(2, 0.5F))};
  for (View view : {View::kLevels, View::kWireframe, View::kBounds}) {
    input_.view = view;
    EXPECT_NE(draw_objects(objects).rgba, draw_objects({}).rgba);
  }
  input_.view = View::kNormal;
  ASSERT_TRUE(renderer_->set_preset(next_preset(renderer_->preset())));
  EXPECT_NE(draw_objects(objects).rgba, draw_objects({}).rgba);
}

TEST_P(Objects, OfAllKindsLookAsTheyDid) {
  const TextureId pattern = checks(), relief = studs();
  std::vector<ObjectDraw> objects{object({-5, 1, -14}, about(1, 0.6F)),
                                  object({-1.6F, 1, -14}, about(1, 0.6F)),
                                  object({1.6F, 1, -14}, about(1, 0.6F)),
                                  object({5, 1, -14}, about(1, 0.6F)), object({0, -2, -12})};
  for (ObjectDraw& draw : objects)
    draw.box_half_extent = {1.3F, 1.3F, 1.3F};
  objects[0].material = material({.base_colour = {1, 2, 1}});
  objects[1].material = material({.base_texture = pattern, .normal_texture = relief});
  objects[2].material = material({.min_opacity = 0.5F, .base_texture = pattern});
  objects[3].material = material({.emissive = {2, 1, 0.2F}, .emissive_texture = pattern});
  objects[4].box_half_extent = {7, 0.2F, 5};
  objects[4].box_centre = {0, -0.2F, -2};
  input_.pose.pitch = -0.12;
  input_.pose.position.local.y = 20;
  for (ObjectDraw& draw : objects)
    draw.origin.y -= 1;
  const Picture picture = draw_objects(objects);
  const image::Image image{picture.width, picture.height, picture.rgba};
  const std::string name = "objects_" + std::string(to_string(renderer_->preset()));
  expect_golden("tests/engine/render/golden", name, image);
}

INSTANTIATE_TEST_SUITE_P(OnEveryPath, Objects, in_every_way());

}  // namespace
}  // namespace psygen::render
