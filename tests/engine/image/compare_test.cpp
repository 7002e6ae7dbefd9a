#include "engine/image/compare.hpp"

#include <gtest/gtest.h>

#include "tests/engine/image/test_files.hpp"

namespace psygen::image {
namespace {

TEST(Compare, FindsNoDifferenceBetweenAnImageAndItself) {
  const Image image = noise_image(16, 16);
  EXPECT_EQ(compare(image, image), (ImageDifference{.same_size = true}));
}

TEST(Compare, CountsAPixelOnceEvenIfSeveralChannelsDiffer) {
  const Image a = make_image(10, 10, 100, 100, 100, 255);
  Image b = a;
  b.pixel(3, 3)[0] = 120;
  b.pixel(3, 3)[1] = 90;
  const ImageDifference difference = compare(a, b);
  EXPECT_EQ(difference.max_difference, 20);
  EXPECT_EQ(difference.pixels_over, 1U);
  EXPECT_DOUBLE_EQ(difference.share_over, 0.01);
}

TEST(Compare, DoesNotCountADifferenceOfExactlyTheThreshold) {
  const Image a = make_image(1, 1, 100, 100, 100, 255);
  Image b = a;
  b.pixel(0, 0)[1] = 105;
  EXPECT_EQ(compare(a, b).pixels_over, 0U);
  b.pixel(0, 0)[1] = 106;
  EXPECT_EQ(compare(a, b).pixels_over, 1U);
}

TEST(Compare, SeesAlphaToo) {
  EXPECT_EQ(compare(make_image(1, 1, 0, 0, 0, 0), make_image(1, 1, 0, 0, 0, 255)).max_difference,
            255);
}

TEST(Compare, AllowsOnePixelInAThousandForAGoldenImageButNotTwo) {
  const Image golden = make_image(100, 10, 50, 50, 50, 255);
  Image image = golden;
  image.pixel(7, 7)[0] = 255;
  EXPECT_TRUE(matches_golden(compare(golden, image)));
  image.pixel(8, 7)[0] = 255;
  EXPECT_FALSE(matches_golden(compare(golden, image)));
}

TEST(Compare, FindsTheTileWithTheLargestMeanAlsoAtTheEdge) {
  const Image golden = make_image(40, 20, 50, 50, 50, 255);
  Image image = golden;
  for (std::uint32_t x = 32; x < 40; ++x)  // a tile of 8 × 4 pixels
    for (std::uint32_t y = 16; y < 20; ++y)
      image.pixel(x, y)[1] = 71;
  image.pixel(0, 0)[0] = 80;
  const ImageDifference difference = compare(golden, image);
  EXPECT_DOUBLE_EQ(difference.worst_tile, 7.0);
  EXPECT_NEAR(difference.mean, (32 * 7.0 + 10) / 800, 1e-9);
  EXPECT_FALSE(matches_golden(difference));
  EXPECT_TRUE(matches_other_driver(difference));
  image.pixel(32, 16)[1] = 255;
  EXPECT_FALSE(matches_other_driver(compare(golden, image))) << "a tile is off";
  EXPECT_FALSE(matches_other_driver(compare(golden, make_image(40, 20, 52, 52, 52, 255))));
}

TEST(Compare, NeverMatchesImagesOfDifferentSizes) {
  const ImageDifference difference = compare(make_image(4, 2), make_image(2, 4));
  EXPECT_FALSE(difference.same_size);
  EXPECT_EQ(difference.pixels_over, 8U);
  EXPECT_FALSE(matches_golden(difference));
  EXPECT_FALSE(matches_other_driver(difference));
}

TEST(Compare, TwoImagesWithoutPixelsAreEqual) {
  EXPECT_TRUE(matches_golden(compare(Image{}, Image{})));
}

TEST(Compare, ShowsDifferencesOverADarkGreyImage) {
  const Image expected = make_image(3, 1, 90, 60, 30, 255);
  Image seen = expected;
  seen.pixel(1, 0)[2] = 36;   // 6 more
  seen.pixel(2, 0)[0] = 255;  // 165 more
  const auto picture = picture_of_difference(expected, seen);
  ASSERT_TRUE(picture);
  const auto colour = [&](std::uint32_t x) {
    const auto p = picture->pixel(x, 0);
    return std::vector<int>(p.begin(), p.end());
  };
  EXPECT_EQ(colour(0), (std::vector{12, 12, 12, 255}));
  EXPECT_EQ(colour(1), (std::vector{255, 209, 0, 255})) << "yellow";
  EXPECT_EQ(colour(2), (std::vector{255, 0, 0, 255})) << "red";
  EXPECT_FALSE(picture_of_difference(expected, make_image(1, 3)));
}

}  // namespace

}  // namespace psygen::image
