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
#include "engine/image/image_io.hpp"
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

// Cuts the bytes at every length, and flips every byte. Expects an error of `read` for each cut
// file, and an error or an image within the limits for the others. `pixels` has one number a pixel.
template <class Read, class Image, class Number>
void expect_errors_or_images(const std::vector<std::uint8_t>& whole, const Read& read,
                             std::vector<Number> Image::*pixels) {
  const TemporaryFolder folder;
  const ImageLimits limits{64, 64, 64 * 64 * 4, 10'000};
  for (std::size_t length = 0; length < whole.size(); ++length) {
    write_bytes(folder / "cut", std::span(whole).first(length));
    EXPECT_FALSE(read(folder / "cut", limits)) << length;
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const unsigned flip : {1U, 0x80U, 0xFFU}) {
      std::vector<std::uint8_t> damaged = whole;
      damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ flip);
      write_bytes(folder / "flipped", damaged);
      const auto image = read(folder / "flipped", limits);
      if (!image) continue;
      EXPECT_LE(image->width, 64U);
      EXPECT_EQ(((*image).*pixels).size(), std::size_t{image->width} * image->height);
    }
  }
}

// An image with noise in all four channels, the same in every run.
inline Image noise_image(std::uint32_t width, std::uint32_t height) {
  Image image = make_image(width, height);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    image.rgba[i] = static_cast<std::uint8_t>(core::mix64(i) & 0xFF);
  return image;
}

}  // namespace psygen::image
