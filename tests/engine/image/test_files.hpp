// Files and images for the tests of image.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/image/image.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::image {

// The content of a file; empty if it cannot be read.
inline std::vector<std::uint8_t> bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Creates or replaces a file.
inline void write_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

// An image with noise in all four channels, the same in every run.
inline Image noise_image(std::uint32_t width, std::uint32_t height) {
  Image image = make_image(width, height);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    image.rgba[i] = static_cast<std::uint8_t>(core::mix64(i) & 0xFF);
  return image;
}

}  // namespace psygen::image
