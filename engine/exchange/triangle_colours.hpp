// The vertex colours of a document as an image, for programs that read no vertex colours. Each
// triangle owns a block of 2 × 2 texels: its colours a, b and c, and d = b + c - a. Its texture
// coordinates are the centres of texels a, b and c, between which bilinear filtering is then the
// linear interpolation of the three colours. Triangles with the same three colours share a block.
// Colours are linear albedo until the texels, which are sRGB. Pure; O(triangles). Private to
// engine/exchange.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/image/image.hpp"

namespace psygen::exchange {

// Linear to sRGB (IEC 61966-2-1), each 0 … 1.
glm::vec3 srgb(const glm::vec3& linear);

// The image's largest side in texels, which every graphics API allows.
inline constexpr std::uint32_t kMaxColourSide = 8192;
// And its triangles with different colours.
inline constexpr std::uint32_t kMaxColourBlocks = (kMaxColourSide / 2) * (kMaxColourSide / 2);

// The blocks of all triangles so far.
class TriangleColours {
 public:
  // At most `max_blocks`, 1 … kMaxColourBlocks.
  explicit TriangleColours(std::uint32_t max_blocks = kMaxColourBlocks) : max_blocks_(max_blocks) {}
  // Finds or adds the block of a triangle with these linear colours. The corners' texture
  // coordinates have the indices 3 · block + texel, texel 0 … 2 for a, b and c.
  std::array<std::uint32_t, 3> add(const std::array<glm::vec3, 3>& linear);
  std::size_t block_count() const { return blocks_.size(); }
  // Fails with kOverBudget for more blocks than allowed.
  core::Result<void> check() const;

  // The image: width a power of two, height the same or half of it. Requires check().
  image::Image image() const;
  // The texture coordinates of index 3 · block + texel, from the lower left corner, as OBJ counts.
  glm::dvec2 coordinates(std::uint32_t index) const;

 private:
  using Texel = std::uint32_t;         // 0xRRGGBB, sRGB
  using Block = std::array<Texel, 3>;  // a, b, c
  struct Hash {
    std::size_t operator()(const Block& block) const;
  };
  glm::uvec2 size() const;

  std::uint32_t max_blocks_;
  std::vector<Block> blocks_;
  std::unordered_map<Block, std::uint32_t, Hash> numbers_;
};

}  // namespace psygen::exchange
