// Documents and files for tests of the editor's document.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "editor/document/document.hpp"
#include "tests/source_file.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::editor::testing {

inline constexpr const char* kWorld = R"(# a world for tests: größer
format = 1

[world]
name = "small"   # its name
seed = 5
blocks = [8, 4]

[terrain]
octaves = 4

[[scatter]]
model = "tree"
count = 3
size_m = [1.5, 2.5]

# stones
[[scatter]]
model = "rock"
count = 5
subdivisions = 1
)";

inline void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

inline std::string read(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// A folder with world.toml and its own state folder.
struct Place {
  TemporaryFolder folder;
  std::filesystem::path file = folder / "world.toml";
  std::filesystem::path state = folder / "state";
  explicit Place(const std::string& text = kWorld) { write(file, text); }
  DocumentOptions options() const {
    DocumentOptions options;
    options.state_folder = state;
    return options;
  }
};

// Expects success, and shows the error message otherwise.
template <class T>
bool good(const core::Result<T>& result) {
  if (!result) ADD_FAILURE() << result.error().message;
  return result.has_value();
}

}  // namespace psygen::editor::testing
