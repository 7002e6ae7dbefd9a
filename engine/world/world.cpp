#include "engine/world/world.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "engine/core/hash.hpp"
#include "engine/models/edits.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/water.hpp"

namespace psygen::world {
namespace {

// Mean size of one instance of a scatter. `first` is the index of its first instance in a block.
// The samples are real instances of the world, from consecutive blocks.
struct MeanSize {
  double triangles = 0, bytes = 0;
};
MeanSize mean_size(const World& world, const models::Registry& registry, const Scatter& scatter,
                   std::uint32_t first) {
  MeanSize sum;
  for (std::uint32_t k = 0; k < kSizeSamples; ++k) {
    const core::BlockCoord block{static_cast<std::int32_t>(k / scatter.count), 0};
    const models::Parameters p =
        draw_parameters(world, registry, scatter, block, first + k % scatter.count);
    const models::MeshSize size = registry[scatter.model].mesh_size(p, 0);
    sum.triangles += size.triangle_count();
    sum.bytes += static_cast<double>(size.bytes());
  }
  return {sum.triangles / kSizeSamples, sum.bytes / kSizeSamples};
}

// The next block along x, or one before where the world ends.
core::BlockCoord beside(const World& world, core::BlockCoord block) {
  const bool ends = world.blocks_x > 0 && block.x + 1 >= world.blocks_x;
  return {ends ? std::max(block.x - 1, 0) : block.x + 1, block.z};
}

}  // namespace

std::uint64_t site_hash(const SiteRules& site) {
  if (!site.limits_places()) return 0;
  std::uint64_t hash = core::mix64(site.beside + 1);
  for (const double rule :
       {site.min_slope_deg, site.facing_deg, site.facing_spread_deg, site.far_from_water_m,
        site.max_above_water_m, site.far_from_road_m, site.near_road_m, site.beside_m})
    hash = core::combine(hash, std::bit_cast<std::uint64_t>(rule + 0.0));
  return std::max<std::uint64_t>(hash, 1);
}

double World::block_size_m() const {
  return models::terrain_block_size_m(terrain);
}

double World::cell_m() const {
  return terrain.real(models::kTerrainCellM);
}

core::WorldPosition rebased(const core::WorldPosition& at, double from_m, double to_m) {
  if (from_m == to_m) return at;
  return core::normalised({{}, core::offset_m(at.block, {}, from_m) + at.local}, to_m);
}

double surface_height_m(const World& world, const core::WorldPosition& at) {
  const double ground_m = models::ground_height_m(world.terrain, at.block, at.local.x, at.local.z);
  return std::max(ground_m, water_at(world, at, ground_m).surface_m);
}

void set_edits(World& world, std::shared_ptr<const models::EditLayer> edits) {
  static const models::EditLayer none;
  const models::EditLayer& below = world.shaped.layer ? *world.shaped.layer : none;
  if (edits && !edits->ground.has_function_of(below.ground)) {
    models::EditLayer layer = *edits;
    layer.ground.take_function_of(below.ground);
    edits = std::make_shared<const models::EditLayer>(std::move(layer));
  }
  world.edits = std::move(edits);
  // Without a hash: only for a node is it known which edits matter (placement.hpp).
  world.terrain.set_edits(world.layer().get(), 0);
}

Palette drawn_palette(const World& world) {
  Palette palette = world.palette;
  if (world.water.exists())
    palette.sand_end_m = std::max(palette.sand_end_m, world.water.level_m + world.water.shore_m);
  return palette;
}

bool World::has_costly_heights() const {
  return shaped.layer != nullptr && shaped.layer->ground.has_fixed_part();
}

const models::RiverNetwork* World::network() const {
  return layer() != nullptr ? layer()->ground.network.get() : nullptr;
}

bool World::contains(core::BlockCoord block) const {
  const auto inside = [](std::int32_t index, std::int64_t count) {
    return count == 0 || (index >= 0 && index < count);
  };
  return inside(block.x, blocks_x) && inside(block.z, blocks_z);
}

std::vector<double> placed_per_block(const World& world, const models::Registry& registry,
                                     std::span<const std::optional<double>> known) {
  std::vector<double> counts;
  std::vector<bool> wanted;
  bool filtered = !world.shaped.roads.empty() || world.shaped.has_water();
  for (const Scatter& scatter : world.scatter) {
    const std::size_t s = counts.size();
    wanted.push_back(s >= known.size() || !known[s]);
    counts.push_back(wanted[s] ? scatter.count : *known[s]);
    filtered = filtered || scatter.has_filter() || scatter.keeps_apart();
  }
  if (!filtered || std::ranges::find(wanted, true) == wanted.end()) return counts;
  for (std::size_t s = 0; s < counts.size(); ++s)
    counts[s] = wanted[s] ? 0 : counts[s];
  std::vector<Placement> placements;
  // The land of a river network takes milliseconds for each place far from others.
  constexpr std::uint32_t kTogether = 16;
  core::BlockCoord last;
  for (std::uint32_t k = 0; k < kSizeBlocks; ++k) {
    core::RandomStream random(world.seed, 0, 0, k, core::Purpose::kStructure);
    const auto coordinate = [&random](std::int64_t blocks) {
      return static_cast<std::int32_t>(random.next_integer(0, (blocks == 0 ? 65536 : blocks) - 1));
    };
    core::BlockCoord block{coordinate(world.blocks_x), 0};
    block.z = coordinate(world.blocks_z);
    if (world.shaped.network && k % kTogether != 0) block = beside(world, last);
    last = block;
    place_models(world, registry, block, wanted, placements);
    for (const Placement& placement : placements) {
      if (placement.index >= kPlacedIndex) continue;
      std::size_t s = 0;
      for (std::uint32_t first = 0; placement.index - first >= world.scatter[s].count; ++s)
        first += world.scatter[s].count;
      counts[s] += 1.0 / kSizeBlocks;
    }
  }
  return counts;
}

WorldSize world_size(const World& world, const models::Registry& registry) {
  WorldSize size;
  size.endless = world.is_endless();
  size.blocks = size.endless ? 0
                             : static_cast<std::uint64_t>(world.blocks_x) *
                                   static_cast<std::uint64_t>(world.blocks_z);
  size.block_triangles = models::terrain_surface_triangles(world.terrain, 0);
  size.block_bytes =
      static_cast<double>(registry[world.terrain_model].mesh_size(world.terrain, 0).bytes());
  const std::vector<double> counts = placed_per_block(world, registry);
  std::uint32_t first = 0;
  for (std::size_t s = 0; s < world.scatter.size(); ++s) {
    const Scatter& scatter = world.scatter[s];
    if (scatter.count == 0) continue;
    const MeanSize mean = mean_size(world, registry, scatter, first);
    size.block_models += counts[s];
    size.block_triangles += counts[s] * mean.triangles;
    size.block_bytes += counts[s] * mean.bytes;
    first += scatter.count;
  }
  const auto blocks = static_cast<double>(size.blocks);
  const double all_models = blocks * size.block_models + 0.5;
  size.models = all_models < 0x1.0p64 ? static_cast<std::uint64_t>(all_models) : UINT64_MAX;
  size.triangles = blocks * size.block_triangles;
  size.bytes = blocks * size.block_bytes;
  size.bytes_paper = size.triangles * 256;
  return size;
}

}  // namespace psygen::world
