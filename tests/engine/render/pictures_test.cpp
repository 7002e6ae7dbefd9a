// Pictures of models: the view is that of the side from which one looks, turned as the vertices
// say; what is transparent is left out; meshes without pictures look as always; on every path.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "tests/engine/render/on_a_path.hpp"

namespace psygen::render {
namespace {

constexpr float kAwayM = 25;
constexpr float kModelHalfWidthM = 4, kModelHalfHeightM = 5;
constexpr std::array<std::array<std::uint8_t, 3>, 3> kColours{
    {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}}};

// The upper half is transparent. View k has the colour k % 3 of kColours.
core::ImpostorTexture striped_picture() {
  core::ImpostorTexture picture(core::impostor_bytes());
  std::size_t at = 0;
  for (std::uint32_t level = 0; level < core::kImpostorLevels; ++level) {
    const std::size_t side = core::kImpostorSide >> level;
    for (std::uint32_t view = 0; view < core::kImpostorViews; ++view) {
      for (std::size_t texel = 0; texel < side * side; ++texel, at += 4) {
        for (std::size_t c = 0; c < 3; ++c)
          picture[at + c] = kColours[view % 3][c];
        picture[at + 3] = texel / side < side / 2 ? 0 : 255;
      }
    }
  }
  return picture;
}

// A quad that shows picture `number`, turned by `turn` views.
core::Result<core::GeometryRange> make_quad(core::GeometryMemory& memory, int number, int turn) {
  const auto reserved = memory.reserve(core::VertexLayout::kModel, 4, 6);
  if (!reserved) return tl::unexpected(reserved.error());
  std::array<core::ModelVertex, 4> vertices{};
  for (std::size_t i = 0; i < 4; ++i) {
    const bool right = i == 1 || i == 2, top = i >= 2;
    core::ModelVertex& v = vertices[i];
    v.position[1] = top ? 32767 : -32767;
    const float aside = (right ? kModelHalfWidthM : -kModelHalfWidthM) / core::kBillboardReachM;
    v.normal[0] = static_cast<std::int16_t>(std::lround(aside * 32767));
    v.ambient = 255;
    v.colour[0] = static_cast<std::uint8_t>(number * 8 + turn);
    v.colour[1] = right ? 255 : 0;
    v.colour[2] = top ? 0 : 255;
    v.material = core::kBillboardBit | core::kImpostorBit | 1;
  }
  const std::array<std::uint16_t, 6> indices{0, 1, 2, 0, 2, 3};
  std::memcpy(reserved->vertices.data(), vertices.data(), sizeof vertices);
  std::memcpy(reserved->indices.data(), indices.data(), sizeof indices);
  memory.commit(reserved->range);
  return reserved->range;
}

struct Counted {
  std::array<int, 3> of{};  // pixels of each of kColours
  int top = INT32_MAX, bottom = -1;
  int colour() const {
    return static_cast<int>(std::max_element(of.begin(), of.end()) - of.begin());
  }
  int sum() const { return of[0] + of[1] + of[2]; }
};

class Pictures : public OnAPath {
 protected:
  void SetUp() override {
    OnAPath::SetUp();
    if (!renderer_) return;
    const std::array all{core::ImpostorTexture(core::impostor_bytes()), striped_picture()};
    ASSERT_TRUE(renderer_->set_model_pictures(all));
  }
  MeshDraw quad(int number, int turn) {
    const auto range = make_quad(renderer_->geometry(), number, turn);
    EXPECT_TRUE(range);
    MeshDraw draw;
    draw.range = *range;
    draw.box_half_extent = {kModelHalfWidthM, kModelHalfHeightM, kModelHalfWidthM};
    draw.pictured = true;
    return draw;
  }
  // Of each pixel the number of its colour of kColours; -1: none of them.
  std::vector<int> colours(const MeshDraw& draw, double yaw, float lift_m = 0) {
    MeshDraw placed = draw;
    placed.origin = kAwayM * core::forward_of({{}, yaw, 0}) + glm::vec3(0, lift_m, 0);
    FrameInput input = synthetic::look(60, 0, kSize);
    input.pose.yaw = yaw;
    input.light.cloud_cover = 0;
    input.light.haze_density = 0;
    const std::array models{placed};
    input.models = models;
    const Picture picture = this->draw(input);
    std::vector<int> found(picture.rgba.size() / 4, -1);
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
      for (std::size_t c = 0; c < 3; ++c) {
        const int own = picture.rgba[i + c];
        if (own >= 100 && own >= 3 * picture.rgba[i + (c + 1) % 3] &&
            own >= 3 * picture.rgba[i + (c + 2) % 3])
          found[i / 4] = static_cast<int>(c);
      }
    }
    return found;
  }
  Counted seen(const MeshDraw& draw, double yaw) {
    const std::vector<int> found = colours(draw, yaw);
    Counted counted;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i] < 0) continue;
      const int y = static_cast<int>(i / kSize.width);
      ++counted.of[static_cast<std::size_t>(found[i])];
      counted.top = std::min(counted.top, y);
      counted.bottom = std::max(counted.bottom, y);
    }
    return counted;
  }
};

// The number of the view of a viewer who looks in this direction.
int view_of(double yaw) {
  const glm::vec3 ahead = core::forward_of({{}, yaw, 0});
  const double turns = std::atan2(ahead.z, ahead.x) / (2 * std::numbers::pi) * 8;
  return static_cast<int>(std::lround(turns) + 8) % 8;
}

