#include "engine/cli/text_values.hpp"

#include <gtest/gtest.h>

namespace psygen::cli {
namespace {

TEST(TextValues, BytesHaveSuffixes) {
  EXPECT_EQ(parse_bytes("4096").value(), 4096u);
  EXPECT_EQ(parse_bytes("512M").value(), 512ull << 20);
  EXPECT_EQ(parse_bytes("512MiB").value(), 512ull << 20);
  EXPECT_EQ(parse_bytes("2g").value(), 2ull << 30);
}

TEST(TextValues, AnInvalidNumberOfBytesIsRejected) {
  for (const char* text : {"", "M", "-1", "1.5M", "12X", "512MM", "1e9", " 1",
                           "99999999999999999999", "99999999999T"}) {
    EXPECT_FALSE(parse_bytes(text)) << text;
  }
}

TEST(TextValues, SizesAreWidthTimesHeight) {
  EXPECT_EQ(parse_size("1280x720").value(), (core::Extent{1280, 720}));
  for (const char* text : {"", "x", "1280", "1280x", "x720", "0x720", "1280x0", "20000x100",
                           "1280x720x3", "-1x5", "12 80x720"}) {
    EXPECT_FALSE(parse_size(text)) << text;
  }
}

TEST(TextValues, PositionsAreTwoFiniteNumbers) {
  EXPECT_EQ(*parse_place("1.5,-2"), glm::dvec2(1.5, -2));
  EXPECT_EQ(*parse_place("1e3,0"), glm::dvec2(1000, 0));
  for (const char* text : {"", "1", "1,", ",1", "1,2,3", "1, 2", "a,b", "nan,1", "1,inf", "1;2"})
    EXPECT_FALSE(parse_place(text)) << text;
}

TEST(TextValues, BlocksAreTwoIntegersOf32Bits) {
  EXPECT_EQ(*parse_block("-1,2147483647"), (core::BlockCoord{-1, INT32_MAX}));
  for (const char* text : {"", "1", "1,", ",1", "1,2,3", "1.5,2", "2147483648,0", "1, 2"})
    EXPECT_FALSE(parse_block(text)) << text;
}

}  // namespace
}  // namespace psygen::cli
