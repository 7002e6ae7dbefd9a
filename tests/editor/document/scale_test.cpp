#include "editor/document/scale.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

std::size_t digits_in(double value) {
  const std::string text = world::toml_number(value);
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return c >= '1' && c <= '9'; }));
}

TEST(Scale, ValuesHaveFewDigitsInTheFile) {
  EXPECT_EQ(world::toml_number(with_digits(0.1 + 0.2)), "0.3");
  EXPECT_EQ(with_digits(0), 0);
  for (const Scale& scale : {Scale{0.5, 1.5}, Scale{-1, 1}, Scale{0.02, 30, true}}) {
    for (int i = 1; i < 1000; ++i)
      EXPECT_LE(digits_in(scale.at(i / 1000.0)), 3U) << scale.at(i / 1000.0);
  }
}

TEST(Scale, RisesFromOneEndToTheOtherAndBack) {
  for (const Scale& scale :
       {Scale{0.123456, 1.5}, Scale{0.02, 30.1234, true}, Scale{1, 12, false, true}}) {
    EXPECT_EQ(scale.at(0), scale.low);
    EXPECT_EQ(scale.at(1), scale.high);
    EXPECT_EQ(scale.fraction_of(scale.low - 5), 0);
    EXPECT_EQ(scale.fraction_of(scale.high + 5), 1);
    for (int i = 1; i <= 100; ++i) {
      EXPECT_GE(scale.at(i / 100.0), scale.at((i - 1) / 100.0));
      EXPECT_NEAR(scale.fraction_of(scale.at(i / 100.0)), i / 100.0, 0.05);
    }
  }
}

}  // namespace
}  // namespace psygen::editor
