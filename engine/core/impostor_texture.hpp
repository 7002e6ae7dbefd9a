// The texture format of impostors, which stand in for distant models: views from around the model,
// one after the other in one texture. Synthesis makes them (world/far/tree_impostors.hpp), and the
// renderer draws them (core::kImpostorBit). Byte layout only. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace psygen::core {

// Texels of 4 bytes: red, green and blue as the square root of the linear albedo, and opacity,
// which is drawn from one half on. The texture stores level by level, each half as wide as the one
// before; in a level view by view; in a view rows from the top. View k shows the model to a viewer
// who looks along (cos, 0, sin) of k · 45°.
inline constexpr std::uint32_t kImpostorSide = 128;  // texels
inline constexpr std::uint32_t kImpostorViews = 8;
inline constexpr std::uint32_t kImpostorLevels = 6;  // the last one has 4 x 4 texels
// Limit of the renderer: one byte holds an impostor and a view, and every device has as many
// layers.
inline constexpr std::uint32_t kMaxImpostors = 31;

// The texels of one impostor.
using ImpostorTexture = std::vector<std::uint8_t>;

// Bytes of one level of all views, and of a whole impostor.
constexpr std::size_t impostor_level_bytes(std::uint32_t level) {
  const std::size_t side = kImpostorSide >> level;
  return kImpostorViews * side * side * 4;
}
constexpr std::size_t impostor_bytes() {
  std::size_t sum = 0;
  for (std::uint32_t level = 0; level < kImpostorLevels; ++level)
    sum += impostor_level_bytes(level);
  return sum;
}

}  // namespace psygen::core
