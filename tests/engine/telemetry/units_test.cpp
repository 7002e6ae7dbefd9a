#include "engine/telemetry/units.hpp"

#include <gtest/gtest.h>

namespace psygen::telemetry {
namespace {

TEST(Units, NumbersHaveThreeSignificantDigits) {
  EXPECT_EQ(three_digits(0), "0");
  EXPECT_EQ(three_digits(0.12345), "0.123");
  EXPECT_EQ(three_digits(9.999), "10.0");
  EXPECT_EQ(three_digits(16.666), "16.7");
  EXPECT_EQ(three_digits(-123.4), "-123");
  EXPECT_EQ(three_digits(1234.5), "1234");
}

TEST(Units, BytesHaveBinaryPrefixesAndCountsHaveWords) {
  EXPECT_EQ(bytes_text(0), "0 B");
  EXPECT_EQ(bytes_text(1023), "1023 B");
  EXPECT_EQ(bytes_text(512.0 * 1024 * 1024), "512 MiB");
  EXPECT_EQ(bytes_text(8.4e12), "7.64 TiB");
  EXPECT_EQ(size_text(8.4e12), "8.40 TB");
  EXPECT_EQ(count_text(7), "7");
  EXPECT_EQ(count_text(999), "999");
  EXPECT_EQ(count_text(999'999), "1.00 million");
  EXPECT_EQ(count_text(32.8e9), "32.8 billion");
}

}  // namespace
}  // namespace psygen::telemetry
