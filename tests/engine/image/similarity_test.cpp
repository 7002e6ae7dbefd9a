#include <gtest/gtest.h>

#include "tests/bench/image/structural_similarity.hpp"
#include "tests/engine/image/test_files.hpp"

namespace psygen::image {
namespace {

using bench::structural_similarity;

Image with_noise(Image image, std::uint32_t every) {
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < image.width; ++x)
      if ((7 * x + 13 * y) % every == 0) image.pixel(x, y)[1] ^= 64;
  }
  return image;
}

TEST(Similarity, IsOneForAnImageAndItselfWithAnyAlpha) {
  const Image image = noise_image(64, 48);
  EXPECT_DOUBLE_EQ(structural_similarity(image, image), 1.0);
  Image clear = image;
  for (std::size_t i = 3; i < clear.rgba.size(); i += 4)
    clear.rgba[i] = 0;
  EXPECT_DOUBLE_EQ(structural_similarity(image, clear), 1.0);
}

// By hand: (2 · 100 · 150 + 6.5025) / (100² + 150² + 6.5025), without structure.
TEST(Similarity, OfTwoGreysIsThatOfTheirMeans) {
  const Image a = make_image(20, 12, 100, 100, 100, 255);
  const Image b = make_image(20, 12, 150, 150, 150, 255);
  EXPECT_NEAR(structural_similarity(a, b), 0.92309, 1e-5);
  EXPECT_DOUBLE_EQ(structural_similarity(a, b), structural_similarity(b, a));
}

TEST(Similarity, FallsWithTheNumberOfPixelsThatDiffer) {
  const Image image = noise_image(64, 64);
  const double few = structural_similarity(image, with_noise(image, 97));
  const double many = structural_similarity(image, with_noise(image, 11));
  EXPECT_LT(many, few);
  EXPECT_LT(few, 1.0);
  EXPECT_GT(many, 0.0);
}

TEST(Similarity, OfANegativeIsBelowZero) {
  const Image image = noise_image(32, 32);
  Image negative = image;
  for (std::size_t i = 0; i < negative.rgba.size(); ++i)
    if (i % 4 != 3) negative.rgba[i] = static_cast<std::uint8_t>(255 - negative.rgba[i]);
  EXPECT_LT(structural_similarity(image, negative), 0.0);
}

}  // namespace
}  // namespace psygen::image
