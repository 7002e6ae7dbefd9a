#include "engine/models/terrain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/core/assert.hpp"
#include "engine/models/exact_math.hpp"
#include "engine/models/terrain_grid.hpp"
#include "engine/models/terrain_shape.hpp"

namespace psygen::models {
namespace {

constexpr double kInt32Min = std::numeric_limits<std::int32_t>::min();
constexpr double kInt32Max = std::numeric_limits<std::int32_t>::max();
constexpr ParameterType kInteger = ParameterType::kInteger;
constexpr ParameterType kReal = ParameterType::kReal;
constexpr ParameterSource kPlaced = ParameterSource::kPlaced;

constexpr ParameterSpec kSchema[kTerrainParameterCount] = {
    {"seed", kInteger, "", 1, -0x1.0p63, 0x1.0p63, 0, 1000, "which of all terrains", kPlaced},
    {"block_x", kInteger, "blocks", 0, kInt32Min, kInt32Max, -1000, 1000, "block along x", kPlaced},
    {"block_z", kInteger, "blocks", 0, kInt32Min, kInt32Max, -1000, 1000, "block along z", kPlaced},
    {"node_level", kInteger, "", 0, 0, 20, 0, 10,
     "cells are 2^node_level times as wide; blocks are counted in these wider ones", kPlaced},
    {"size", kInteger, "vertices", 64, kMinTerrainSize, kMaxTerrainSize, 16, 128,
     "vertices per side of a block"},
    {"cell_m", kReal, "m", 1, 0.01, 1000, 0.25, 16, "distance between neighbouring vertices"},
    {"height", kReal, "1", 1.2, 0, 4, 0.5, 1.5,
     "fractal increment H: the larger, the smoother; octave o counts lacunarity^(-H o)"},
    {"lacunarity", kReal, "1", 2, 1, 4, 1.5, 3, "ratio of the frequencies of two octaves"},
    {"octaves", kInteger, "", 9, 1, kMaxOctaves, 1, 12, "number of layers of noise"},
    {"offset", kReal, "1", 0.88, 0, 4, 0.7, 1.2, "height of the ridges before squaring"},
    {"gain", kReal, "1", 2, 0, 100, 1, 4, "how much an octave weighs on the next"},
    {"feature_m", kReal, "m", 600, 1, 1e5, 50, 2000, "width of the largest features"},
    {"relief_m", kReal, "m", 120, 0.01, 1e5, 10, 500, "highest height that is possible"},
};

// Sample positions along one axis: every vertex of the level with its neighbours one cell away.
// Vertex k is sample vertex(k); samples are grid positions −1 … size.
struct SampleAxis {
  std::array<std::int64_t, RidgedNoise::kMaxAxis> world;
  std::size_t count = 0;
  std::size_t step;  // samples from one vertex to the next

  SampleAxis(const TerrainGrid& grid, std::int64_t origin, int node_level)
      : step(static_cast<std::size_t>(std::min(grid.stride, 3))) {
    const auto add = [&](int i) {
      world[count++] = static_cast<std::int64_t>(static_cast<std::uint64_t>(origin) +
                                                 (static_cast<std::uint64_t>(i) << node_level));
    };
    if (grid.stride <= 3) {
      for (int i = -1; i <= grid.size; ++i)
        add(i);
      return;
    }
    for (int i = 0; i < grid.size; i += grid.stride) {
      for (const int neighbour : {-1, 0, 1})
        add(i + neighbour);
    }
  }
  std::size_t vertex(std::size_t k) const { return 1 + k * step; }
};

using HeightGrid = std::array<std::uint16_t, kMaxTerrainSize * kMaxTerrainSize>;

// Heights of the next coarser level at the vertices of row z: on its triangles' planes, rounded to
// nearest. `ratio` is the number of cells of this level in a cell of the next.
void coarse_row(const HeightGrid& heights, int n, int ratio, int z, std::uint16_t* out) {
  const int fz = z % ratio;
  // (2·sum + ratio) / (2·ratio) in whole numbers: the added half keeps it away from the next one.
  const double inverse = 0.5 / ratio;
  const auto rounded = [=](int sum) {
    return static_cast<std::uint16_t>(static_cast<std::int32_t>((2 * sum + ratio + 0.5) * inverse));
  };
  const std::uint16_t* const near = heights.data() + (z - fz) * n;
  const std::uint16_t* const far = fz == 0 ? near : near + ratio * n;
  for (int x = 0; x + 1 < n; x += ratio) {
    const int h00 = near[x], h10 = near[x + ratio], h01 = far[x], h11 = far[x + ratio];
    for (int fx = 0; fx < ratio; ++fx) {
      const int sum = fx + fz <= ratio
                          ? h00 * (ratio - fx - fz) + h10 * fx + h01 * fz
                          : h11 * (fx + fz - ratio) + h10 * (ratio - fz) + h01 * (ratio - fx);
      out[x + fx] = rounded(sum);
    }
  }
  const int sum = near[n - 1] * (ratio - fz) + far[n - 1] * fz;
  out[n - 1] = rounded(sum);
}

// One row of samples as separate arrays: the vertices and their neighbours one cell away.
struct SampleRow {
  std::array<float, kMaxTerrainSize> west, east, north, south;

