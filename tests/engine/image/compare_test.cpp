#include "engine/image/compare.hpp"

#include <gtest/gtest.h>

#include "tests/engine/image/test_files.hpp"

namespace psygen::image {
namespace {

TEST(Compare, FindsNoDifferenceBetweenAPictureAndItself) {
  const Image image = noise_image(16, 16);
  EXPECT_EQ(compare(image, image), (ImageDifference{true, 0, 0, 0.0}));
}

TEST(Compare, CountsAPixelOnceHoweverManyOfItsChannelsDiffer) {
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

TEST(Compare, NeverMatchesPicturesOfDifferentSizes) {
  const ImageDifference difference = compare(make_image(4, 2), make_image(2, 4));
  EXPECT_FALSE(difference.same_size);
  EXPECT_EQ(difference.pixels_over, 8U);
  EXPECT_FALSE(matches_golden(difference));
}

TEST(Compare, TwoPicturesWithoutPixelsAreEqual) {
  EXPECT_TRUE(matches_golden(compare(Image{}, Image{})));
}

}  // namespace
}  // namespace psygen::image
