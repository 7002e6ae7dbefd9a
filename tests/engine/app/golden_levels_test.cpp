// Images of every change of level of a node: the camera moves away from a position, and the node
// that covers it morphs to the shape of the next coarser node and is replaced by it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/models/terrain/terrain.hpp"
#include "engine/scene/state.hpp"
#include "engine/visibility/quadtree.hpp"
#include "tests/engine/app/golden.hpp"

namespace psygen::app {
namespace {

constexpr core::Extent kSize{240, 135};
constexpr core::BlockCoord kPlace{256, 256};  // a corner of nodes of all levels

class GoldenLevels : public testing::TestWithParam<unsigned> {
 protected:
  void SetUp() override {
    SessionOptions options = short_session();
    options.size = kSize;
    options.scene.view_distance_m = 16000;
    options.scene.budget_bytes = 512ull << 20;
    auto session = Session::create(options);
    ASSERT_TRUE(session) << session.error().message;
    session_ = std::move(*session);
  }

  // Looks at the node of a level at kPlace from this distance to its border.
  core::CameraPose away(unsigned level, double distance_m) {
    const world::World& world = state().facts.world;
    const double block_m = world.block_size_m(),
                 side_m = std::ldexp(block_m, static_cast<int>(level));
    core::CameraPose pose;
    pose.position = core::normalised({kPlace, {side_m / 2, 0, -distance_m}}, block_m);
    const core::WorldPosition& at = pose.position;
    const double ground_m =
        models::ground_height_m(world.terrain, at.block, at.local.x, at.local.z);
    pose.position.local.y = ground_m + 6 + 0.05 * distance_m;
    pose.yaw = std::numbers::pi;
    pose.pitch = -0.1;
    return pose;
  }
  scene::State& state() { return scene::state_of(session_->scene()); }

  // The node of a level at kPlace in the cut of the last frame.
  const visibility::CutNode* node(unsigned level) {
    const visibility::NodeCoord wanted =
        visibility::node_of(kPlace, static_cast<std::uint8_t>(level));
    const auto& nodes = state().view.cut.nodes;
    const auto found = std::ranges::find(nodes, wanted, &visibility::CutNode::node);
    return found == nodes.end() ? nullptr : &*found;
  }

  image::Image seen_from(const core::CameraPose& pose) {
    session_->scene().settle(pose);
    EXPECT_TRUE(session_->tick(pose, 1.0 / 60.0));
    return captured(*session_);
  }

  std::unique_ptr<Session> session_;
};

void put(const image::Image& part, std::uint32_t column, image::Image& sheet) {
  for (std::uint32_t y = 0; y < part.height; ++y) {
    for (std::uint32_t x = 0; x < part.width; ++x)
      std::ranges::copy(part.pixel(x, y), sheet.pixel(column + x, y).begin());
  }
}

// Level 0 is a block whose finest mesh morphs to its coarser one; above it, a node's children morph
// to its shape.
TEST_P(GoldenLevels, TheReplacementOfANodeMatchesTheStoredImages) {
  const unsigned level = GetParam();
  image::Image sheet = image::make_image(4 * kSize.width, kSize.height);
  seen_from(away(level, 10));  // the distances are known after a frame
  ASSERT_LT(level, state().streaming.distances.size());
  const visibility::LevelDistances at = state().streaming.distances[level];
  const double distances_m[] = {at.morph_m, (at.morph_m + at.split_m) / 2, 0.999 * at.split_m,
                                1.001 * at.split_m};
  const double morphs[] = {0, 0.5, 1, 0};
  for (std::uint32_t i = 0; i < 4; ++i) {
    put(seen_from(away(level, distances_m[i])), i * kSize.width, sheet);
    const visibility::CutNode* parent = node(level);
    ASSERT_NE(parent, nullptr);
    const bool fine_block = level == 0;
    if (i == 3) {
      EXPECT_TRUE(parent->leaf && !parent->fine);
      continue;
    }
    EXPECT_TRUE(fine_block ? parent->fine : !parent->leaf);
    const visibility::CutNode* child = fine_block ? parent : parent + 1;
    EXPECT_NEAR(child->morph, morphs[i], 0.02) << distances_m[i] << " m";
  }
  expect_golden("level_" + std::to_string(level), sheet);
  EXPECT_THAT(session_->renderer().validation_messages(), testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Levels, GoldenLevels, testing::Range(0U, 8U));

}  // namespace
}  // namespace psygen::app
