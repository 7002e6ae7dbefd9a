#include "engine/exchange/triangle_colours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>

#include "engine/core/hash.hpp"
#include "engine/models/kit/exact_math.hpp"

namespace psygen::exchange {
namespace {

float srgb_of(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

glm::vec3 linear_of_texel(std::uint32_t texel) {
  const std::array<float, 256>& light = models::linear_light();
  return {light[texel >> 16 & 0xFF], light[texel >> 8 & 0xFF], light[texel & 0xFF]};
}

std::uint32_t texel_of(const glm::vec3& linear) {
  const glm::vec3 bytes = glm::clamp(srgb(linear), 0.0F, 1.0F) * 255.0F + 0.5F;
  return static_cast<std::uint32_t>(bytes.x) << 16 | static_cast<std::uint32_t>(bytes.y) << 8 |
         static_cast<std::uint32_t>(bytes.z);
}

glm::vec3 fourth(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  return linear_of_texel(b) + linear_of_texel(c) - linear_of_texel(a);
}

// The largest part of a colour that clamping cuts off.
float excess(const glm::vec3& colour) {
  const glm::vec3 cut = glm::abs(colour - glm::clamp(colour, 0.0F, 1.0F));
  return std::max({cut.x, cut.y, cut.z});
}

// Bits 0, 2, 4, … of a number, close together.
std::uint32_t even_bits(std::uint32_t number) {
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < 16; ++i)
    bits |= (number >> (2 * i) & 1U) << i;
  return bits;
}

// Successive blocks lie close together (Morton order), so that coarse levels of the image average
// colours of neighbouring triangles.
glm::uvec2 corner_of(std::uint32_t block) {
  return 2U * glm::uvec2(even_bits(block), even_bits(block >> 1));
}

}  // namespace

glm::vec3 srgb(const glm::vec3& linear) {
  return {srgb_of(linear.x), srgb_of(linear.y), srgb_of(linear.z)};
}

std::size_t TriangleColours::Hash::operator()(const Block& block) const {
  return static_cast<std::size_t>(core::hash_bytes(std::as_bytes(std::span(block)), 0));
}

std::array<std::uint32_t, 3> TriangleColours::add(const std::array<glm::vec3, 3>& linear) {
  Block texels{};
  std::transform(linear.begin(), linear.end(), texels.begin(), texel_of);
  // The order within a block does not depend on the order of the corners. Its first colour is the
  // one whose d is cut least.
  Block block = texels;
  std::sort(block.begin(), block.end());
  const std::array<float, 3> cut{excess(fourth(block[0], block[1], block[2])),
                                 excess(fourth(block[1], block[0], block[2])),
                                 excess(fourth(block[2], block[0], block[1]))};
  const auto least = std::min_element(cut.begin(), cut.end()) - cut.begin();
  std::swap(block[0], block[static_cast<std::size_t>(least)]);

  const auto [found, is_new] =
      numbers_.try_emplace(block, static_cast<std::uint32_t>(blocks_.size()));
  if (is_new) blocks_.push_back(block);
  std::array<std::uint32_t, 3> indices{};
  for (std::size_t corner = 0; corner < indices.size(); ++corner) {
    const auto place = std::find(block.begin(), block.end(), texels[corner]) - block.begin();
    indices[corner] = 3 * found->second + static_cast<std::uint32_t>(place);
  }
  return indices;
}

core::Result<void> TriangleColours::check() const {
  if (blocks_.size() <= max_blocks_) return {};
  return core::fail(core::ErrorCode::kOverBudget,
                    fmt::format("an .obj has at most {} triangles of different colours, not {}; a "
                                ".glb or a coarser level has room",
                                max_blocks_, blocks_.size()));
}

glm::uvec2 TriangleColours::size() const {
  std::uint32_t width = 2, height = 2;
  while (std::size_t{width / 2} * (height / 2) < blocks_.size())
    (width == height ? width : height) *= 2;
  return {width, height};
}

image::Image TriangleColours::image() const {
  const glm::uvec2 all = size();
  image::Image image = image::make_image(all.x, all.y, 255, 255, 255, 255);
  const auto set = [&image](glm::uvec2 at, Texel texel) {
    const auto pixel = image.pixel(at.x, at.y);
    pixel[0] = static_cast<std::uint8_t>(texel >> 16);
    pixel[1] = static_cast<std::uint8_t>(texel >> 8);
    pixel[2] = static_cast<std::uint8_t>(texel);
  };
  for (std::uint32_t i = 0; i < blocks_.size(); ++i) {
    const auto& [a, b, c] = blocks_[i];
    const glm::uvec2 corner = corner_of(i);
    set(corner, a);
    set(corner + glm::uvec2(1, 0), b);
    set(corner + glm::uvec2(0, 1), c);
    set(corner + glm::uvec2(1, 1), texel_of(fourth(a, b, c)));
  }
  return image;
}

glm::dvec2 TriangleColours::coordinates(std::uint32_t index) const {
  const std::uint32_t texel = index % 3;
  const glm::uvec2 at = corner_of(index / 3) + glm::uvec2(texel == 1, texel == 2);
  const glm::dvec2 from_top = (glm::dvec2(at) + 0.5) / glm::dvec2(size());
  return {from_top.x, 1.0 - from_top.y};
}

}  // namespace psygen::exchange
