// Meshes come and go while frames are in flight: the budget holds, pictures stay right.
#include <gtest/gtest.h>

#include <random>

#include "tests/engine/render/synthetic_scene.hpp"

namespace psygen::render {
namespace {

TEST(GeometrySoak, UploadsAndReleasesEveryFrameWithoutExceedingTheBudget) {
  RendererOptions options;
  options.validation = true;
  options.size = {64, 48};
  options.geometry_budget_bytes = 256 * 1024;
  auto made = Renderer::create(options);
  ASSERT_TRUE(made) << made.error().message;
  Renderer& renderer = **made;
  core::GeometryMemory& memory = renderer.geometry();
  std::mt19937 random(5);
  std::vector<MeshDraw> held;
  int refused = 0;
  for (int frame = 0; frame < 60; ++frame) {
    for (int i = 0; i < 12; ++i) {
      const auto range = synthetic::make_sheet(memory, 8 + static_cast<int>(random() % 24));
      if (!range) {
        EXPECT_EQ(range.error().code, core::ErrorCode::kOutOfMemory);
        ++refused;
        continue;
      }
      MeshDraw draw;
      draw.range = *range;
      draw.origin = {0, 0, -20};
      held.push_back(draw);
      ASSERT_LE(memory.used_bytes(), memory.capacity_bytes());
    }
    FrameInput input = synthetic::look(0, 0, options.size);
    input.models = held;
    ASSERT_TRUE(renderer.render(input));
    const std::uint64_t before = memory.used_bytes();
    for (std::size_t i = 0; i < held.size();) {
      if (random() % 3 != 0) {
        ++i;
        continue;
      }
      memory.release(held[i].range);
      held[i] = held.back();
      held.pop_back();
    }
    EXPECT_EQ(memory.used_bytes(), before) << "a frame in flight still reads them";
  }
  EXPECT_GT(refused, 0) << "the budget was never reached; the test shows nothing";
  for (const MeshDraw& draw : held)
    memory.release(draw.range);
  renderer.wait_idle();
  EXPECT_EQ(memory.used_bytes(), 0u);
  EXPECT_TRUE(renderer.validation_messages().empty());
}

}  // namespace
}  // namespace psygen::render
