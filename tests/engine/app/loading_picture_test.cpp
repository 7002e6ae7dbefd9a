#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/app/loading.hpp"

namespace psygen::app {
namespace {

constexpr core::Extent kLoadingSize{1280, 720};

const render::HudText* find(const render::HudDrawing& drawing, std::string_view text) {
  const auto found = std::ranges::find(drawing.texts, text, &render::HudText::text);
  return found == drawing.texts.end() ? nullptr : &*found;
}

TEST(LoadingPicture, ShowsTheWorldTheTaskAndItsProgress) {
  const render::HudDrawing drawing =
      loading_picture("silver combe", "growing", 0.424, kLoadingSize);
  ASSERT_NE(find(drawing, "silver combe"), nullptr);
  ASSERT_NE(find(drawing, "growing"), nullptr);
  EXPECT_NE(find(drawing, "42 %"), nullptr);
  EXPECT_GT(find(drawing, "silver combe")->size_px, 2 * find(drawing, "growing")->size_px);
}

TEST(LoadingPicture, HasABarThatShowsTheProgress) {
  const auto bar = [](double fraction) {
    return loading_picture("w", "l", fraction, kLoadingSize).areas.back().size.share.x;
  };
  EXPECT_EQ(bar(0), 0);
  EXPECT_NEAR(bar(0.5), bar(1) / 2, 1e-6);
  EXPECT_EQ(bar(7), bar(1));
  EXPECT_EQ(bar(-1), 0);
  EXPECT_EQ(bar(std::nan("")), 0);
}

TEST(LoadingPicture, KeepsALongNameInTheImageAndScalesWithItsHeight) {
  std::string name = "\u00C4";
  name.append(120, 'W');
  for (const core::Extent picture : {core::Extent{1280, 720}, {320, 180}, {3840, 2160}}) {
    const render::HudDrawing drawing = loading_picture(name, "l", 0, picture);
    const render::HudText& shown = drawing.texts.front();
    EXPECT_LT(render::measure(shown).x, static_cast<float>(picture.width));
    EXPECT_TRUE(shown.text.ends_with("W\u2026")) << shown.text;
    EXPECT_NEAR(find(drawing, "0 %")->size_px, std::max(11.0, 0.032 * picture.height), 0.1);
  }
}

TEST(LoadingPicture, ShrinksANameBeforeShorteningIt) {
  const std::string name(30, 'W');
  const render::HudDrawing drawing = loading_picture(name, "l", 0, kLoadingSize);
  ASSERT_NE(find(drawing, name), nullptr);
  EXPECT_LT(find(drawing, name)->size_px, 60);
}

TEST(LoadingPicture, HasDifferentHillsForEachWorld) {
  const auto tops = [](std::string_view world) {
    std::vector<float> all;
    for (const render::HudArea& area : loading_picture(world, "l", 0, kLoadingSize).areas)
      all.push_back(area.at.share.y);
    return all;
  };
  EXPECT_EQ(tops("paper"), tops("paper"));
  EXPECT_NE(tops("paper"), tops("lakes"));
}

}  // namespace
}  // namespace psygen::app
