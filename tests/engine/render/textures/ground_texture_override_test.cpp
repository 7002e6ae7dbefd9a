#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/hash.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {
namespace {

using ::testing::HasSubstr;

// Bytes of a picture: colour(x, y, channel), opaque.
template <class F>
std::vector<std::uint8_t> picture(std::uint32_t width, std::uint32_t height, const F& colour) {
  std::vector<std::uint8_t> rgba;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      for (std::uint32_t c = 0; c < 3; ++c)
        rgba.push_back(static_cast<std::uint8_t>(colour(x, y, c)));
      rgba.push_back(255);
    }
  }
  return rgba;
}

std::uint32_t noise(std::uint32_t x, std::uint32_t y, std::uint32_t c) {
  return static_cast<std::uint32_t>(core::mix64(y * 4096ULL + x * 3 + c) & 0xFF);
}

std::string error_of(std::uint32_t width, std::uint32_t height,
                     std::span<const std::uint8_t> rgba) {
  const auto made = ground_picture(width, height, rgba);
  if (made) return "accepted";
  EXPECT_EQ(made.error().code, core::ErrorCode::kInvalidArgument);
  return made.error().message;
}

TEST(GroundPicture, OneThatRepeatsWithoutASeamIsBroughtToTheSizeOfTheTextures) {
  for (const std::uint32_t side : {16U, 100U, 256U, 512U}) {
    const auto made = ground_picture(side, side, picture(side, side, noise));
    ASSERT_TRUE(made) << side << ": " << made.error().message;
    EXPECT_EQ(made->rgb.size(), 256U * 256 * 3);
  }
}

TEST(GroundPicture, ItsLightIsLinearAndTheMeanOfThePixelsOfATexel) {
  const auto even = ground_picture(
      512, 512, picture(512, 512, [](auto, auto, std::uint32_t c) { return c == 0 ? 188 : 255; }));
  ASSERT_TRUE(even);
  EXPECT_NEAR(even->rgb[0], 0.5F, 0.01F);
  EXPECT_NEAR(even->rgb[1], 1.0F, 0.001F);
  const auto stripes = ground_picture(512, 512, picture(512, 512, [](std::uint32_t x, auto, auto) {
                                        return x % 2 == 0 ? 255 : 0;
                                      }));
  ASSERT_TRUE(stripes);
  EXPECT_NEAR(stripes->rgb[0], 0.5F, 0.01F);
}

TEST(GroundPicture, OneThatIsNotSquareOrOnePixelWideIsRefusedWithItsSize) {
  EXPECT_THAT(error_of(64, 32, picture(64, 32, noise)),
              HasSubstr("64 x 32; it must be square, with 16 to 4096"));
  EXPECT_THAT(error_of(1, 256, picture(1, 256, noise)), HasSubstr("1 x 256"));
  EXPECT_THAT(error_of(1, 1, picture(1, 1, noise)), HasSubstr("1 x 1"));
  EXPECT_THAT(error_of(8192, 8192, {}), HasSubstr("8192 x 8192"));
  EXPECT_THAT(error_of(64, 64, picture(32, 32, noise)), HasSubstr("64 x 64"));
}

TEST(GroundPicture, OneWithASeamIsRefusedAndTheErrorSaysWhere) {
  EXPECT_THAT(error_of(64, 64, picture(64, 64, [](std::uint32_t x, auto, auto) { return x * 4; })),
              HasSubstr("without a seam: its left and right ends differ"));
  EXPECT_THAT(error_of(64, 64, picture(64, 64, [](auto, std::uint32_t y, auto) { return y * 2; })),
              HasSubstr("upper and lower ends differ"));
}

TEST(GroundPicture, OneWithTransparentPixelsOrWithoutAColourIsRefused) {
  auto hole = picture(32, 32, noise);
  hole[4 * 77 + 3] = 254;
  EXPECT_THAT(error_of(32, 32, hole), HasSubstr("transparent"));
  EXPECT_THAT(error_of(32, 32,
                       picture(32, 32,
                               [](auto x, auto y, std::uint32_t c) {
                                 return c == 2 ? 0 : noise(x, y, c);
                               })),
              HasSubstr("black in red, green or blue"));
}

}  // namespace
}  // namespace psygen::render