TEST_P(Pictures, ShowTheViewOfTheSideFromWhichOneLooks) {
  for (const int turn : {0, 1, 5}) {
    const MeshDraw draw = quad(1, turn);
    for (const double yaw : {0.0, 0.25, 0.785, 1.57, 2.4, 3.14, -0.785, -1.7}) {
      const Counted counted = seen(draw, yaw);
      EXPECT_GT(counted.sum(), 250) << yaw;
      EXPECT_EQ(counted.colour(), (view_of(yaw) + turn) % 8 % 3) << yaw << " turned by " << turn;
      EXPECT_GT(counted.of[static_cast<std::size_t>(counted.colour())], 0.95 * counted.sum())
          << yaw;
    }
  }
}

// In the middle between two views half of the spots are of each. Seen some rows higher, the picture
// is the same some rows higher.
TEST_P(Pictures, MixTwoViewsInSpotsThatMoveWithThePicture) {
  const MeshDraw draw = quad(1, 0);
  const double yaw = std::atan2(-3.0, -1.0);  // along (3, 1): view 0.5
  const float tangent = std::tan(synthetic::look(60, 0, kSize).projection.vertical_fov / 2);
  const float row_m = 2 * tangent * kAwayM / static_cast<float>(kSize.height);
  constexpr std::size_t kRows = 3;
  const std::vector<int> low = colours(draw, yaw), high = colours(draw, yaw, kRows * row_m);
  int both = 0, same = 0, first = 0;
  for (std::size_t i = kRows * kSize.width; i < low.size(); ++i) {
    const int above = high[i - kRows * kSize.width];
    if (low[i] < 0 || above < 0) continue;
    ++both;
    same += low[i] == above ? 1 : 0;
    first += low[i] == 0 ? 1 : 0;
  }
  ASSERT_GT(both, 250);
  EXPECT_NEAR(first, both / 2, both / 8);
  EXPECT_GT(same, 0.9 * both);
}

TEST_P(Pictures, LeaveOutTransparentPixels) {
  const Counted half = seen(quad(1, 0), 0);
  EXPECT_NEAR(half.top, kSize.height / 2, 2);  // the camera is as high as the middle
  EXPECT_GT(half.bottom, half.top + 10);
  EXPECT_EQ(seen(quad(0, 0), 0).sum(), 0);
}

TEST_P(Pictures, CanBeReplaced) {
  core::ImpostorTexture blue(core::impostor_bytes());
  for (std::size_t i = 0; i < blue.size(); i += 4)
    blue[i + 2] = blue[i + 3] = 255;
  ASSERT_TRUE(renderer_->set_model_picture(0, blue));
  const Counted counted = seen(quad(0, 3), 0);
  EXPECT_GT(counted.of[2], 500);
  EXPECT_EQ(counted.of[2], counted.sum());
}

TEST_P(Pictures, LeaveOtherMeshesAsTheyAre) {
  const auto box = synthetic::make_box(renderer_->geometry(), {0.8F, 0.1F, 0.1F});
  ASSERT_TRUE(box);
  MeshDraw draw;
  draw.range = *box;
  draw.origin = {0, 0, -12};
  FrameInput input = synthetic::look(60, 0, kSize);
  const std::array whole{draw};
  input.models = whole;
  const Picture plain = this->draw(input);
  std::array pictured{draw};
  pictured[0].pictured = true;
  input.models = pictured;
  const Picture same = this->draw(input);
  int largest = 0;
  for (std::size_t i = 0; i < plain.rgba.size(); ++i)
    largest = std::max(largest, std::abs(int{plain.rgba[i]} - int{same.rgba[i]}));
  EXPECT_LE(largest, 2);
}

TEST_P(Pictures, FadeLikeOtherMeshes) {
  const MeshDraw draw = quad(1, 0);
  MeshDraw fading = draw;
  fading.fade = 0.5F;
  EXPECT_NEAR(seen(fading, 0).sum(), seen(draw, 0).sum() / 2, 0.1 * seen(draw, 0).sum());
}

TEST_P(Pictures, AreAllReplacedByOthersMoreOrFewer) {
  for (const std::size_t count : {5U, 1U, 0U, 2U}) {
    const std::vector<core::ImpostorTexture> all(count, striped_picture());
    ASSERT_TRUE(renderer_->set_model_pictures(all));
    EXPECT_EQ(renderer_->texture_bytes(), count * core::impostor_bytes());
    if (count == 0) continue;
    EXPECT_GT(seen(quad(static_cast<int>(count) - 1, 0), 0).sum(), 250);
  }
}

TEST_P(Pictures, StayWithAnotherPreset) {
  const Preset other = renderer_->preset() == Preset::kLow ? Preset::kHigh : Preset::kLow;
  ASSERT_TRUE(renderer_->set_preset(other));
  EXPECT_GT(seen(quad(1, 0), 0).sum(), 250);
}

TEST_P(Pictures, RefusedOnesLeaveTheOthers) {
  const std::vector<core::ImpostorTexture> many(core::kMaxImpostors + 1,
                                                core::ImpostorTexture(core::impostor_bytes()));
  const auto refused = renderer_->set_model_pictures(many);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::ErrorCode::kOverBudget);
  const std::vector<core::ImpostorTexture> cut(1, core::ImpostorTexture(7));
  EXPECT_FALSE(renderer_->set_model_pictures(cut));
  EXPECT_FALSE(renderer_->set_model_picture(2, striped_picture()));
  EXPECT_FALSE(renderer_->set_model_picture(0, core::ImpostorTexture(7)));
  EXPECT_GT(seen(quad(1, 0), 0).sum(), 250);
}

INSTANTIATE_TEST_SUITE_P(OnEveryPath, Pictures, in_every_way());

}  // namespace
}  // namespace psygen::render
