#include "engine/scene/facts/levels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/core/vertex_layout.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/visibility/quadtree.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/far/node_walk.hpp"
#include "engine/world/placement.hpp"

namespace psygen::scene {
namespace {

constexpr double kMinSplitRatio = 0.6, kMaxSplitRatio = 3.0;
constexpr double kMergeFactor = 1.1;
// Children exist within this multiple of the split distance of their parent, and nodes of the
// coarsest level within this multiple of the view distance.
constexpr double kAheadFactor = 1.1;
// The error of a terrain level is the sum of the amplitudes that its octaves can lose. The largest
// error in a block of the paper's world is 0.9 of that sum, and 1.1 to 2.5 in nodes of level 1 to 7
// (medians of 60 each). The largest of 16 each in four worlds are 1.6 and 3.2.
constexpr double kBlockBound = 1.75, kNodeBound = 3.5;
// Height of skirts, in metres per metre of the error bound, and its minimum.
constexpr float kSkirtPerBound = 0.8F, kMinSkirtM = 1.0F;
// Error of a merged mesh of level 1, as a fraction of the height of its models; it doubles with
// each level.
constexpr double kMergedErrorPerHeight = 0.06;
// Forests are more than a colour up to this distance, however large the allowed error is: models
// missing beyond the last merged meshes count as this error, up to 3 sides of the node.
constexpr double kForestsSeenM = 3000;
// Finite, and larger than all distances.
constexpr double kEverywhereM = 1e30;

int count_of_levels(const world::World& world, const SceneSettings& settings) {
  if (!settings.levels_of_detail) return 1;
  const auto side = [&](int level) { return std::ldexp(world.block_size_m(), level); };
  const std::int64_t blocks =
      world.is_endless() ? INT32_MAX : std::max(world.blocks_x, world.blocks_z);
  int top = 0;
  while (top < visibility::kMaxNodeLevel / 2 && 2 * side(top) < settings.view_distance_m &&
         (std::int64_t{1} << top) < blocks)
    ++top;
  return top + 1;
}

constexpr int kNodes = 16;           // measured nodes of each level
constexpr int kNodesOfNetworks = 6;  // the same in worlds where each costs a millisecond or more
constexpr double kUsualPlaces = 95;  // percent

// Adds the distance of each vertex from the next coarser surface, in units of 1/65535 of the height
// range. Every second vertex of every second row lies on that surface.
void add_distances(std::span<const core::TerrainVertex> vertices,
                   std::vector<std::uint16_t>& distances) {
  for (const core::TerrainVertex& v : vertices) {
    if ((v.grid_x & core::kTerrainSkirtBit) != 0) continue;
    distances.push_back(static_cast<std::uint16_t>(std::abs(int{v.height} - int{v.coarse_height})));
  }
}

core::BlockCoord block_on_land(const world::World& world) {
  constexpr std::int32_t kTries = 24, kStep = 64;
  for (std::int32_t i = 0; i < kTries; ++i) {
    const core::BlockCoord block = nearest_block(world, {i * kStep, i * kStep / 2});
    if (models::ground_height_m(world.terrain, block, 0, 0) > world.water.level_m) return block;
  }
  return nearest_block(world, {});
}

}  // namespace

models::Parameters node_terrain(const world::World& world, const visibility::NodeCoord& node) {
  return world::terrain_parameters(world, node.coord, node.level);
}

SampleBlocks::SampleBlocks(const world::World& world)
    : world_(world), land_(world.shaped.network ? block_on_land(world) : core::BlockCoord{}) {}

core::BlockCoord SampleBlocks::next(core::RandomStream& random, std::uint32_t level) const {
  if (world_.shaped.network) {
    constexpr std::int64_t kNodes = 4;
    const auto beside = [&](std::int32_t first) {
      return static_cast<std::int32_t>(
          static_cast<std::uint32_t>(first) +
          (static_cast<std::uint32_t>(random.next_integer(0, kNodes - 1)) << level));
    };
    const std::int32_t x = beside(land_.x);
    return nearest_block(world_, {x, beside(land_.z)});
  }
  constexpr std::int64_t kEndlessReach = 4096;
  const auto index = [&](std::int64_t blocks) {
    return static_cast<std::int32_t>(blocks > 0
                                         ? random.next_integer(0, blocks - 1)
                                         : random.next_integer(-kEndlessReach, kEndlessReach));
  };
  const std::int32_t x = index(world_.blocks_x);
  return {x, index(world_.blocks_z)};
}

core::BlockCoord nearest_block(const world::World& world, core::BlockCoord block) {
  const auto nearest = [](std::int32_t index, std::int64_t count) {
    return count == 0 ? index
                      : static_cast<std::int32_t>(std::clamp<std::int64_t>(index, 0, count - 1));
  };
  return {nearest(block.x, world.blocks_x), nearest(block.z, world.blocks_z)};
}

bool contains(const world::World& world, const visibility::NodeCoord& node) {
  const core::BlockCoord corner = visibility::corner_block(node);
  const std::int64_t side = std::int64_t{1} << node.level;
  const auto inside = [side](std::int64_t first, std::int64_t count) {
    return count == 0 || (first + side > 0 && first < count);
  };
  return inside(corner.x, world.blocks_x) && inside(corner.z, world.blocks_z);
}

bool overhangs(const world::World& world, const visibility::NodeCoord& node) {
  const core::BlockCoord corner = visibility::corner_block(node);
  const std::int64_t side = std::int64_t{1} << node.level;
  const auto beyond = [side](std::int64_t first, std::int64_t count) {
    return count != 0 && (first < 0 || first + side > count);
  };
  return beyond(corner.x, world.blocks_x) || beyond(corner.z, world.blocks_z);
}

std::vector<NodeLevel> node_levels(const world::World& world, const models::Registry& registry,
                                   const SceneSettings& settings, const models::ModelType* merged,
                                   std::span<const NodeLevel> before) {
  const models::ModelType& terrain = registry[world.terrain_model];
  const int mesh_level = settings.levels_of_detail ? world::node_mesh_level(world) : 0;
  std::vector<NodeLevel> levels(static_cast<std::size_t>(count_of_levels(world, settings)));
  std::optional<SampleBlocks> blocks;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    NodeLevel& level = levels[k];
    const models::Parameters p = node_terrain(world, {{}, static_cast<std::uint8_t>(k)});
    level.size_m = std::ldexp(world.block_size_m(), static_cast<int>(k));
    level.mesh_level = static_cast<std::uint16_t>(mesh_level);
    level.bounds = terrain.bounds(p);
    // Morphs and neighbours meet ground of the two next coarser details.
    const double details_m = models::terrain_detail_errors_m(p, 2).bound_m;
    level.ground_bound_m =
        (k == 0 ? kBlockBound : kNodeBound) * terrain.level_error_m(p, 1) + details_m;
    if (k >= before.size() && !blocks) blocks.emplace(world);
    level.ground_error_m = k < before.size()
                               ? before[k].ground_error_m
                               : measured_ground_error_m(*blocks, registry, static_cast<int>(k));
    if (k > 0) {
      const double lost_m = models::terrain_detail_errors_m(p, -static_cast<int>(k)).usual_m;
      level.ground_error_m = std::max({level.ground_error_m, levels[k - 1].ground_error_m, lost_m});
    }
    if (details_m > 0) level.ground_bound_m = std::max(level.ground_bound_m, level.ground_error_m);
    level.error_m = level.ground_error_m;
    level.skirt_m = kMinSkirtM + kSkirtPerBound * static_cast<float>(level.ground_bound_m) +
                    (1 - kSkirtPerBound) * static_cast<float>(details_m);
    if (merged == nullptr || k == 0 || k > world::kMaxMergedLevel) continue;
    const auto scattered = world::scattered_bounds(*merged, static_cast<int>(k));
    level.merged = scattered.has_value();
    if (!level.merged) continue;
    const double height_m = scattered->max.y - level.bounds.max.y;
    level.error_m = std::max(level.error_m,
                             kMergedErrorPerHeight * std::ldexp(height_m, static_cast<int>(k) - 1));
  }
  count_placed(world, levels);
  return levels;
}

