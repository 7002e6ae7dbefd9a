#include "engine/models/terrain/terrain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/assert.hpp"
#include "engine/core/rounding.hpp"
#include "engine/core/vertex_layout.hpp"
#include "engine/models/edits.hpp"
#include "engine/models/kit/exact_math.hpp"
#include "engine/models/kit/scratch.hpp"
#include "engine/models/terrain/grid.hpp"
#include "engine/models/terrain/kernel.hpp"
#include "engine/models/terrain/light.hpp"
#include "engine/models/terrain/shape.hpp"

namespace psygen::models {
namespace {

// Distance in cells over which normals take slopes, to both sides of a vertex. Where heights are
// costly, coarse nodes take them over the vertices of level 1: fewer samples by the square of its
// stride.
int normal_reach(const TerrainGrid& grid, const TerrainShape& shape) {
  const bool costly = shape.stack != nullptr && shape.stack->has_fixed_part();
  if (!costly || shape.node_level == 0 || grid.stride == 1) return 1;
  return terrain_strides(grid.size)[1];
}

// Sample positions along one axis: every vertex of the level, and its neighbours `reach` cells
// away. Vertex k is sample vertex(k). Samples are grid positions −reach … size − 1 + reach.
struct SampleAxis {
  std::array<std::int64_t, RidgedNoise::kMaxAxis> world;
  std::size_t count = 0;
  std::size_t step;  // samples from one vertex to the next

  SampleAxis(const TerrainGrid& grid, const TerrainShape& shape, std::int64_t block, int reach)
      : step(static_cast<std::size_t>(std::min(grid.stride / reach, 3))) {
    const auto add = [&](int i) { world[count++] = shape.world_of(block, i); };
    if (grid.stride <= 3 * reach) {
      for (int i = -reach; i < grid.size + reach; i += reach)
        add(i);
      return;
    }
    for (int i = 0; i < grid.size; i += grid.stride) {
      for (const int neighbour : {-reach, 0, reach})
        add(i + neighbour);
    }
  }
  std::size_t vertex(std::size_t k) const { return 1 + k * step; }
};

class TerrainType final : public ModelType {
 public:
  std::string_view name() const override { return "terrain"; }
  std::string_view doc() const override {
    return "ground of one block: ridged multifractal heightfield (Musgrave)";
  }
  std::span<const ParameterSpec> parameters() const override { return kTerrainSchema; }
  int level_count() const override { return kTerrainLevels; }
  bool may_run_on_main_thread() const override { return true; }
  double level_error_m(const Parameters& p, int level) const override;
  core::Bounds bounds(const Parameters& p) const override;
  MeshSize mesh_size(const Parameters& p, int level) const override;
  double complexity(const Parameters& p, int level) const override;
  double steps(const Parameters& p, int level) const override;
  double step_seconds() const override { return 0.6e-9; }
  double log2_cost(const Parameters& p) const override;
  core::Bounds synthesise(const Parameters& p, int level, const MeshView& out) const override;
  void write_shared_indices(std::uint32_t id, std::span<std::uint16_t> out) const override {
    TerrainGrid::of_index_list(id).write_indices(out);
  }
};

TerrainGrid grid_of(const Parameters& p, int level) {
  return {static_cast<int>(p.integer(kTerrainSize)), level};
}

// Returns the number of the finest grid of light for a level (TerrainLight).
std::size_t light_grid_of(int level) {
  return level < 2 ? 0 : 1;
}

// The samples of the parent's mesh of level 1 under a node's mesh of level 1: every second of the
// node's own vertices, and the next one beyond if the parent has none at the node's border.
struct ParentSamples {
  static constexpr std::size_t kStride = (kMaxTerrainSize + 1) / 2 + 1;
  std::array<float, kStride * kStride> noise;
  CoarseSamples view;

  ParentSamples(const TerrainShape& shape, const TerrainGrid& grid, std::int64_t block_x,
                std::int64_t block_z) {
    const Axis columns(shape, grid, block_x), rows(shape, grid, block_z);
    shape.evaluate({columns.world.data(), columns.count}, {rows.world.data(), rows.count}, noise,
                   kStride, GroundDetail::of_node(shape.node_level + 1));
    view = {noise.data(), kStride, 1, 2, columns.phase, rows.phase};
  }

