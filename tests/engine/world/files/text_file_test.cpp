#include "engine/world/files/text_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace psygen::world {
namespace {

using ::testing::HasSubstr;

std::filesystem::path written(const std::string& name, std::string_view text) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / name;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

TEST(TextFile, ReadsEveryByte) {
  const std::string text("a\0b\r\n\xff", 6);
  EXPECT_EQ(read_text_file(written("psygen_bytes.txt", text)).value(), text);
  EXPECT_EQ(read_text_file(written("psygen_empty.txt", "")).value(), "");
}

TEST(TextFile, AMissingFileIsAnErrorThatNamesIt) {
  const auto text = read_text_file("no/such/world.toml");
  ASSERT_FALSE(text.has_value());
  EXPECT_EQ(text.error().code, core::ErrorCode::kIo);
  EXPECT_THAT(text.error().message, HasSubstr("no/such/world.toml"));
}

TEST(TextFile, AFolderAndADeviceAreNotFiles) {
  EXPECT_EQ(read_text_file(::testing::TempDir()).error().code, core::ErrorCode::kIo);
  EXPECT_EQ(read_text_file("/dev/zero").error().code, core::ErrorCode::kIo);
}

TEST(TextFile, AFileAboveTheLimitIsRejected) {
  const std::string most(kMaxFileBytes, '#');
  EXPECT_EQ(read_text_file(written("psygen_most.txt", most)).value().size(), kMaxFileBytes);
  const auto more = read_text_file(written("psygen_more.txt", most + "#"));
  ASSERT_FALSE(more.has_value());
  EXPECT_EQ(more.error().code, core::ErrorCode::kOverBudget);
  EXPECT_THAT(more.error().message, HasSubstr("1048576"));
  EXPECT_EQ(read_text_file(written("psygen_five.txt", "12345"), 5).value(), "12345");
  EXPECT_FALSE(read_text_file(written("psygen_five.txt", "12345"), 4).has_value());
  EXPECT_EQ(read_text_file(written("psygen_more.txt", most + "#"), 2 * kMaxFileBytes).value(),
            most + "#");
}

}  // namespace
}  // namespace psygen::world