void count_placed(const world::World& world, std::span<NodeLevel> levels) {
  for (std::size_t k = 1; k < levels.size(); ++k)
    levels[k].placed_error_m = world::placed_error_m(world, static_cast<int>(k));
}

void split_distances(std::span<const NodeLevel> levels, const SceneSettings& settings,
                     double pixels_per_radian, double error_pixels,
                     std::vector<visibility::LevelDistances>& distances) {
  distances.resize(levels.size());
  std::vector<double> errors;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const bool leaves_out = k == world::kMaxMergedLevel + 1 && levels[k - 1].merged;
    const double least = leaves_out ? kForestsSeenM * error_pixels / pixels_per_radian : 0.0;
    errors.push_back(std::max({levels[k].error_m, levels[k].placed_error_m, least}));
  }
  visibility::SplitSettings split;
  split.block_size_m = levels[0].size_m;
  split.pixels_per_radian = pixels_per_radian;
  split.max_error_pixels = error_pixels;
  split.min_ratio = kMinSplitRatio;
  split.max_ratio = kMaxSplitRatio;
  split.merge_factor = kMergeFactor;
  visibility::split_distances(errors, split, distances);
  // Blocks use their finest mesh only where its error requires it.
  const double seen_m =
      std::min(errors[0] * pixels_per_radian / error_pixels, kMaxSplitRatio * levels[0].size_m);
  const double fine_m = settings.levels_of_detail ? seen_m : kEverywhereM;
  distances[0] = {fine_m, fine_m * kMergeFactor, fine_m * split.morph_share};
}

