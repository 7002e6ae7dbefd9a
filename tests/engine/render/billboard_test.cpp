// Billboards turn about their axes: they look the same from all sides, and from above one sees how
// far they lean, on every path, with and without light per pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "tests/engine/render/on_a_path.hpp"

namespace psygen::render {
namespace {

constexpr float kLeftM = 2, kRightM = 4, kHalfHeightM = 5, kLeanM = 3;

// A triangle whose corners are all on the axis of its box, wide at its foot, more so to the right,
// bright red.
core::Result<core::GeometryRange> make_tent(core::GeometryMemory& memory) {
  const auto reserved = memory.reserve(core::VertexLayout::kModel, 3, 3);
  if (!reserved) return tl::unexpected(reserved.error());
  const auto in_reach = [](float metres) {
    return static_cast<std::int16_t>(std::lround(metres / core::kBillboardReachM * 32767));
  };
  std::array<core::ModelVertex, 3> vertices{};
  for (std::size_t i = 0; i < 3; ++i) {
    core::ModelVertex& v = vertices[i];
    v.position[1] = i == 2 ? 32767 : -32767;
    v.normal[0] = in_reach(i == 2 ? 0 : i == 0 ? -kLeftM : kRightM);
    v.normal[1] = in_reach(i == 2 ? kLeanM : -kLeanM);
    v.colour[0] = v.ambient = 255;
    v.material = core::kBillboardBit | 1;
    reserved->indices[i] = static_cast<std::uint16_t>(i);
  }
  std::memcpy(reserved->vertices.data(), vertices.data(), sizeof vertices);
  memory.commit(reserved->range);
  return reserved->range;
}

// Where in the picture the red is, in pixels.
struct Seen {
  int count = 0, left = INT32_MAX, right = -1, top = INT32_MAX, bottom = -1;
  std::array<int, 120> in_row{};  // by row of the picture
};

class Billboard : public OnAPath {
 protected:
  void SetUp() override {
    OnAPath::SetUp();
    if (!renderer_) return;
    const auto range = make_tent(renderer_->geometry());
    ASSERT_TRUE(range);
    tent_.range = *range;
    tent_.box_half_extent = {kRightM + kLeanM, kHalfHeightM, kRightM + kLeanM};
  }

  Seen seen_at(glm::vec3 origin, double yaw, double pitch) {
    FrameInput input = synthetic::look(60, pitch, kSize);
    input.pose.yaw = yaw;
    input.light.cloud_cover = 0;
    tent_.origin = origin;
    const std::array models{tent_};
    input.models = models;
    const Picture picture = draw(input);
    Seen seen;
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
      if (picture.rgba[i] < 2 * picture.rgba[i + 1]) continue;
      const int x = static_cast<int>(i / 4 % kSize.width),
                y = static_cast<int>(i / 4 / kSize.width);
      ++seen.count;
      ++seen.in_row[static_cast<std::size_t>(y)];
      seen.left = std::min(seen.left, x);
      seen.right = std::max(seen.right, x);
      seen.top = std::min(seen.top, y);
      seen.bottom = std::max(seen.bottom, y);
    }
    return seen;
  }

  MeshDraw tent_;
};

TEST_P(Billboard, LooksTheSameFromAllSides) {
  const Seen front = seen_at({0, 0, -25}, 0, 0);
  EXPECT_GT(front.count, 300);
  EXPECT_GT(front.right - front.left, 20);
  const int middle = kSize.width / 2;
  EXPECT_NEAR(front.right - middle, kRightM / kLeftM * static_cast<float>(middle - front.left), 3);
  for (const double yaw : {0.6, 1.57, 2.5, -2.0}) {
    const glm::vec3 ahead = core::forward_of({{}, yaw, 0});
    const Seen seen = seen_at(25.0F * ahead, yaw, 0);
    EXPECT_NEAR(seen.count, front.count, 0.03 * front.count) << yaw;
    EXPECT_NEAR(seen.left, front.left, 1) << yaw;
    EXPECT_NEAR(seen.right, front.right, 1) << yaw;
    EXPECT_NEAR(seen.top, front.top, 1) << yaw;
    EXPECT_NEAR(seen.bottom, front.bottom, 1) << yaw;
  }
}

TEST_P(Billboard, LeansAwayFromACameraAbove) {
  const Seen above = seen_at({0, -25, -0.5F}, 0, -std::numbers::pi / 2);
  EXPECT_GT(above.count, 150);
  ASSERT_GT(above.bottom - above.top, 12);
  // The wide end is the lower one, nearer to the feet of who looks.
  const auto row = [&](int y) { return above.in_row[static_cast<std::size_t>(y)]; };
  EXPECT_GT(row(above.bottom - 2), 2 * row(above.top + 2));
}

INSTANTIATE_TEST_SUITE_P(OnEveryPath, Billboard, in_every_way());

}  // namespace
}  // namespace psygen::render
