#include "engine/image/image.hpp"

#include <gtest/gtest.h>

#include "tests/engine/image/test_files.hpp"

namespace psygen::image {
namespace {

TEST(Image, IsMadeInOneColourWithFourBytesPerPixel) {
  const Image image = make_image(3, 2, 10, 20, 30, 40);
  EXPECT_TRUE(is_valid(image));
  EXPECT_EQ(image.rgba.size(), 24U);
  EXPECT_EQ(image.pixel(2, 1)[0], 10);
  EXPECT_EQ(image.pixel(2, 1)[3], 40);
}

TEST(Image, PixelsAreStoredRowByRowFromTheTop) {
  Image image = make_image(3, 2);
  image.pixel(1, 1)[2] = 99;
  EXPECT_EQ(image.rgba[(1 * 3 + 1) * 4 + 2], 99);
}

TEST(Image, IsInvalidWhenItsBytesDoNotFitItsSize) {
  EXPECT_FALSE(is_valid(Image{2, 2, std::vector<std::uint8_t>(15)}));
  EXPECT_FALSE(is_valid(Image{65536, 65536, {}}));
}

TEST(Image, HashChangesWithAnyByteAndWithTheShape) {
  const Image image = noise_image(8, 4);
  EXPECT_EQ(hash(image), hash(noise_image(8, 4)));
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    Image changed = image;
    changed.rgba[i] ^= 1;
    EXPECT_NE(hash(changed), hash(image)) << "byte " << i;
  }
  Image turned = image;
  std::swap(turned.width, turned.height);
  EXPECT_NE(hash(turned), hash(image));
}

}  // namespace
}  // namespace psygen::image
