// Checks what a function that writes files leaves behind on a disk that fills up.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "engine/core/error.hpp"
#include "tests/faults.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen {

// File names and their contents.
using FileContents = std::map<std::string, std::string>;

// The files that lie directly in a folder.
inline FileContents contents_of(const std::filesystem::path& folder) {
  FileContents contents;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    contents[entry.path().filename().string()] = {std::istreambuf_iterator<char>(file), {}};
  }
  return contents;
}

// Calls write(folder) on a disk with room for no call, for one call, ..., until there is room for
// all. Each time every file must be whole or absent, and a failure must name a file and its reason.
template <class Write>
void expect_whole_files(const Write& write) {
  const TemporaryFolder top;
  std::filesystem::create_directory(top / "whole");
  ASSERT_TRUE(write(top / "whole"));
  const FileContents whole = contents_of(top / "whole");
  bool all_fits = false;
  for (std::size_t calls = 0; !all_fits; ++calls) {
    std::filesystem::remove_all(top / "cut");
    std::filesystem::create_directory(top / "cut");
    const FullDisk full(top / "cut", calls);
    const core::Result<void> result = write(top / "cut");
    all_fits = !full.was_met();
    const FileContents left = contents_of(top / "cut");
    for (const auto& [name, content] : left)
      EXPECT_TRUE(whole.contains(name) && whole.at(name) == content) << name << ", call " << calls;
    if (result) {
      EXPECT_EQ(left.size(), whole.size()) << "call " << calls;
      continue;
    }
    EXPECT_EQ(result.error().code, core::ErrorCode::kIo);
    EXPECT_EQ(result.error().message.find((top / "cut").string() + "/"), 0U)
        << result.error().message;
    EXPECT_NE(result.error().message.find("No space left"), std::string::npos)
        << result.error().message;
  }
  EXPECT_EQ(contents_of(top / "cut"), whole);
}

}  // namespace psygen
