#include "engine/core/replace_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "tests/temporary_folder.hpp"

namespace psygen::core {
namespace {

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_bytes(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

std::vector<std::uint8_t> text(std::string_view characters) {
  return {characters.begin(), characters.end()};
}

TEST(ReplaceFile, WritesANewFileAndReplacesAnOldOneAndLeavesNothingElse) {
  const TemporaryFolder folder;
  ASSERT_TRUE(replace_file(folder / "a.bin", text("old")));
  EXPECT_EQ(bytes_of(folder / "a.bin"), text("old"));
  ASSERT_TRUE(replace_file(folder / "a.bin", text("new and longer")));
  EXPECT_EQ(bytes_of(folder / "a.bin"), text("new and longer"));
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(ReplaceFile, WorksBesideALeftOverOfAnInterruptedWrite) {
  const TemporaryFolder folder;
  write_bytes(folder / (".a.bin." + std::to_string(getpid()) + "-0.partial"), text("left over"));
  ASSERT_TRUE(replace_file(folder / "a.bin", text("new")));
  EXPECT_EQ(bytes_of(folder / "a.bin"), text("new"));
}

TEST(ReplaceFile, NamesThePathWhenTheFolderDoesNotExist) {
  const TemporaryFolder folder;
  const auto path = folder / "missing" / "a.bin";
  const auto result = replace_file(path, text("x"));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kIo);
  EXPECT_NE(result.error().message.find(path.string()), std::string::npos);
}

TEST(ReplaceFile, LeavesDevicesAndFoldersAlone) {
  const TemporaryFolder folder;
  EXPECT_EQ(replace_file("/dev/full", text("x")).error().code, ErrorCode::kIo);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  EXPECT_EQ(replace_file(folder.path(), text("x")).error().code, ErrorCode::kIo);
}

TEST(ReplaceFile, KeepsTheOldContentWhenTheDiskHasNoRoomForTheNewOne) {
  const TemporaryFolder folder;
  ASSERT_TRUE(replace_file(folder / "a.bin", text("old")));
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{1000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const auto result = replace_file(folder / "a.bin", std::vector<std::uint8_t>(100'000, 1));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kIo);
  EXPECT_EQ(bytes_of(folder / "a.bin"), text("old"));
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(ReplaceFile, WhatAKilledProcessLeftBehindIsCleanedUpAndNothingElse) {
  const TemporaryFolder folder;
  const std::string mine = ".a.bin." + std::to_string(getpid()) + "-0.partial";
  // No process has a number beyond the kernel's limit of 2^22.
  for (const std::string& name :
       {std::string(".a.bin.99999999-0.partial"), mine, std::string("b.99999999-0.partial"),
        std::string(".x.partial"), std::string("a.bin")}) {
    std::ofstream(folder / name) << "half";
  }
  remove_stale_partials(folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / ".a.bin.99999999-0.partial"));
  EXPECT_EQ(folder.file_count(), 4u);
}

}  // namespace
}  // namespace psygen::core
