// Trees of a glTF file whose leaves are cards with an alpha-cutout texture: near, at all levels,
// and as distant impostors, next to the same trees with full detail everywhere.
#include "tests/engine/app/golden.hpp"
#include "tests/engine/handmade/shapes.hpp"

namespace psygen::app {
namespace {

constexpr core::Extent kGroveSize{480, 200};

constexpr const char* kGrove = R"(format = 1
[world]
name = "a grove"
seed = 4
blocks = [64, 64]
[terrain]
relief_m = 1
[sky]
cloud_cover = 0
[[model]]
name = "cards"
file = "cards.glb"
size_m = 8
levels = 6
[[scatter]]
model = "cards"
count = 7
turn_deg = [0, 360]
scale = [0.8, 1.2]
)";

image::Image grove(bool levels) {
  const TemporaryFolder folder;
  handmade::write_card_tree(folder / "cards.glb");
  std::ofstream(folder / "grove.toml") << kGrove;
  SessionOptions options = short_session();
  options.world_file = folder / "grove.toml";
  options.size = kGroveSize;
  options.scene.view_distance_m = 600;
  options.scene.budget_bytes = 512ull << 20;
  options.scene.levels_of_detail = levels;
  auto session = Session::create(options);
  EXPECT_TRUE(session) << session.error().message;
  if (!session) return {};
  core::CameraPose pose;
  pose.position = {{32, 32}, {30, 6, 30}};
  pose.pitch = -0.05;
  (*session)->scene().settle(pose);
  EXPECT_TRUE((*session)->tick(pose, 1.0 / 60.0));
  EXPECT_THAT((*session)->renderer().validation_messages(), testing::IsEmpty());
  return captured(**session);
}

TEST(GoldenHandmade, CardsOfLeavesHaveTheirOutlineNearAndFar) {
  const image::Image seen = grove(true), full = grove(false);
  ASSERT_EQ(seen.rgba.size(), full.rgba.size());
  image::Image sheet = image::make_image(kGroveSize.width, 2 * kGroveSize.height);
  for (std::uint32_t y = 0; y < kGroveSize.height; ++y) {
    for (std::uint32_t x = 0; x < kGroveSize.width; ++x) {
      std::ranges::copy(seen.pixel(x, y), sheet.pixel(x, y).begin());
      std::ranges::copy(full.pixel(x, y), sheet.pixel(x, y + kGroveSize.height).begin());
    }
  }
  expect_golden("handmade_cards", sheet);
}

}  // namespace
}  // namespace psygen::app
