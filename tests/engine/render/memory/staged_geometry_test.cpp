#include "engine/render/memory/staged_geometry.hpp"

#include <gtest/gtest.h>

#include "engine/render/renderer.hpp"
#include "tests/engine/render/synthetic_scene.hpp"

namespace psygen::render {
namespace {

constexpr core::Extent kStagedSize{120, 90};

// A renderer that writes meshes in one way or the other, and boxes before its camera.
struct Writer {
  std::unique_ptr<Renderer> renderer;
  std::vector<MeshDraw> models;

  void create(Upload upload) {
    RendererOptions options;
    options.validation = true;
    options.size = kStagedSize;
    options.geometry_budget_bytes = 64 << 20;
    options.upload = upload;
    auto made = Renderer::create(options);
    ASSERT_TRUE(made) << made.error().message;
    renderer = std::move(*made);
  }
  void add(float x, glm::vec3 albedo) {
    const auto range = synthetic::make_box(renderer->geometry(), albedo);
    ASSERT_TRUE(range);
    MeshDraw draw;
    draw.range = *range;
    draw.origin = {x, 0, -20};
    draw.box_half_extent = glm::vec3(2);
    models.push_back(draw);
  }
  std::vector<std::uint8_t> picture() {
    FrameInput input = synthetic::look(10.0, 0.0, kStagedSize);
    input.models = models;
    EXPECT_TRUE(renderer->render(input));
    auto made = renderer->capture();
    EXPECT_TRUE(made);
    return made ? made->rgba : std::vector<std::uint8_t>{};
  }
  void end() {
    renderer->wait_idle();
    for (const std::string& message : renderer->validation_messages())
      ADD_FAILURE() << message;
  }
};

class StagedGeometryTest : public testing::Test {
 protected:
  void SetUp() override {
    direct_.create(Upload::kDirect);
    staged_.create(Upload::kStaged);
  }
  void TearDown() override {
    direct_.end();
    staged_.end();
  }
  Writer direct_, staged_;
};

TEST_F(StagedGeometryTest, ShowsMeshesInTheFirstFrameAfterTheyWereCommitted) {
  EXPECT_FALSE(staged_.renderer->geometry().zero_copy());
  EXPECT_TRUE(direct_.renderer->geometry().zero_copy());
  const auto empty = staged_.picture();
  for (int i = 0; i < 5; ++i) {
    for (Writer* side : {&direct_, &staged_})
      side->add(5.0F * static_cast<float>(i - 2), {0.1F * static_cast<float>(i), 0.3F, 0.1F});
    EXPECT_EQ(staged_.picture(), direct_.picture()) << i;
  }
  EXPECT_NE(staged_.picture(), empty);
}

TEST_F(StagedGeometryTest, CopiesMoreInOneFrameThanItsRingHolds) {
  std::uint64_t bytes = 0;
  for (Writer* side : {&direct_, &staged_}) {
    bytes = 0;
    while (bytes < 2 * StagedGeometry::kParts * StagedGeometry::kPartBytes) {
      const auto range = synthetic::make_sheet(side->renderer->geometry(), 200);
      ASSERT_TRUE(range);
      bytes += range->bytes;
      if (bytes % 3 != 0 && side->models.size() > 3) continue;
      MeshDraw draw;
      draw.range = *range;
      draw.origin = {3.0F * static_cast<float>(side->models.size()) - 6.0F, 0, -20};
      side->models.push_back(draw);
    }
    side->add(0, {0.5F, 0.1F, 0.1F});  // the last one in the queue
    side->models.back().origin.z = -10;
  }
  EXPECT_EQ(staged_.picture(), direct_.picture());
}

TEST_F(StagedGeometryTest, DropsMeshesReleasedBeforeTheirCopy) {
  const auto first = synthetic::make_box(staged_.renderer->geometry(), {0.9F, 0.0F, 0.0F});
  ASSERT_TRUE(first);
  staged_.renderer->geometry().release(*first);
  for (Writer* side : {&direct_, &staged_})
    side->add(0, {0.0F, 0.0F, 0.9F});  // takes its place
  EXPECT_EQ(staged_.models[0].range.first_vertex, first->first_vertex);
  EXPECT_EQ(staged_.picture(), direct_.picture());
}

TEST_F(StagedGeometryTest, ReusesPlacesFromFrameToFrame) {
  for (int frame = 0; frame < 30; ++frame) {
    for (Writer* side : {&direct_, &staged_}) {
      if (side->models.size() == 3) {
        side->renderer->geometry().release(side->models.front().range);
        side->models.erase(side->models.begin());
      }
      const float shade = 0.03F * static_cast<float>(frame);
      side->add(static_cast<float>(frame % 5) * 3.0F - 6.0F, {shade, 0.5F, 1.0F - shade});
    }
    ASSERT_EQ(staged_.picture(), direct_.picture()) << frame;
  }
  EXPECT_EQ(staged_.renderer->geometry().vertex_bytes(staged_.models[0].range).size(), 24u * 16);
}

}  // namespace
}  // namespace psygen::render
