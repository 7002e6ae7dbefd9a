#include "engine/scene/nodes/ground_sunlight.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace psygen::scene {
namespace {

constexpr std::size_t kSide = GroundSunlight::kSide;
constexpr float kLast = static_cast<float>(kSide - 1);

// The cell of a position along a side.
std::size_t cell_of(float place) {
  const float cell = std::floor(place * static_cast<float>(kSide));
  return static_cast<std::size_t>(std::clamp(cell, 0.0F, kLast));
}

}  // namespace

GroundSunlight ground_sunlight(std::span<const core::TerrainVertex> vertices, std::size_t n) {
  // The vertices of each cell, at least one if there are fewer vertices than cells.
  const float cell = static_cast<float>(n - 1) / static_cast<float>(kSide);
  const float half = std::max(0.5F * cell, 0.5F);
  std::array<std::size_t, kSide> first, end;
  for (std::size_t i = 0; i < kSide; ++i) {
    const float middle = (static_cast<float>(i) + 0.5F) * cell;
    first[i] = static_cast<std::size_t>(std::ceil(std::max(middle - half, 0.0F)));
    end[i] = std::min(static_cast<std::size_t>(middle + half), n - 1) + 1;
  }
  GroundSunlight sun;
  for (std::size_t row = 0; row < kSide; ++row) {
    for (std::size_t column = 0; column < kSide; ++column) {
      std::size_t sum = 0, count = 0;
      for (std::size_t z = first[row]; z < end[row]; ++z) {
        for (std::size_t x = first[column]; x < end[column]; ++x, ++count)
          sum += vertices[z * n + x].sun;
      }
      sun.share[row * kSide + column] = static_cast<std::uint8_t>((sum + count / 2) / count);
    }
  }
  return sun;
}

float sun_at(const GroundSunlight& sun, glm::vec2 place) {
  const glm::vec2 at =
      glm::clamp(place * static_cast<float>(kSide) - 0.5F, glm::vec2(0.0F), glm::vec2(kLast));
  const glm::vec2 cell = glm::min(glm::floor(at), glm::vec2(kLast - 1)), rest = at - cell;
  const std::size_t first =
      static_cast<std::size_t>(cell.y) * kSide + static_cast<std::size_t>(cell.x);
  const auto share = [&](std::size_t further) {
    return static_cast<float>(sun.share[first + further]);
  };
  const float near = glm::mix(share(0), share(1), rest.x);
  const float far = glm::mix(share(kSide), share(kSide + 1), rest.x);
  return glm::mix(near, far, rest.y) / 255.0F;
}

float sun_over(const GroundSunlight& sun, glm::vec2 from, glm::vec2 to) {
  const std::size_t x0 = cell_of(from.x), x1 = cell_of(to.x);
  const std::size_t z0 = cell_of(from.y), z1 = cell_of(to.y);
  std::size_t sum = 0;
  for (std::size_t z = z0; z <= z1; ++z) {
    for (std::size_t x = x0; x <= x1; ++x)
      sum += sun.share[z * kSide + x];
  }
  return static_cast<float>(sum) / static_cast<float>(255 * (x1 - x0 + 1) * (z1 - z0 + 1));
}

}  // namespace psygen::scene
