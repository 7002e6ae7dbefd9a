// Reads a whole file in a test.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace psygen {

// The bytes of a file; empty if it cannot be read.
inline std::string file_content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace psygen