  SampleRow(const float* centre, std::size_t samples_per_row, std::size_t step, std::size_t n) {
    const float *const up = centre - samples_per_row, *const down = centre + samples_per_row;
    for (std::size_t x = 0; x < n; ++x) {
      west[x] = centre[static_cast<std::ptrdiff_t>(x * step) - 1];
      east[x] = centre[x * step + 1];
      north[x] = up[x * step];
      south[x] = down[x * step];
    }
  }
  // Octahedral normals of the row; `scale` turns the difference of two samples into a slope.
  void normals(float scale, std::size_t n, std::int8_t* out_x, std::int8_t* out_z) const {
    for (std::size_t x = 0; x < n; ++x) {
      const float nx = (west[x] - east[x]) * scale;
      const float nz = (north[x] - south[x]) * scale;
      const float to_snorm8 = 127.0F / (std::abs(nx) + 1.0F + std::abs(nz));
      out_x[x] = static_cast<std::int8_t>(static_cast<std::int32_t>(nx * to_snorm8 + 128.5F) - 128);
      out_z[x] = static_cast<std::int8_t>(static_cast<std::int32_t>(nz * to_snorm8 + 128.5F) - 128);
    }
  }
};

class TerrainType final : public ModelType {
 public:
  std::string_view name() const override { return "terrain"; }
  std::string_view doc() const override {
    return "ground of one block: ridged multifractal heightfield (Musgrave)";
  }
  std::span<const ParameterSpec> parameters() const override { return kSchema; }
  int level_count() const override { return kTerrainLevels; }
  bool may_run_on_main_thread() const override { return true; }
  double level_error_m(const Parameters& p, int level) const override;
  core::Bounds bounds(const Parameters& p) const override;
  MeshSize mesh_size(const Parameters& p, int level) const override;
  double complexity(const Parameters& p, int level) const override;
  double log2_cost(const Parameters& p) const override;
  core::Bounds synthesize(const Parameters& p, int level, const MeshView& out) const override;
  void write_shared_indices(std::uint32_t id, std::span<std::uint16_t> out) const override {
    TerrainGrid::of_index_list(id).write_indices(out);
  }
};

TerrainGrid grid_of(const Parameters& p, int level) {
  return {static_cast<int>(p.integer(kTerrainSize)), level};
}

double cell_of(const Parameters& p) {
  return std::ldexp(p.real(kTerrainCellM), static_cast<int>(p.integer(kTerrainNodeLevel)));
}

// An octave of wavelength λ and amplitude A (half a ridge's height counts) leaves A · d/λ when it
// is sampled d apart, at most A.
double TerrainType::level_error_m(const Parameters& p, int level) const {
  const TerrainShape shape(p);
  const double gap = (grid_of(p, level).stride - 1) * shape.cell_m;
  const double ratio = exact_pow(p.real(kTerrainLacunarity), -p.real(kTerrainHeight));
  const double offset = p.real(kTerrainOffset);
  double amplitude = 0.5 * std::max(offset * offset, (offset - 1) * (offset - 1)) *
                     p.real(kTerrainReliefM) / shape.noise.max_value();
  double wavelength = p.real(kTerrainFeatureM);
  double error = 0;
  for (std::int64_t o = 0; o < p.integer(kTerrainOctaves); ++o) {
    error += amplitude * std::min(1.0, gap / wavelength);
    amplitude *= ratio;
    wavelength /= p.real(kTerrainLacunarity);
  }
  return error;
}

core::Bounds TerrainType::bounds(const Parameters& p) const {
  const auto side = static_cast<float>(terrain_block_size_m(p));
  return {{0, 0, 0}, {side, static_cast<float>(p.real(kTerrainReliefM)), side}};
}

MeshSize TerrainType::mesh_size(const Parameters& p, int level) const {
  const TerrainGrid grid = grid_of(p, level);
  return {grid.surface_vertices() + grid.border_vertices(), grid.triangles() * 3, grid.index_list(),
          core::VertexLayout::kTerrain};
}

double TerrainType::complexity(const Parameters& p, int level) const {
  const TerrainGrid grid = grid_of(p, level);
  const double samples_per_side = std::min(3 * grid.n, grid.size);
  return static_cast<double>(p.integer(kTerrainOctaves)) * samples_per_side * samples_per_side;
}

double TerrainType::log2_cost(const Parameters& p) const {
  const double cells = std::max(static_cast<double>(p.integer(kTerrainSize)) - 1, 1.0);
  return 1 + std::log2(cells) + std::log2(cells + 4);  // with skirts
}

core::Bounds TerrainType::synthesize(const Parameters& p, int level, const MeshView& out) const {
  const TerrainShape shape(p);
  const TerrainGrid grid = grid_of(p, level);
  PSYGEN_CHECK(out.vertices.size() ==
                   (grid.surface_vertices() + grid.border_vertices()) * sizeof(core::TerrainVertex),
               "the destination has exactly the size of the mesh");
  const SampleAxis columns(grid, shape.block_origin(p.integer(kTerrainBlockX)), shape.node_level);
  const SampleAxis rows(grid, shape.block_origin(p.integer(kTerrainBlockZ)), shape.node_level);
  constexpr std::size_t kMaxSamples = kMaxTerrainSize + 2;
  std::array<float, kMaxSamples * kMaxSamples> noise;
  const std::size_t stride = columns.count;
  shape.noise.evaluate({columns.world.data(), columns.count}, {rows.world.data(), rows.count},
                       noise, stride);

  const auto n = static_cast<std::size_t>(grid.n);
  HeightGrid heights;
  for (std::size_t z = 0; z < n; ++z) {
    const float* const row = &noise[rows.vertex(z) * stride + columns.vertex(0)];
    for (std::size_t x = 0; x < n; ++x)
      heights[z * n + x] = shape.quantise(row[x * columns.step]);
  }
  const int coarser = TerrainGrid(grid.size, std::min(level + 1, kTerrainLevels - 1)).stride;
  const float slope_scale = shape.metres / static_cast<float>(2 * shape.cell_m);
  std::array<core::TerrainVertex, kMaxTerrainSize * kMaxTerrainSize> vertices;
  std::array<std::uint16_t, kMaxTerrainSize> coarse;
  std::array<std::int8_t, kMaxTerrainSize> normal_x, normal_z;
  for (std::size_t z = 0; z < n; ++z) {
    coarse_row(heights, grid.n, coarser / grid.stride, static_cast<int>(z), coarse.data());
    SampleRow(&noise[rows.vertex(z) * stride + columns.vertex(0)], stride, columns.step, n)
        .normals(slope_scale, n, normal_x.data(), normal_z.data());
    for (std::size_t x = 0; x < n; ++x)
      vertices[z * n + x] = {static_cast<std::uint8_t>(x * static_cast<std::size_t>(grid.stride)),
                             static_cast<std::uint8_t>(z * static_cast<std::size_t>(grid.stride)),
                             heights[z * n + x],
                             coarse[x],
                             normal_x[x],
                             normal_z[x]};
  }
  std::memcpy(out.vertices.data(), vertices.data(), n * n * sizeof(core::TerrainVertex));
  std::byte* skirt = out.vertices.data() + n * n * sizeof(core::TerrainVertex);
  for (std::uint32_t k = 0; k < grid.border_vertices(); ++k) {
    core::TerrainVertex twin = vertices[grid.border_vertex(k)];
    twin.grid_x |= core::kTerrainSkirtBit;
    std::memcpy(skirt, &twin, sizeof twin);
    skirt += sizeof twin;
  }
  const auto [lowest, highest] = std::minmax_element(heights.begin(), heights.begin() + n * n);
  core::Bounds box = bounds(p);
  box.min.y = shape.relief_m * (static_cast<float>(*lowest) / 65535.0F);
  box.max.y = shape.relief_m * (static_cast<float>(*highest) / 65535.0F);
  return box;
}

RidgedSettings settings_of(const Parameters& p) {
  return {.seed = static_cast<std::uint64_t>(p.integer(kTerrainSeed)),
          .height = p.real(kTerrainHeight),
          .lacunarity = p.real(kTerrainLacunarity),
          .octaves = static_cast<int>(p.integer(kTerrainOctaves)),
          .offset = p.real(kTerrainOffset),
          .gain = p.real(kTerrainGain),
          .cells_per_step = p.real(kTerrainCellM) / p.real(kTerrainFeatureM)};
}

}  // namespace

TerrainShape::TerrainShape(const Parameters& p)
    : noise(settings_of(p)),
      size(static_cast<int>(p.integer(kTerrainSize))),
      node_level(static_cast<int>(p.integer(kTerrainNodeLevel))),
      cell_m(cell_of(p)),
      relief_m(static_cast<float>(p.real(kTerrainReliefM))),
      quantum(static_cast<float>(65535.0 / noise.max_value())),
      metres(static_cast<float>(p.real(kTerrainReliefM) / noise.max_value())) {}

std::unique_ptr<ModelType> make_terrain_type() {
  return std::make_unique<TerrainType>();
}

std::uint32_t terrain_surface_triangles(const Parameters& terrain, int level) {
  return grid_of(terrain, level).surface_triangles();
}

double terrain_block_size_m(const Parameters& terrain) {
  return static_cast<double>(terrain.integer(kTerrainSize) - 1) * cell_of(terrain);
}

}  // namespace psygen::models
