#include "engine/render/overlay.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace psygen::render {
namespace {

TEST(Overlay, lays_nothing_out_for_no_lines) {
  const Overlay overlay;
  std::vector<shaders::OverlayVertex> out(3);
  overlay.lay_out({}, out);
  EXPECT_TRUE(out.empty());
}

TEST(Overlay, makes_one_quad_a_visible_character_and_a_panel_around_them) {
  const Overlay overlay;
  const std::vector<std::string> lines{"12 ms", "frame"};
  std::vector<shaders::OverlayVertex> out;
  overlay.lay_out(lines, out);
  ASSERT_EQ(out.size(), (1u + 4 + 5) * 6);
  const auto inside = [&](const shaders::OverlayVertex& v) {
    return v.place.x >= out[0].place.x && v.place.x <= out[2].place.x &&
           v.place.y >= out[0].place.y && v.place.y <= out[2].place.y;
  };
  EXPECT_TRUE(std::all_of(out.begin(), out.end(), inside));
}

TEST(Overlay, cuts_text_off_instead_of_growing_without_end) {
  const Overlay overlay;
  const std::vector<std::string> lines(100, std::string(1000, 'W'));
  std::vector<shaders::OverlayVertex> out;
  overlay.lay_out(lines, out);
  EXPECT_EQ(out.size(), Overlay::kMaxQuads * 6);
}

TEST(Overlay, takes_bytes_that_are_no_text_without_harm) {
  const Overlay overlay;
  const std::vector<std::string> lines{"\xFF\xC3\x28\x01 ok"};
  std::vector<shaders::OverlayVertex> out;
  overlay.lay_out(lines, out);
  EXPECT_GE(out.size(), 3u * 6);
}

TEST(Overlay, has_an_atlas_with_something_in_it) {
  const Overlay overlay;
  EXPECT_EQ(overlay.atlas().size(),
            std::size_t{overlay.atlas_size().width} * overlay.atlas_size().height);
  const auto texels = overlay.atlas();
  EXPECT_TRUE(
      std::any_of(texels.begin(), texels.end(), [](std::byte b) { return b == std::byte{255}; }));
}

}  // namespace
}  // namespace psygen::render
