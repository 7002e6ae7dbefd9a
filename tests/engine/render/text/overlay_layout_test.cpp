#include "engine/render/text/overlay_layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace psygen::render {
namespace {

constexpr core::Extent kPicture{640, 360};

using Vertices = std::vector<shaders::OverlayVertex>;

Vertices lay_out(const std::vector<TextPanel>& panels, core::Extent picture = kPicture,
                 float scale = 1) {
  const OverlayLayout overlay;
  Vertices out;
  overlay.lay_out(panels, picture, scale, out);
  return out;
}

struct Area {
  float x0, y0, x1, y1;
  float width() const { return x1 - x0; }
  float height() const { return y1 - y0; }
};

Area area(const Vertices& out, std::size_t quad) {
  const auto& first = out[6 * quad].place;
  const auto& last = out[6 * quad + 2].place;
  return {first.x, first.y, last.x, last.y};
}

bool all_in(const Vertices& out, const Area& area) {
  return std::ranges::all_of(out, [&](const shaders::OverlayVertex& v) {
    return v.place.x >= area.x0 && v.place.x <= area.x1 && v.place.y >= area.y0 &&
           v.place.y <= area.y1;
  });
}

TEST(OverlayLayout, LaysNothingOutForNoPanelAndForOneWithoutLines) {
  EXPECT_TRUE(lay_out({}).empty());
  EXPECT_TRUE(lay_out({{Anchor::kMiddle, {}}}).empty());
}

TEST(OverlayLayout, MakesOneQuadAVisibleCharacterAndAPanelAroundThem) {
  const Vertices out = lay_out({{Anchor::kTopLeft, {{"12 ms"}, {"frame"}}}});
  ASSERT_EQ(out.size(), (1u + 4 + 5) * 6);
  EXPECT_TRUE(all_in(out, area(out, 0)));
}

TEST(OverlayLayout, AppendsPanelsToItsOutput) {
  Vertices out(6);
  OverlayLayout().lay_out(std::vector<TextPanel>{{Anchor::kTopLeft, {{"12 ms"}}}}, kPicture, 1,
                          out);
  EXPECT_EQ(out.size(), 6 + (1u + 4) * 6);
  EXPECT_EQ(out[0].colour, glm::vec4(0.0F));
  EXPECT_NE(out[6].colour, glm::vec4(0.0F));
}

TEST(OverlayLayout, PutsPanelsWhereTheyBelong) {
  const auto placed = [](Anchor anchor) { return area(lay_out({{anchor, {{"some words"}}}}), 0); };
  EXPECT_LT(placed(Anchor::kTopLeft).x1, 320);
  EXPECT_LT(placed(Anchor::kTopLeft).y1, 180);
  EXPECT_GT(placed(Anchor::kTopRight).x0, 320);
  EXPECT_LT(placed(Anchor::kTopRight).x1, 640);
  EXPECT_EQ(placed(Anchor::kTopRight).y0, placed(Anchor::kTopLeft).y0);
  const Area bottom = placed(Anchor::kBottom), middle = placed(Anchor::kMiddle);
  EXPECT_GT(bottom.y0, 300);
  EXPECT_LT(bottom.y1, 360);
  EXPECT_NEAR((bottom.x0 + bottom.x1) / 2, 320, 1);
  EXPECT_NEAR((middle.x0 + middle.x1) / 2, 320, 1);
  EXPECT_NEAR((middle.y0 + middle.y1) / 2, 180, 1);
}

TEST(OverlayLayout, GoesOnInTheNextRowWhereThePictureIsTooNarrow) {
  const std::string sentence = "a sentence of words that is longer than a narrow picture is wide";
  const auto letters =
      static_cast<std::size_t>(std::ranges::count_if(sentence, [](char c) { return c != ' '; }));
  for (const core::Extent picture : {core::Extent{160, 360}, {200, 360}, {640, 360}}) {
    const Vertices out = lay_out({{Anchor::kTopLeft, {{sentence}}}}, picture);
    EXPECT_EQ(out.size(), (1 + letters) * 6) << picture.width;
    EXPECT_TRUE(all_in(out, {0, 0, static_cast<float>(picture.width), 360})) << picture.width;
  }
  EXPECT_GT(area(lay_out({{Anchor::kTopLeft, {{sentence}}}}, {200, 360}), 0).height(),
            area(lay_out({{Anchor::kTopLeft, {{sentence}}}}), 0).height() + 20);
  const Vertices word = lay_out({{Anchor::kBottom, {{std::string(200, 'x')}}}}, {200, 360});
  EXPECT_EQ(word.size(), 201u * 6);
  EXPECT_TRUE(all_in(word, {0, 0, 200, 360}));
}

TEST(OverlayLayout, PutsAPanelOnTheRightBelowOneOnTheLeftThatItWouldCover) {
  const std::vector<TextPanel> panels{{Anchor::kTopLeft, {{std::string(50, 'x')}}},
                                      {Anchor::kTopRight, {{std::string(30, 'y')}}}};
  const Vertices wide = lay_out(panels, {1280, 720}), narrow = lay_out(panels, {480, 360});
  EXPECT_EQ(area(wide, 51).y0, area(wide, 0).y0);
  EXPECT_GT(area(narrow, 51).y0, area(narrow, 0).y1);
}

TEST(OverlayLayout, DrawsSwatchesInTheirColourAndBarsAsLongAsTheyAre) {
  const Vertices swatch = lay_out({{Anchor::kTopLeft, {{"", 0x3366CC}}}});
  ASSERT_EQ(swatch.size(), 3u * 6);
  EXPECT_NEAR(swatch.back().colour.x, 0.2F, 1e-5F);
  EXPECT_NEAR(swatch.back().colour.y, 0.4F, 1e-5F);
  EXPECT_NEAR(swatch.back().colour.z, 0.8F, 1e-5F);
  for (const float done : {-1.0F, 0.0F, 0.25F, 1.0F, 7.0F, NAN}) {
    const Vertices bar = lay_out({{Anchor::kMiddle, {{"", {}, done}}}});
    ASSERT_EQ(bar.size(), 3u * 6);
    const float share = std::isnan(done) ? 0 : std::clamp(done, 0.0F, 1.0F);
    EXPECT_NEAR(area(bar, 2).width(), area(bar, 1).width() * share, 1) << done;
    EXPECT_GT(area(bar, 1).width(), 200);
  }
}

TEST(OverlayLayout, IsLargerByWholeFactors) {
  const std::vector<TextPanel> panels{{Anchor::kTopLeft, {{"words", 0xFF0000, 0.5F}}}};
  const Area once = area(lay_out(panels, {2560, 1440}, 1), 0);
  for (const auto& [scale, factor] : {std::pair{1.4F, 1.0F},
                                      {1.5F, 2.0F},
                                      {2.0F, 2.0F},
                                      {3.9F, 4.0F},
                                      {100.0F, 4.0F},
                                      {0.0F, 1.0F},
                                      {NAN, 1.0F}}) {
    const Vertices out = lay_out(panels, {2560, 1440}, scale);
    EXPECT_EQ(area(out, 0).width(), once.width() * factor) << scale;
    EXPECT_EQ(area(out, 0).height(), once.height() * factor) << scale;
    EXPECT_TRUE(std::ranges::all_of(out, [](const auto& v) {
      return v.place.x == std::round(v.place.x) && v.place.y == std::round(v.place.y);
    })) << "text is sharp on whole pixels only";
  }
}

TEST(OverlayLayout, TakesLettersOfUtf8AsOneCharacter) {
  EXPECT_EQ(lay_out({{Anchor::kTopLeft, {{"h\xC3\xB6he"}}}}).size(), (1u + 4) * 6);
  EXPECT_EQ(lay_out({{Anchor::kTopLeft, {{"\xF0\x9F\x8C\xB2"}}}}).size(), (1u + 1) * 6);
}

TEST(OverlayLayout, TakesBytesThatAreNoTextWithoutHarm) {
  EXPECT_GE(lay_out({{Anchor::kTopLeft, {{"\xFF\xC3\x28\x01 ok\xE2\x82"}}}}).size(), 3u * 6);
}

TEST(OverlayLayout, CutsTextOffInsteadOfGrowingWithoutEnd) {
  const std::vector<TextLine> lines(100, {std::string(1000, 'W')});
  EXPECT_EQ(lay_out({{Anchor::kTopLeft, lines}}).size(), OverlayLayout::kMaxQuads * 6);
}

TEST(OverlayLayout, LaysOutForPicturesSmallerThanALetter) {
  for (const core::Extent picture : {core::Extent{1, 1}, {3, 300}, {300, 3}}) {
    EXPECT_FALSE(lay_out({{Anchor::kBottom, {{"words"}}}, {Anchor::kTopRight, {{"more"}}}}, picture)
                     .empty());
  }
}

TEST(OverlayLayout, PutsAGroundUnderEverything) {
  const OverlayLayout overlay;
  Vertices out;
  overlay.lay_out(std::vector{TextPanel{Anchor::kMiddle, {{"a"}}}}, kPicture, 1, out);
  const Vertices before = out;
  overlay.put_ground_under(kPicture, out);
  ASSERT_EQ(out.size(), before.size() + 6);
  EXPECT_EQ(area(out, 0).width(), 640);
  EXPECT_EQ(area(out, 0).height(), 360);
  EXPECT_EQ(out[0].colour.w, 1);
  EXPECT_EQ(area(out, 1).x0, area(before, 0).x0);
}

TEST(OverlayLayout, HasAnAtlasWithSomethingInIt) {
  const OverlayLayout overlay;
  EXPECT_EQ(overlay.atlas().size(),
            std::size_t{overlay.atlas_size().width} * overlay.atlas_size().height);
  const auto texels = overlay.atlas();
  EXPECT_TRUE(
      std::any_of(texels.begin(), texels.end(), [](std::byte b) { return b == std::byte{255}; }));
}

}  // namespace
}  // namespace psygen::render
