#include "tests/bench/image/flicker.hpp"

#include <gtest/gtest.h>

namespace psygen::image {
namespace {

using bench::flickering;

Image grey(std::initializer_list<std::uint8_t> values) {
  Image image{.width = static_cast<std::uint32_t>(values.size()), .height = 1, .rgba = {}};
  for (const std::uint8_t value : values)
    image.rgba.insert(image.rgba.end(), {value, value, value, 255});
  return image;
}

using Marks = std::vector<std::uint8_t>;

TEST(Flicker, APixelThatChangesAndChangesBackFlickers) {
  EXPECT_EQ(flickering(grey({100, 100}), grey({100, 120}), grey({100, 100})), (Marks{0, 1}));
}

TEST(Flicker, APixelThatChangesAndStaysDoesNot) {
  EXPECT_EQ(flickering(grey({100, 100}), grey({120, 100}), grey({120, 120})), (Marks{0, 0}));
}

TEST(Flicker, APixelThatKeepsChangingDoesNot) {
  EXPECT_EQ(flickering(grey({100}), grey({120}), grey({140})), Marks{0});
}

TEST(Flicker, ChangesOfEightStepsAreIgnored) {
  EXPECT_EQ(flickering(grey({100}), grey({108}), grey({100})), Marks{0});
  EXPECT_EQ(flickering(grey({100}), grey({91}), grey({108})), Marks{1}) << "back by eight";
  EXPECT_EQ(flickering(grey({100}), grey({91}), grey({109})), Marks{0}) << "not back";
}

TEST(Flicker, OneChannelIsEnoughAndAlphaIsIgnored) {
  for (std::size_t channel = 0; channel < 4; ++channel) {
    Image now = grey({100});
    now.rgba[channel] -= 50;
    EXPECT_EQ(flickering(grey({100}), now, grey({100})), Marks(1, channel < 3)) << channel;
  }
}

}  // namespace
}  // namespace psygen::image