 private:
  struct Axis {
    std::array<std::int64_t, kStride> world;
    std::size_t count;
    std::size_t phase;  // 1 if the first sample is one vertex before the node

    Axis(const TerrainShape& shape, const TerrainGrid& grid, std::int64_t block)
        : phase(static_cast<std::size_t>(block & (grid.n - 1) & 1)) {
      count = (static_cast<std::size_t>(grid.n) + phase) / 2 + 1;
      for (std::size_t i = 0; i < count; ++i) {
        const std::int64_t vertex = static_cast<std::int64_t>(2 * i) - static_cast<int>(phase);
        world[i] = shape.world_of(block, vertex * grid.stride);
      }
    }
  };
};

// An octave of wavelength λ and amplitude A (half of a ridge's height) has the error A · d/λ, at
// most A, when it is sampled d apart. Amplitudes add up to half the relief.
double TerrainType::level_error_m(const Parameters& p, int level) const {
  const TerrainShape shape(p);
  const double gap = (grid_of(p, level).stride - 1) * shape.cell_m;
  const double ratio = exact_pow(p.real(kTerrainLacunarity), -p.real(kTerrainHeight));
  double amplitude = 1, amplitudes = 0;
  double wavelength = p.real(kTerrainFeatureM);
  double error = 0;
  for (std::int64_t o = 0; o < p.integer(kTerrainOctaves); ++o) {
    error += amplitude * std::min(1.0, gap / wavelength);
    amplitudes += amplitude;
    amplitude *= ratio;
    wavelength /= p.real(kTerrainLacunarity);
  }
  return 0.5 * p.real(kTerrainReliefM) * error / amplitudes;
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

// Counts the samples of a mesh, and those of the parent's.
double sample_count(const TerrainGrid& grid, int level, int reach) {
  const double side = grid.stride <= 3 * reach ? (grid.size - 1) / reach + 3 : 3 * grid.n;
  const double parent = level == 1 ? grid.n / 2 + 1 : 0;
  return side * side + parent * parent;
}

// The work of the noise and of edits: the samples, those of the parent's mesh, and the heights for
// the light.
// Nodes whose octaves are narrower than their cells take five times as long as blocks.
double TerrainType::steps(const Parameters& p, int level) const {
  const TerrainShape shape(p);
  const TerrainGrid grid = grid_of(p, level);
  const auto n = static_cast<std::size_t>(grid.n);
  const int reach = normal_reach(grid, shape);
  const double cell = std::ldexp(1.0, shape.node_level), near = cell * reach;
  double work = 0;
  if (grid.stride <= 3 * reach) {
    const auto samples = static_cast<std::size_t>((grid.size - 1) / reach) + 3;
    work = shape.noise.work(samples, samples, near);
  } else {  // groups of a vertex and its two neighbours, with gaps between the groups
    work = (2 * shape.noise.work(3 * n, 3 * n, near) +
            shape.noise.work(3 * n, 3 * n, cell * (grid.stride - 2 * reach))) /
           3;
  }
  if (level == 1) work += shape.noise.work(n / 2 + 1, n / 2 + 1, 2 * grid.stride * cell);
  const std::int64_t x = p.integer(kTerrainBlockX), z = p.integer(kTerrainBlockZ);
  work += shape.layer_work({shape.world_of(x, -1), shape.world_of(x, grid.size)},
                           {shape.world_of(z, -1), shape.world_of(z, grid.size)},
                           sample_count(grid, level, reach), shape.detail());
  return work + TerrainLight::work(shape,
                                   {p.real(kTerrainSunAzimuth), p.real(kTerrainSunElevation)}, x, z,
                                   light_grid_of(level));
}

double TerrainType::log2_cost(const Parameters& p) const {
  const double cells = std::max(static_cast<double>(p.integer(kTerrainSize)) - 1, 1.0);
  return 1 + std::log2(cells) + std::log2(cells + 4);  // with skirts
}

// The vertices of a mesh along one axis, in metres from a point of the world.
struct MeshAxis {
  double first_m, step_m;
  std::int64_t count;
  // The vertices within a distance of a coordinate: the first, and the one after the last.
  std::int64_t begin(double at_m) const { return limited(std::ceil((at_m - first_m) / step_m)); }
  std::int64_t end(double at_m) const { return limited(std::floor((at_m - first_m) / step_m) + 1); }
  double at(std::int64_t i) const { return first_m + static_cast<double>(i) * step_m; }

 private:
  std::int64_t limited(double i) const {
    return static_cast<std::int64_t>(std::clamp(i, 0.0, static_cast<double>(count)));
  }
};

MeshAxis axis_from(const TerrainShape& shape, const TerrainGrid& grid, std::int64_t node,
                   std::int32_t origin_block, double origin_local_m) {
  const double cell_m = std::ldexp(shape.cell_m, -shape.node_level);
  const std::int64_t cells =
      shape.world_of(node, 0) - std::int64_t{origin_block} * (shape.size - 1);
  return {static_cast<double>(cells) * cell_m - origin_local_m, shape.cell_m * grid.stride, grid.n};
}

// The bytes of TerrainVertex::road and wet of all surface vertices.
struct GroundMarks {
  std::vector<std::uint8_t> road, wet;
};

// Calls visit(vertex, place) for the vertices in the square of an edit; `place` is in metres from
// its origin.
template <class Visit>
void each_vertex_of(const TerrainShape& shape, const TerrainGrid& grid, core::BlockCoord node,
                    const GroundEdit& edit, const Visit& visit) {
  const core::WorldPosition& centre = edit.centre;
  const core::WorldPosition& origin = edit.origin();
  const MeshAxis near_x = axis_from(shape, grid, node.x, centre.block.x, centre.local.x);
  const MeshAxis near_z = axis_from(shape, grid, node.z, centre.block.z, centre.local.z);
  const MeshAxis x = axis_from(shape, grid, node.x, origin.block.x, origin.local.x);
  const MeshAxis z = axis_from(shape, grid, node.z, origin.block.z, origin.local.z);
  for (std::int64_t k = near_z.begin(-edit.radius_m); k < near_z.end(edit.radius_m); ++k) {
    for (std::int64_t i = near_x.begin(-edit.radius_m); i < near_x.end(edit.radius_m); ++i)
      visit(static_cast<std::size_t>(k * grid.n + i), glm::dvec2(x.at(i), z.at(k)));
  }
}

void raise_to(std::uint8_t& mark, double share) {
  mark = std::max(mark, static_cast<std::uint8_t>(std::clamp(share, 0.0, 1.0) * 255 + 0.5));
}

// The strip of gravel beside a river or lake, and the wet part of it, in metres above the surface.
constexpr double kGravelM = 1.2, kWetM = 0.5, kGravelShare = 0.55;

// Marks beds and banks: gravel looks as a road does. `height_m`: of a vertex.
template <class Height>
void mark_water(const GroundEdit& edit, std::size_t vertex, glm::dvec2 place_m,
                const Height& height_m, GroundMarks& marks) {
  const auto surface =
      edit.river ? surface_of(*edit.river, place_m) : surface_of(*edit.lake, place_m);
  if (!surface) return;
  const double above_m = height_m(vertex) - surface->surface_m;
  raise_to(marks.road[vertex], kGravelShare * (1 - above_m / kGravelM));
  raise_to(marks.wet[vertex], 1 - above_m / kWetM);
}

// Writes the marks of all surface vertices if a road, a river or a lake passes the node, so that
// the shader draws roads, gravel and wet banks. `vertices` is a whole mesh; it is only written to.
// Linear in the vertices near these.
template <class Height>
void mark_ground(const TerrainShape& shape, const TerrainGrid& grid, core::BlockCoord node,
                 const Height& height_m, std::byte* vertices) {
  if (shape.stack == nullptr) return;
  const double block_m = (shape.size - 1) * std::ldexp(shape.cell_m, -shape.node_level);
  const auto at = QuadCoord::of(node, static_cast<std::uint32_t>(shape.node_level));
  const auto roads = shape.stack->roads_in(at, block_m), water = shape.stack->water_in(at, block_m);
  if (roads.empty() && water.empty()) return;
  GroundMarks marks{std::vector<std::uint8_t>(grid.surface_vertices()),
                    std::vector<std::uint8_t>(grid.surface_vertices())};
  for (const GroundEdit* edit : roads)
    each_vertex_of(shape, grid, node, *edit, [&](std::size_t vertex, glm::dvec2 place_m) {
      raise_to(marks.road[vertex], road_share(*edit->road, place_m));
    });
  for (const GroundEdit* edit : water)
    each_vertex_of(shape, grid, node, *edit, [&](std::size_t vertex, glm::dvec2 place_m) {
      mark_water(*edit, vertex, place_m, height_m, marks);
    });
  for (std::size_t i = 0; i < grid.surface_vertices(); ++i) {
    std::byte* const vertex = vertices + i * sizeof(core::TerrainVertex);
    vertex[offsetof(core::TerrainVertex, road)] = static_cast<std::byte>(marks.road[i]);
    vertex[offsetof(core::TerrainVertex, wet)] = static_cast<std::byte>(marks.wet[i]);
  }
}

core::Bounds TerrainType::synthesise(const Parameters& p, int level, const MeshView& out) const {
  const core::RoundToNearest rounding;
  const TerrainShape shape(p);
  const TerrainGrid grid = grid_of(p, level);
  PSYGEN_CHECK(out.vertices.size() ==
                   (grid.surface_vertices() + grid.border_vertices()) * sizeof(core::TerrainVertex),
               "the destination has exactly the size of the mesh");
  const int reach = normal_reach(grid, shape);
  const SampleAxis columns(grid, shape, p.integer(kTerrainBlockX), reach);
  const SampleAxis rows(grid, shape, p.integer(kTerrainBlockZ), reach);
  constexpr std::size_t kMaxStride = RidgedNoise::kMaxAxis;
  const Scratch<std::array<float, kMaxStride*(kMaxTerrainSize + 2) + 16>> scratch;
  const std::span<float> noise = *scratch;
  const std::size_t stride = (columns.count + 15) / 16 * 16;  // rows start at cache lines
  shape.evaluate({columns.world.data(), columns.count}, {rows.world.data(), rows.count}, noise,
                 stride, shape.detail());
  const TerrainLight light(shape, {p.real(kTerrainSunAzimuth), p.real(kTerrainSunElevation)},
                           p.integer(kTerrainBlockX), p.integer(kTerrainBlockZ),
                           light_grid_of(level));
  const float* const first = &noise[rows.vertex(0) * stride + columns.vertex(0)];
  std::optional<ParentSamples> parent;
  if (level == 1) parent.emplace(shape, grid, p.integer(kTerrainBlockX), p.integer(kTerrainBlockZ));
  const auto ratio = static_cast<std::size_t>(
      TerrainGrid(grid.size, std::min(level + 1, kTerrainLevels - 1)).stride / grid.stride);
  const HeightRange heights = pack_terrain(
      {.first = first,
       .row_stride = stride,
       .step = columns.step,
       .n = static_cast<std::size_t>(grid.n),
       .stride = static_cast<std::size_t>(grid.stride),
       .coarse =
           parent ? parent->view : CoarseSamples{first, stride, columns.step * ratio, ratio, 0, 0},
       .light = light.samples(),
       .quantum = shape.quantum,
       .slope_scale = shape.metres / static_cast<float>(2 * reach * shape.cell_m)},
      out.vertices.data());
  const auto n = static_cast<std::size_t>(grid.n);
  const auto height_m = [&](std::size_t vertex) {
    return static_cast<double>(
        first[vertex / n * columns.step * stride + vertex % n * columns.step] * shape.metres);
  };
  mark_ground(shape, grid,
              {static_cast<std::int32_t>(p.integer(kTerrainBlockX)),
               static_cast<std::int32_t>(p.integer(kTerrainBlockZ))},
              height_m, out.vertices.data());
  core::Bounds box = bounds(p);
  box.min.y = shape.relief_m * (static_cast<float>(heights.lowest) / 65535.0F);
  box.max.y = shape.relief_m * (static_cast<float>(heights.highest) / 65535.0F);
  return box;
}

}  // namespace

std::unique_ptr<ModelType> make_terrain_type() {
  return std::make_unique<TerrainType>();
}

std::uint32_t terrain_surface_triangles(const Parameters& terrain, int level) {
  return grid_of(terrain, level).surface_triangles();
}

double terrain_block_size_m(const Parameters& terrain) {
  return static_cast<double>(terrain.integer(kTerrainSize) - 1) *
         std::ldexp(terrain.real(kTerrainCellM),
                    static_cast<int>(terrain.integer(kTerrainNodeLevel)));
}

}  // namespace psygen::models
