#include "engine/models/terrain_grid.hpp"

#include <algorithm>

#include "engine/core/assert.hpp"

namespace psygen::models {

std::array<int, kTerrainLevels> terrain_strides(int size) {
  std::array<int, 8> factors{};  // 127 < 2^7
  int count = 0;
  int rest = size - 1;
  for (int f = 2; rest > 1; ++f) {
    for (; rest % f == 0; rest /= f)
      factors[static_cast<std::size_t>(count++)] = f;
  }
  for (; count > kTerrainLevels - 1; --count) {
    const int product = factors[0] * factors[1];
    int at = 2;
    for (; at < count && factors[static_cast<std::size_t>(at)] < product; ++at)
      factors[static_cast<std::size_t>(at - 2)] = factors[static_cast<std::size_t>(at)];
    factors[static_cast<std::size_t>(at - 2)] = product;
    for (; at < count; ++at)
      factors[static_cast<std::size_t>(at - 1)] = factors[static_cast<std::size_t>(at)];
  }
  std::array<int, kTerrainLevels> strides{1};
  for (int level = 1; level < kTerrainLevels; ++level) {
    const auto l = static_cast<std::size_t>(level);
    strides[l] = strides[l - 1] * (level <= count ? factors[l - 1] : 1);
  }
  return strides;
}

TerrainGrid::TerrainGrid(int size_at_level_0, int level_stride, int vertices)
    : size(size_at_level_0), stride(level_stride), n(vertices) {}

TerrainGrid::TerrainGrid(int size_at_level_0, int level)
    : size(size_at_level_0),
      stride(terrain_strides(size_at_level_0)[static_cast<std::size_t>(level)]),
      n((size_at_level_0 - 1) / stride + 1) {}

TerrainGrid TerrainGrid::of_index_list(std::uint32_t id) {
  const int size = static_cast<int>((id >> 8) & 0xFFFFU);
  const int stride = static_cast<int>(id & 0xFFU);
  PSYGEN_CHECK(id >> 24 == 1 && size >= 2 && stride >= 1 && (size - 1) % stride == 0,
               "the index list is one that mesh_size() named");
  return {size, stride, (size - 1) / stride + 1};
}

std::uint32_t TerrainGrid::border_vertex(std::uint32_t k) const {
  const auto last = static_cast<std::uint32_t>(n - 1);
  const auto width = static_cast<std::uint32_t>(n);
  const std::uint32_t along = k % last;
  switch (k / last) {
    case 0:
      return along;
    case 1:
      return along * width + last;
    case 2:
      return last * width + last - along;
    default:
      return (last - along) * width;
  }
}

void TerrainGrid::write_indices(std::span<std::uint16_t> out) const {
  PSYGEN_CHECK(out.size() == triangles() * 3, "the span has exactly the size of the list");
  constexpr std::uint32_t kStrip = 16;
  const auto cells = static_cast<std::uint32_t>(n - 1);
  const auto width = static_cast<std::uint32_t>(n);
  std::size_t at = 0;
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t v : {a, b, c})
      out[at++] = static_cast<std::uint16_t>(v);
  };
  for (std::uint32_t x0 = 0; x0 < cells; x0 += kStrip) {
    for (std::uint32_t z = 0; z < cells; ++z) {
      for (std::uint32_t x = x0; x < std::min(x0 + kStrip, cells); ++x) {
        const std::uint32_t v = z * width + x;
        triangle(v, v + width, v + 1);
        triangle(v + 1, v + width, v + width + 1);
      }
    }
  }
  const std::uint32_t border = border_vertices();
  for (std::uint32_t k = 0; k < border; ++k) {
    const std::uint32_t next = (k + 1) % border;
    const std::uint32_t a = border_vertex(k), b = border_vertex(next);
    const std::uint32_t a_low = surface_vertices() + k, b_low = surface_vertices() + next;
    triangle(b, b_low, a_low);
    triangle(b, a_low, a);
  }
}

}  // namespace psygen::models
