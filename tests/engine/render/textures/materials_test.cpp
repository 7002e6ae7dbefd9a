#include "engine/render/textures/materials.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "engine/render/renderer.hpp"

namespace psygen::render {
namespace {

TEST(MipLevels, HalveDownToOneTexel) {
  const std::vector<std::uint8_t> pixels(5 * 3 * 4, 100);
  const auto levels = mip_levels({5, 3, pixels, true});
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_EQ(levels[0], std::vector<std::uint8_t>(2 * 1 * 4, 100));
  EXPECT_EQ(levels[1], std::vector<std::uint8_t>(4, 100));
}

TEST(MipLevels, MixColoursAsLightAndNumbersAsTheyAre) {
  const std::vector<std::uint8_t> pixels{0, 0, 0, 0, 255, 255, 255, 255};
  const auto colours = mip_levels({2, 1, pixels, true});
  ASSERT_EQ(colours.size(), 1u);
  EXPECT_EQ(colours[0], (std::vector<std::uint8_t>{180, 180, 180, 128}));
  const auto numbers = mip_levels({2, 1, pixels, false});
  EXPECT_EQ(numbers[0], (std::vector<std::uint8_t>{128, 128, 128, 128}));
}

class Materials : public testing::Test {
 protected:
  void SetUp() override {
    RendererOptions options;
    options.validation = true;
    options.size = {32, 32};
    options.geometry_budget_bytes = 8 << 20;
    options.texture_budget_bytes = 4096;
    auto made = Renderer::create(options);
    ASSERT_TRUE(made) << made.error().message;
    renderer_ = std::move(*made);
  }
  void TearDown() override {
    if (!renderer_) return;
    for (const std::string& message : renderer_->validation_messages())
      ADD_FAILURE() << message;
  }
  core::Result<TextureId> add(std::uint32_t width, std::uint32_t height, std::size_t bytes) {
    const std::vector<std::uint8_t> pixels(bytes, 200);
    return renderer_->add_texture({width, height, pixels, true});
  }
  core::ErrorCode code_of(const Material& material) {
    const auto added = renderer_->add_material(material);
    return added ? core::ErrorCode{} : added.error().code;
  }

  std::unique_ptr<Renderer> renderer_;
};

TEST_F(Materials, RejectTexturesWhoseBytesDoNotMatchTheirSize) {
  for (const auto& [width, height, bytes] :
       {std::tuple{0u, 4u, 0u}, {4u, 0u, 0u}, {4u, 4u, 63u}, {9000u, 1u, 36000u}}) {
    const auto added = add(width, height, bytes);
    ASSERT_FALSE(added);
    EXPECT_EQ(added.error().code, core::ErrorCode::kInvalidArgument) << added.error().message;
  }
  EXPECT_EQ(renderer_->texture_bytes(), 0u);
}

TEST_F(Materials, RefuseTexturesBeyondTheBudgetAndKeepTheOthers) {
  ASSERT_TRUE(add(16, 16, 1024));
  const std::uint64_t used = renderer_->texture_bytes();
  EXPECT_GT(used, 1024u);
  const auto added = add(32, 32, 4096);
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, core::ErrorCode::kOverBudget);
  EXPECT_EQ(renderer_->texture_bytes(), used);
  EXPECT_TRUE(add(16, 16, 1024));
}

TEST_F(Materials, RefuseNumbersThatAreNoneAndTexturesThatDoNotExist) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const core::ErrorCode refused = core::ErrorCode::kInvalidArgument;
  EXPECT_EQ(code_of({.base_colour = {1, nan, 1}}), refused);
  EXPECT_EQ(code_of({.emissive = {-1, 0, 0}}), refused);
  EXPECT_EQ(code_of({.opacity = std::numeric_limits<float>::infinity()}), refused);
  EXPECT_EQ(code_of({.base_texture = 7}), refused);
  EXPECT_TRUE(renderer_->add_material({}));
}

TEST_F(Materials, EndAtFourThousand) {
  std::size_t added = 1;  // the plain one
  while (renderer_->add_material({}))
    ++added;
  EXPECT_EQ(added, 4096u);
  EXPECT_EQ(code_of({}), core::ErrorCode::kOverBudget);
}

}  // namespace
}  // namespace psygen::render