visibility::CutInput cut_input(const world::World& world, std::span<const NodeLevel> levels,
                               const core::WorldPosition& camera,
                               std::span<const visibility::LevelDistances> distances,
                               double view_distance_m, std::vector<visibility::NodeCoord>& roots) {
  visibility::CutInput input;
  input.camera = camera;
  input.block_size_m = world.block_size_m();
  input.levels = distances;
  input.view_distance_m = view_distance_m;
  input.world = {
      {}, static_cast<std::uint32_t>(world.blocks_x), static_cast<std::uint32_t>(world.blocks_z)};
  visibility::roots_around(camera, input.block_size_m, view_distance_m,
                           static_cast<std::uint8_t>(levels.size() - 1), roots, input.world);
  input.roots = roots;
  return input;
}

double existing_distance_m(std::span<const NodeLevel> levels, const SceneSettings& settings,
                           std::size_t level,
                           std::span<const visibility::LevelDistances> distances) {
  // The camera moves within its block before the windows are listed again.
  const double step_m = std::numbers::sqrt2 / 2 * levels[0].size_m;
  if (level + 1 >= levels.size()) return kAheadFactor * settings.view_distance_m + step_m;
  const double split_m = distances[level + 1].merge_m * kAheadFactor;
  return std::min(split_m, settings.view_distance_m) + step_m;
}

std::uint32_t window_radius(std::span<const NodeLevel> levels, const SceneSettings& settings,
                            std::size_t level) {
  std::vector<visibility::LevelDistances> farthest(levels.size());
  double below_m = 0;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const double split_m = std::max(kMaxSplitRatio * levels[k].size_m, below_m);
    farthest[k] = {split_m, kMergeFactor * split_m, split_m};
    below_m = farthest[k].merge_m + std::numbers::sqrt2 * levels[k].size_m;
  }
  return window_radius(levels, settings, level, farthest);
}

std::uint32_t window_radius(std::span<const NodeLevel> levels, const SceneSettings& settings,
                            std::size_t level,
                            std::span<const visibility::LevelDistances> distances) {
  const double reach_m = existing_distance_m(levels, settings, level, distances);
  // A parent at that distance may extend one more node beyond, and the camera may be anywhere in
  // its own node.
  return static_cast<std::uint32_t>(std::ceil(reach_m / levels[level].size_m)) + 2;
}

std::uint32_t largest_radius(const world::World& world, std::span<const NodeLevel> levels,
                             const SceneSettings& settings, std::size_t level) {
  const std::int64_t radius = window_radius(levels, settings, level);
  if (world.is_endless()) return static_cast<std::uint32_t>(radius);
  const std::int64_t most =
      nodes_along(std::max(world.blocks_x, world.blocks_z), level) - 1;  // to the other end
  return static_cast<std::uint32_t>(std::min(radius, most));
}

double measured_ground_error_m(const SampleBlocks& blocks, const models::Registry& registry,
                               int node_level) {
  const world::World& world = blocks.world();
  const models::ModelType& terrain = registry[world.terrain_model];
  core::RandomStream random(world.seed, 0, 0, static_cast<std::uint32_t>(node_level),
                            core::Purpose::kParameters);
  std::vector<std::byte> vertices;
  std::vector<std::uint16_t> indices;
  std::vector<std::uint16_t> distances;
  const int count = world.shaped.network ? kNodesOfNetworks : kNodes;
  for (int i = 0; i < count; ++i) {
    const visibility::NodeCoord node =
        visibility::node_of(blocks.next(random, static_cast<std::uint32_t>(node_level)),
                            static_cast<std::uint8_t>(node_level));
    const models::Parameters p = node_terrain(world, node);
    const models::MeshSize size = terrain.mesh_size(p, 0);
    vertices.resize(size.vertex_count * sizeof(core::TerrainVertex));
    indices.resize(size.own_index_count());
    terrain.synthesise(p, 0, {vertices, indices});
    add_distances(core::vertices_of<core::TerrainVertex>(vertices), distances);
  }
  const auto usual =
      distances.begin() +
      static_cast<std::ptrdiff_t>(static_cast<double>(distances.size() - 1) * kUsualPlaces / 100);
  std::nth_element(distances.begin(), usual, distances.end());
  return *usual / 65535.0 * world.terrain.real(models::kTerrainReliefM);
}

}  // namespace psygen::scene
