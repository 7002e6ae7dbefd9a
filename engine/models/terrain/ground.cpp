#include "engine/models/terrain/ground.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>

#include "engine/core/assert.hpp"
#include "engine/core/rounding.hpp"
#include "engine/core/value_cache.hpp"
#include "engine/core/vertex_layout.hpp"
#include "engine/models/edits.hpp"
#include "engine/models/kit/scratch.hpp"

namespace psygen::models {
namespace {

// This many vertices of a grid take about as long as one single point, which spends its time on
// finding the lattices.
constexpr std::size_t kVerticesPerPoint = 128;

// The vertices of a block that a cache keeps.
struct KeptHeights {
  std::vector<std::uint16_t> heights;
  std::size_t bytes() const { return sizeof *this + heights.size() * sizeof heights[0]; }
};

// Names the heights of a block: the terrain without its place and its sun, and all layers that
// reach the block's vertices.
core::ValueCache::Key key_of(Parameters terrain, const TerrainShape& shape,
                             core::BlockCoord block) {
  for (const TerrainParameter placed :
       {kTerrainBlockX, kTerrainBlockZ, kTerrainSunAzimuth, kTerrainSunElevation})
    terrain.set_integer(placed, 0);
  terrain.set_edits(nullptr, 0);
  const auto level = static_cast<std::uint32_t>(shape.node_level);
  const double cells = shape.size - 1,
               block_m = cells * std::ldexp(shape.cell_m, -shape.node_level);
  const double margin = std::ldexp(1 / cells, shape.node_level);  // of a vertex on the border
  return {terrain.hash(), shape.stack->hash_of(QuadCoord::of(block, level), margin, block_m),
          static_cast<std::uint64_t>(std::int64_t{block.x}),
          static_cast<std::uint64_t>(std::int64_t{block.z})};
}

// Height on the two triangles of a cell with these corners; u and v are 0 … 1 along x and z.
double height_on(const std::array<double, 4>& h, double u, double v) {
  if (u + v <= 1) return h[0] + u * (h[1] - h[0]) + v * (h[2] - h[0]);
  return h[3] + (1 - u) * (h[2] - h[3]) + (1 - v) * (h[1] - h[3]);
}

std::uint16_t height_in_mesh(std::span<const std::byte> mesh, std::size_t vertex) {
  core::TerrainVertex v;
  std::memcpy(&v, mesh.data() + vertex * sizeof v, sizeof v);
  return v.height;
}

}  // namespace

glm::vec3 unit_normal(double slope_x, double slope_z) {
  const double scale = 1 / std::sqrt(slope_x * slope_x + 1 + slope_z * slope_z);
  return {static_cast<float>(-slope_x * scale), static_cast<float>(scale),
          static_cast<float>(-slope_z * scale)};
}

BlockGround::BlockGround(const Parameters& terrain, core::BlockCoord block, std::size_t questions)
    : shape_(terrain), block_(block) {
  const auto size = static_cast<std::size_t>(shape_.size);
  if (questions * kVerticesPerPoint < size * size) return;
  vertices_ = size;
  core::ValueCache* const cache = shape_.stack != nullptr && shape_.stack->has_fixed_part()
                                      ? shape_.stack->heights.get()
                                      : nullptr;
  const auto make = [this] { return KeptHeights{quantised_vertices()}; };
  const auto found = cache != nullptr
                         ? cache->get<KeptHeights>(key_of(terrain, shape_, block), make)
                         : std::make_shared<const KeptHeights>(make());
  heights_ = {found, &found->heights};
}

BlockGround::BlockGround(const Parameters& terrain, core::BlockCoord block,
                         std::span<const std::byte> mesh)
    : shape_(terrain),
      block_(block),
      vertices_(static_cast<std::size_t>(shape_.size)),
      mesh_(mesh) {
  PSYGEN_CHECK(mesh.size() >= vertices_ * vertices_ * sizeof(core::TerrainVertex),
               "the mesh has every vertex of the block");
}

// World coordinates of the vertices of a block from `first` on.
void BlockGround::world_of(std::int32_t block_index, std::int64_t first,
                           std::span<std::int64_t> out) const {
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = shape_.world_of(block_index, first + static_cast<std::int64_t>(i));
}

std::uint16_t BlockGround::known(std::size_t vertex) const {
  return mesh_.empty() ? (*heights_)[vertex] : height_in_mesh(mesh_, vertex);
}

std::vector<std::uint16_t> BlockGround::quantised_vertices() const {
  const core::RoundToNearest rounding;
  std::array<std::int64_t, kMaxTerrainSize> columns, rows;
  const std::span x = std::span(columns).first(vertices_), z = std::span(rows).first(vertices_);
  world_of(block_.x, 0, x);
  world_of(block_.z, 0, z);
  const ScratchMemory memory(vertices_ * vertices_ * sizeof(float));
  const std::span noise(static_cast<float*>(memory.get()), vertices_ * vertices_);
  shape_.evaluate(x, z, noise, vertices_, shape_.detail());
  std::vector<std::uint16_t> heights(noise.size());
  std::ranges::transform(noise, heights.begin(),
                         [this](float value) { return shape_.quantise(value); });
  return heights;
}

bool BlockGround::is_inside(double x, double z, int step) const {
  const double end = static_cast<double>(vertices_) - step;
  return x >= 0 && z >= 0 && x < end && z < end;
}

BlockGround::Corners BlockGround::corners_of(double x, double z, int step) const {
  Corners heights;
  if (is_inside(x, z, step)) {
    const std::size_t first = static_cast<std::size_t>(z) * vertices_ + static_cast<std::size_t>(x);
    const auto aside = static_cast<std::size_t>(step), below = aside * vertices_;
    const std::array at{first, first + aside, first + below, first + below + aside};
    for (std::size_t i = 0; i < 4; ++i)
      heights[i] = known(at[i]);
    return heights;
  }
  const auto first_x = static_cast<std::int64_t>(x), first_z = static_cast<std::int64_t>(z);
  const std::array columns{shape_.world_of(block_.x, first_x),
                           shape_.world_of(block_.x, first_x + step)};
  const std::array rows{shape_.world_of(block_.z, first_z),
                        shape_.world_of(block_.z, first_z + step)};
  std::array<float, 4> noise;
  shape_.evaluate(columns, rows, noise, 2, shape_.detail());
  for (std::size_t i = 0; i < 4; ++i)
    heights[i] = shape_.quantise(noise[i]);
  return heights;
}

void BlockGround::heights(std::span<std::uint16_t> out) const {
  PSYGEN_CHECK(vertices_ > 0 && out.size() == vertices_ * vertices_,
               "all heights are known, and there is room for each");
  const core::RoundToNearest rounding;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = known(i);
}

// The heights of a rectangle of vertices in metres, row by row.
std::vector<double> BlockGround::vertices_in(glm::i64vec2 first, glm::ivec2 size,
                                             int stride) const {
  std::vector<double> heights;
  heights.reserve(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  const auto end = static_cast<std::int64_t>(vertices_);
  const auto is_known = [&](std::int64_t from, int n) {
    return from >= 0 && stride * (from + n - 1) < end;
  };
  if (is_known(first.x, size.x) && is_known(first.y, size.y)) {
    for (int z = 0; z < size.y; ++z) {
      for (int x = 0; x < size.x; ++x)
        heights.push_back(
            metres(known(static_cast<std::size_t>(stride * (first.y + z)) * vertices_ +
                         static_cast<std::size_t>(stride * (first.x + x)))));
    }
    return heights;
  }
  const auto places = [&](std::int64_t begin, int n, std::int32_t block_index) {
    std::vector<std::int64_t> out(static_cast<std::size_t>(n));
    for (std::int64_t at = begin; std::int64_t & place : out)
      place = shape_.world_of(block_index, stride * at++);
    return out;
  };
  const auto columns = places(first.x, size.x, block_.x), rows = places(first.y, size.y, block_.z);
  std::vector<float> noise(columns.size() * rows.size());
  shape_.evaluate(columns, rows, noise, columns.size(), shape_.detail());
  for (const float value : noise)
    heights.push_back(metres(shape_.quantise(value)));
  return heights;
}

double BlockGround::metres(std::uint16_t height) const {
  return static_cast<double>(shape_.relief_m) * height / 65535.0;
}

GroundPoint BlockGround::at(glm::dvec2 local_xz, int stride) const {
  const double cell_m = stride * shape_.cell_m;
  const glm::dvec2 cells = local_xz / cell_m;
  const double x = std::floor(cells.x), z = std::floor(cells.y);
  const double u = cells.x - x, v = cells.y - z;
  const Corners heights = corners_of(stride * x, stride * z, stride);
  std::array<double, 4> h;
  std::ranges::transform(heights, h.begin(),
                         [this](std::uint16_t height) { return metres(height); });
  GroundPoint ground;
  ground.height_m = height_on(h, u, v);
  ground.normal = u + v <= 1 ? unit_normal((h[1] - h[0]) / cell_m, (h[2] - h[0]) / cell_m)
                             : unit_normal((h[3] - h[2]) / cell_m, (h[3] - h[1]) / cell_m);
  return ground;
}

double BlockGround::lowest_m(glm::dvec2 middle_m, double half_m, int stride) const {
  const double cell_m = stride * shape_.cell_m;
  const glm::dvec2 low = (middle_m - half_m) / cell_m, high = (middle_m + half_m) / cell_m;
  const glm::dvec2 first = glm::floor(low), last = glm::max(glm::ceil(high), first + 1.0);
  const glm::ivec2 size = glm::ivec2(last - first) + 1;
  const std::vector<double> vertices = vertices_in(glm::i64vec2(first), size, stride);
  // Height in a cell of the square, in cells from `first`.
  const auto height_m = [&](double x, double z) {
    const glm::ivec2 cell(std::min(static_cast<int>(x), size.x - 2),
                          std::min(static_cast<int>(z), size.y - 2));
    const auto row = static_cast<std::size_t>(size.x);
    const std::size_t at =
        static_cast<std::size_t>(cell.y) * row + static_cast<std::size_t>(cell.x);
    const std::size_t below = at + row;
    return height_on({vertices[at], vertices[at + 1], vertices[below], vertices[below + 1]},
                     x - cell.x, z - cell.y);
  };
  // Planes are lowest at vertices, and where the edges of the square cross the sides of triangles.
  const glm::dvec2 from = low - first, to = high - first;
  double lowest_m = height_m(to.x, to.y);
  const auto look = [&](double x, double z) {
    lowest_m =
        std::min(lowest_m, height_m(std::clamp(x, from.x, to.x), std::clamp(z, from.y, to.y)));
  };
  for (int z = 0; z < size.y; ++z) {
    for (int x = 0; x < size.x; ++x)
      look(x, z);
  }
  const auto diagonal = [](double across) { return 1 - (across - std::floor(across)); };
  for (const double z : {from.y, to.y}) {
    for (int x = 0; x + 1 < size.x; ++x)
      look(x + diagonal(z), z);
  }
  for (const double x : {from.x, to.x}) {
    for (int z = 0; z + 1 < size.y; ++z)
      look(x, z + diagonal(x));
  }
  return lowest_m;
}

void sample_ground(const Parameters& terrain, core::BlockCoord block,
                   std::span<const glm::dvec2> local_xz, std::span<GroundPoint> ground) {
  PSYGEN_CHECK(ground.size() == local_xz.size(), "there is room for every point");
  const core::RoundToNearest rounding;
  const BlockGround all(terrain, block, local_xz.size());
  for (std::size_t i = 0; i < local_xz.size(); ++i)
    ground[i] = all.at(local_xz[i]);
}

// Where heights are kept, a place in the block costs no more than all of the block, once.
double ground_height_m(const Parameters& terrain, core::BlockCoord block, double local_x,
                       double local_z) {
  const core::RoundToNearest rounding;
  const bool keeps = terrain.edits() != nullptr && terrain.edits()->ground.heights != nullptr;
  const double block_m = terrain_block_size_m(terrain);
  const bool inside = local_x >= 0 && local_z >= 0 && local_x < block_m && local_z < block_m;
  const std::size_t points = keeps && inside ? std::size_t{kMaxTerrainSize} * kMaxTerrainSize : 1;
  return BlockGround(terrain, block, points).at({local_x, local_z}).height_m;
}

}  // namespace psygen::models
