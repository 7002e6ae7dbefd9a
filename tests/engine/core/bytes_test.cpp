#include "engine/core/bytes.hpp"

#include <gtest/gtest.h>

#include <string>

namespace psygen::core {
namespace {

TEST(Bytes, AreReadAsTheyWereWrittenInEitherContainer) {
  const auto check = [](auto out) {
    put(out, std::uint32_t{0x01020304});
    put(out, -2.5);
    put_all(out, std::span<const float>(std::vector<float>{1, 2, 3}));
    put_varint(out, 300);
    put(out, std::uint32_t{2});
    put_all(out, std::span<const char>(std::string_view("ab")));
    EXPECT_EQ(static_cast<unsigned char>(out[0]), 4) << "little-endian";
    ByteReader in(out);
    EXPECT_EQ(in.get<std::uint32_t>(), 0x01020304u);
    EXPECT_EQ(in.get<double>(), -2.5);
    EXPECT_EQ(in.get_all<float>(3), (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(in.get_varint(), 300u);
    EXPECT_EQ(in.get_count(1), 2u);
    EXPECT_EQ(in.left(), 2u);
    EXPECT_EQ(in.get_text(2), "ab");
    EXPECT_EQ(in.left(), 0u);
    EXPECT_FALSE(in.failed());
  };
  check(std::string());
  check(std::vector<std::byte>());
}

TEST(Bytes, VarintsTakeAsManyBytesAsTheyNeed) {
  for (const std::uint64_t value : {std::uint64_t{0}, std::uint64_t{127}, std::uint64_t{128},
                                    std::uint64_t{1} << 40, (std::uint64_t{1} << 63) - 1}) {
    std::string out;
    put_varint(out, value);
    ByteReader in(out);
    EXPECT_EQ(in.get_varint(), value);
    EXPECT_EQ(in.left(), 0u);
    EXPECT_FALSE(in.failed());
  }
  ByteReader endless(std::string_view("\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF"));
  EXPECT_EQ(endless.get_varint(), 0u);
  EXPECT_TRUE(endless.failed());
}

TEST(Bytes, AReaderStaysFailedAfterAMissingByteAndReturnsZeros) {
  const auto fails = [](auto read) {
    ByteReader in(std::string_view("\x09\x08\x07\x06\x05", 5));
    read(in);
    EXPECT_TRUE(in.failed());
    EXPECT_EQ(in.template get<std::uint8_t>(), 0);
    EXPECT_TRUE(in.get_text(1).empty());
    EXPECT_TRUE(in.template get_all<char>(1).empty());
  };
  fails([](ByteReader& in) { EXPECT_EQ(in.get<double>(), 0); });
  fails([](ByteReader& in) { EXPECT_TRUE(in.get_text(6).empty()); });
  fails([](ByteReader& in) { EXPECT_TRUE(in.get_all<float>(SIZE_MAX).empty()); });
  fails([](ByteReader& in) { EXPECT_EQ(in.get_count(1), 0u); });
}

}  // namespace
}  // namespace psygen::core
