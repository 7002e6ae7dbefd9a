#include "engine/image/picture_header.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/hash.hpp"

namespace psygen::image {
namespace {

using namespace std::string_view_literals;

std::vector<std::uint8_t> bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

constexpr auto kPng =
    "\x89PNG\r\n\x1A\n\0\0\0\x0DIHDR\0\0\x01\x02\0\0\0\x03\x08\x06\0\0\0\0\0\0\0"sv;
constexpr auto kJpeg =
    "\xFF\xD8\xFF\xE0\0\x04"
    "ab\xFF\xFF\xC4\0\x03z\xFF\xC2\0\x0B\x08\0\x07\x01\x00\x01\x01\x11\0"sv;

TEST(PictureHeader, ReadsTheSizeOfAPng) {
  const auto header = read_picture_header(bytes_of(kPng));
  ASSERT_TRUE(header);
  EXPECT_EQ(header->format, PictureFormat::kPng);
  EXPECT_EQ(header->width, 258U);
  EXPECT_EQ(header->height, 3U);
}

TEST(PictureHeader, ReadsTheSizeOfALossyALosslessAndAnExtendedWebp) {
  const auto lossy = "RIFF\x20\0\0\0WEBPVP8 \x0C\0\0\0\0\0\0\x9D\x01\x2A\x02\x41\x03\x80"sv;
  const auto lossless = "RIFF\x20\0\0\0WEBPVP8L\x05\0\0\0\x2F\x01\xC1\0\0"sv;
  const auto extended = "RIFF\x20\0\0\0WEBPVP8X\x0A\0\0\0\x10\0\0\0\x01\0\x01\x02\0\0"sv;
  const auto size_of = [](std::string_view text) {
    const auto header = read_picture_header(bytes_of(text));
    return header && header->format == PictureFormat::kWebp
               ? std::pair(header->width, header->height)
               : std::pair(0U, 0U);
  };
  EXPECT_EQ(size_of(lossy), std::pair(258U, 3U));
  EXPECT_EQ(size_of(lossless), std::pair(258U, 4U));
  EXPECT_EQ(size_of(extended), std::pair(65'538U, 3U));
  std::string animated(extended);
  animated[20] = 2;
  EXPECT_EQ(size_of(animated), std::pair(0U, 0U));
  for (const std::string_view whole : {lossy, lossless, extended}) {
    for (std::size_t size = 0; size < whole.size(); ++size)
      EXPECT_EQ(size_of(whole.substr(0, size)), std::pair(0U, 0U)) << size;
  }
}

TEST(PictureHeader, SkipsSegmentsAndFillBytesOfAJpegUntilItsFrame) {
  const auto header = read_picture_header(bytes_of(kJpeg));
  ASSERT_TRUE(header);
  EXPECT_EQ(header->format, PictureFormat::kJpeg);
  EXPECT_EQ(header->width, 256U);
  EXPECT_EQ(header->height, 7U);
}

TEST(PictureHeader, IsNoneForEveryTruncationBeforeTheSize) {
  for (const std::string_view file : {kPng.substr(0, 33), kJpeg.substr(0, 23)}) {
    ASSERT_TRUE(read_picture_header(bytes_of(file)));
    for (std::size_t length = 0; length < file.size(); ++length) {
      EXPECT_FALSE(read_picture_header(bytes_of(file.substr(0, length)))) << length;
    }
  }
}

TEST(PngIsWhole, OnlyUpToItsEndMarkerWithMatchingChecksums) {
  constexpr auto kSmall =
      "\x89PNG\r\n\x1A\n\0\0\0\x03tEST"
      "abc\x2B\x67\x05\xA7\0\0\0\0IEND\xAE\x42\x60\x82"sv;
  std::vector<std::uint8_t> bytes = bytes_of(kSmall);
  EXPECT_TRUE(png_is_whole(bytes));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::vector<std::uint8_t> damaged = bytes;
    damaged[i] ^= 0x10;
    EXPECT_FALSE(png_is_whole(damaged)) << "byte " << i;
    EXPECT_FALSE(png_is_whole(std::span(bytes).first(i))) << "cut to " << i;
  }
}

TEST(PictureHeader, IsNoneForOtherFiles) {
  EXPECT_FALSE(read_picture_header(bytes_of("GIF89a, which is not read")));
  EXPECT_FALSE(
      read_picture_header(bytes_of("\x89PNG\r\n\x1A\n but then nothing that is a header"sv)));
}

TEST(PictureHeader, SurvivesRandomBytesAfterASignature) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    std::vector<std::uint8_t> bytes =
        bytes_of(seed % 2 == 0 ? kPng.substr(0, 8) : kJpeg.substr(0, 3));
    for (std::uint64_t i = 0; i < seed % 64; ++i)
      bytes.push_back(static_cast<std::uint8_t>(core::combine(seed, i) >> 56));
    const auto header = read_picture_header(bytes);
    EXPECT_TRUE(!header || bytes.size() >= 12);
  }
}

}  // namespace
}  // namespace psygen::image
