#include "engine/render/text/hud_layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace psygen::render {
namespace {

constexpr core::Extent kHudPicture{640, 360};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
using Vertices = std::vector<shaders::OverlayVertex>;

const HudAtlas& atlas() {
  static const HudAtlas made{hud_font().size, {0, 0}, {0.5F, 0.5F}};
  return made;
}

Vertices lay_out_text(const HudText& text) {
  Vertices out;
  lay_out_hud({{}, {text}}, kHudPicture, atlas(), out);
  return out;
}

struct TextArea {
  float x0 = 1e9F, y0 = 1e9F, x1 = -1e9F, y1 = -1e9F;
};
TextArea text_area(const Vertices& vertices) {
  TextArea all;
  for (const auto& v : vertices) {
    all.x0 = std::min(all.x0, v.place.x);
    all.x1 = std::max(all.x1, v.place.x);
    all.y0 = std::min(all.y0, v.place.y);
    all.y1 = std::max(all.y1, v.place.y);
  }
  return all;
}

HudText words(float size_px = 40) {
  HudText text;
  text.text = "words";
  text.at = {{0.5F, 0.5F}, {0, 0}};
  text.size_px = size_px;
  return text;
}

TEST(HudFont, HasTheLettersOfEuropeanLanguagesInAscendingOrder) {
  const HudFont& font = hud_font();
  EXPECT_TRUE(std::ranges::is_sorted(font.letters, {}, &BakedLetter::code));
  for (const char32_t code : U"AZaz09~ äöüßÄÖÜéèêçñåøæœŁłŠšŽžőűğışțăđþð€–—„“”…×÷°→✓") {
    if (code == 0) continue;
    EXPECT_EQ(font.letter(code).code, code) << static_cast<std::uint32_t>(code);
  }
  EXPECT_EQ(font.letter(U'\U0001F332').code, char32_t{0xFFFD}) << "what it lacks";
  EXPECT_EQ(font.texels.size(), std::size_t{font.size.width} * font.size.height);
}

TEST(HudFont, HasDistancesThatAreDeepestInsideOfLetters) {
  const HudFont& font = hud_font();
  const BakedLetter& block = font.letter(U'■');
  const auto texel = [&](float x, float y) {
    return static_cast<int>(font.texels[static_cast<std::size_t>(block.v + y) * font.size.width +
                                        static_cast<std::size_t>(block.u + x)]);
  };
  EXPECT_EQ(texel(block.width / 2, block.height / 2), 255);
  EXPECT_EQ(texel(0, 0), 0);
  EXPECT_NEAR(texel(font.spread, block.height / 2), 128, 22) << "on the edge";
}

TEST(Hud, MakesOneQuadALetterOfTheSizeAskedFor) {
  const Vertices once = lay_out_text(words(20)), twice = lay_out_text(words(40));
  ASSERT_EQ(once.size(), 5u * 6);
  ASSERT_EQ(twice.size(), 5u * 6);
  const TextArea small = text_area(once), large = text_area(twice);
  EXPECT_NEAR(large.x1 - large.x0, 2 * (small.x1 - small.x0), 2);
  EXPECT_NEAR(large.y1 - large.y0, 2 * (small.y1 - small.y0), 2);
  EXPECT_GT(text_area(lay_out_text(words(20.5F))).x1, text_area(once).x1)
      << "sizes may be fractions";
  EXPECT_EQ(measure(words(40)).y, 40);
}

TEST(Hud, AlignsLinesAtTheirPlace) {
  HudText text = words();
  text.text = "a long line\nshort";
  const glm::vec2 extent = measure(text);
  EXPECT_EQ(extent.y, 80);
  const auto placed = [&](HudAlign align, HudVertical vertical) {
    text.align = align;
    text.vertical = vertical;
    return text_area(lay_out_text(text));
  };
  const float around = hud_font().spread * 40 / hud_font().em + 2;  // of letters' pictures
  EXPECT_NEAR(placed(HudAlign::kLeft, HudVertical::kTop).x0, 320, around + 4);
  EXPECT_NEAR(placed(HudAlign::kRight, HudVertical::kTop).x1, 320, around + 4);
  const TextArea middle = placed(HudAlign::kCentre, HudVertical::kMiddle);
  EXPECT_NEAR((middle.x0 + middle.x1) / 2, 320, 4);
  EXPECT_GT(placed(HudAlign::kLeft, HudVertical::kTop).y0, 175);
  EXPECT_LT(placed(HudAlign::kLeft, HudVertical::kBottom).y1, 185);
}

TEST(Hud, DrawsShadowAndOutlineBelowTheLetters) {
  HudText text = words();
  text.colour = {1, 0, 0, 1};
  text.outline_px = 2;
  text.outline_colour = {0, 1, 0, 1};
  text.shadow_px = {3, 4};
  text.shadow_colour = {0, 0, 1, 1};
  const Vertices out = lay_out_text(text);
  ASSERT_EQ(out.size(), 3u * 5 * 6);
  EXPECT_EQ(out[0].colour, text.shadow_colour);
  EXPECT_GT(out[0].look.z, 1) << "soft";
  EXPECT_EQ(out[30].colour, text.outline_colour);
  EXPECT_EQ(out[30].look.y, 2);
  EXPECT_EQ(out[60].colour, text.colour);
  EXPECT_EQ(out[0].place.x - out[60].place.x, 3);
  EXPECT_EQ(out[0].place.y - out[60].place.y, 4);
}

TEST(Hud, DrawsAreasInWholePixelsBelowAllText) {
  HudDrawing drawing;
  drawing.texts.push_back(words());
  drawing.areas.push_back({{{0.25F, 0}, {0.4F, 10}}, {{0.5F, 0}, {0, 7.6F}}, {0, 0, 0, 1}});
  Vertices out;
  lay_out_hud(drawing, kHudPicture, atlas(), out);
  ASSERT_EQ(out.size(), 6u * 6);
  const TextArea first = text_area(Vertices(out.begin(), out.begin() + 6));
  EXPECT_EQ(first.x0, 160);
  EXPECT_EQ(first.x1, 480);
  EXPECT_EQ(first.y0, 10);
  EXPECT_EQ(first.y1, 18);
  EXPECT_EQ(out[0].look.x, 0) << "no letter";
}

TEST(Hud, TakesNumbersAndTextsThatMakeNoSenseWithoutHarm) {
  HudText text = words();
  text.text = "\xFF\xC3\x28\x01 ok\xE2\x82";
  EXPECT_GE(lay_out_text(text).size(), 3u * 6);
  for (const float bad : {kNaN, INFINITY, -INFINITY}) {
    HudText moved = words();
    moved.at.px.x = bad;
    EXPECT_TRUE(lay_out_text(moved).empty());
    HudText sized = words(bad);
    EXPECT_TRUE(lay_out_text(sized).empty());
    EXPECT_EQ(measure(sized), glm::vec2(0.0F));
    HudText strange = words();
    strange.outline_px = strange.bolder_px = strange.shadow_px.y = bad;
    for (const auto& v : lay_out_text(strange))
      EXPECT_TRUE(std::isfinite(v.place.x + v.place.y + v.look.y + v.look.z));
    Vertices out;
    lay_out_hud({{{{{0, 0}, {bad, 0}}, {}, {}}}, {}}, kHudPicture, atlas(), out);
    EXPECT_TRUE(out.empty());
  }
  EXPECT_EQ(measure(words(1e9F)).y, 2000);
  EXPECT_EQ(measure(words(-3)).y, 4);
}

TEST(Hud, CutsTextOffInsteadOfGrowingWithoutEnd) {
  HudText text = words();
  text.text = std::string(300'000, 'W');
  EXPECT_EQ(lay_out_text(text).size(), kMaxHudQuads * 6);
}

}  // namespace
}  // namespace psygen::render
