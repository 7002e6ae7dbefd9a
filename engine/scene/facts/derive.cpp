#include "engine/scene/facts/derive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "engine/core/cancellation.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/log.hpp"
#include "engine/models/terrain/ground_patch.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/models/water/water_surface.hpp"
#include "engine/scene/facts/levels.hpp"
#include "engine/scene/facts/lighting.hpp"
#include "engine/scene/facts/solidity.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/far/tree_impostors.hpp"
#include "engine/world/placement.hpp"

namespace psygen::scene {
namespace {

// Maximum number of nodes of a level: they lie in a disc, and in the world.
double max_nodes(const world::World& world, double radius, std::size_t level) {
  const auto along = [&](std::int64_t blocks) {
    const double window = 2 * radius + 1;
    return blocks == 0 ? window : std::min(window, static_cast<double>(nodes_along(blocks, level)));
  };
  return std::min(std::numbers::pi * radius * radius,
                  along(world.blocks_x) * along(world.blocks_z));
}

// Checks the maximum number of nodes and models, and of cells of the windows, before allocating
// any.
core::Result<void> check_size(const world::World& world, std::span<const NodeLevel> levels,
                              const SceneSettings& settings) {
  const double models = static_cast<double>(world::models_per_block(world));
  double entities = 0, places = 0;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const double radius = window_radius(levels, settings, k);
    entities += max_nodes(world, radius, k) * (k == 0 ? 1 + models : 2);
    const double side = 2.0 * largest_radius(world, levels, settings, k) + 1;
    places += side * side;
  }
  if (places > kMaxPlaces) {
    return core::fail(
        core::ErrorCode::kOverBudget,
        fmt::format(
            "a view of {:.0f} m over blocks of {:g} m (block_vertices, cell_m) needs places "
            "for {:.3g} nodes; at most {:.0f} are allowed",
            settings.view_distance_m, world.block_size_m(), places, kMaxPlaces));
  }
  if (entities <= kMaxEntities) return {};
  return core::fail(
      core::ErrorCode::kOverBudget,
      fmt::format(
          "a view of {:.0f} m over blocks of {:g} m (block_vertices, cell_m) with {} models "
          "each (count) needs {:.3g} entities; at most {:.0f} are allowed",
          settings.view_distance_m, world.block_size_m(), world::models_per_block(world), entities,
          kMaxEntities));
}

std::uint64_t hash_of_names(const models::Registry& registry) {
  std::uint64_t hash = registry.size();
  for (models::ModelIndex i = 0; i < registry.size(); ++i)
    hash = core::hash_bytes(std::as_bytes(std::span(registry[i].name())), hash);
  return hash;
}

// The instances per block of each scatter whose places are the same as before.
std::vector<std::optional<double>> known_placed(const world::WorldParts& parts,
                                                const DerivedWorldData* before) {
  std::vector<std::optional<double>> known(before != nullptr ? parts.places.size() : 0);
  for (std::size_t s = 0; s < std::min(known.size(), before ? before->placed.size() : 0); ++s) {
    if (parts.places[s] == before->parts.places[s]) known[s] = before->placed[s];
  }
  return known;
}

// Derives the levels of the quadtree, far forests, and the type of merged meshes.
core::Result<void> find_levels(const SceneSettings& settings, WorldFacts& facts,
                               const DerivedWorldData* before) {
  const models::ModelType* merged = nullptr;
  const auto world = std::make_shared<const world::World>(facts.world);
  const auto scatters = world::far_scatters(world, facts.registry,
                                            before != nullptr ? before->scatters.get() : nullptr);
  DerivedWorldData derived{
      world::parts_of(*world, facts.registry), 0, scatters, {}, {}, facts.pictures};
  if (settings.levels_of_detail) {
    const auto added = facts.registry.add(
        world::make_merged_type(world, facts.registry, facts.pictures, scatters));
    if (!added) return tl::unexpected(added.error());
    facts.merged_model = *added;
    merged = &facts.registry[*added];
  }
  const bool same_ground = before != nullptr && before->parts.ground == derived.parts.ground;
  facts.levels = node_levels(facts.world, facts.registry, settings, merged,
                             same_ground ? before->levels : std::span<const NodeLevel>{});
  const auto size = static_cast<int>(facts.world.terrain.integer(models::kTerrainSize));
  for (int level = 0; level < models::kTerrainLevels; ++level)
    facts.grids.emplace_back(size, level);
  if (facts.levels[0].mesh_level != 0) facts.tiles.emplace(size);
  const auto known = known_placed(derived.parts, before);
  derived.placed = world::placed_per_block(facts.world, facts.registry, known);
  for (std::size_t s = 0; s < derived.placed.size(); ++s) {
    const world::Scatter& scatter = facts.world.scatter[s];
    if (scatter.count > 0 && derived.placed[s] == 0 && (s >= known.size() || !known[s]))
      core::log_warning(fmt::format(
          "scatter[{}] ({}): none of its {} instances finds a place on {} blocks; limits or "
          "spacing may leave none",
          s, facts.registry[scatter.model].name(), scatter.count, world::kSizeBlocks));
  }
  const world::FarCover cover = world::far_cover(facts.world, *scatters, derived.placed);
  facts.canopy = canopy_of(facts.world, cover.albedo);
  facts.cover_share = cover.share;
  derived.types = hash_of_names(facts.registry);
  derived.levels = facts.levels;
  facts.derived = std::make_shared<const DerivedWorldData>(std::move(derived));
  return {};
}

// Finds the impostors of trees and adds the types that bake and show them to the registry. A world
// has none without levels of detail, and none with data amplification, which makes all levels of
// all meshes once. Reuses the measurements of `before` (may be null). Fails as Registry::add().
core::Result<void> find_pictures(const SceneSettings& settings, WorldFacts& facts,
                                 const world::ImpostorSet* before) {
  if (settings.paradigm == Paradigm::kDataAmplification || !settings.levels_of_detail) return {};
  auto pictures = std::make_shared<const world::ImpostorSet>(facts.world, facts.registry, before);
  if (pictures->count() == 0) return {};
  const std::size_t types = facts.registry.size();
  const auto baked = facts.registry.add(world::make_impostor_type());
  if (!baked) return tl::unexpected(baked.error());
  facts.picture_model = *baked;
  facts.quad_models.assign(types, 0);
  for (std::size_t i = 0; i < types; ++i) {
    const auto model = static_cast<models::ModelIndex>(i);
    if (!pictures->has(model)) continue;
    const auto quads = facts.registry.add(world::make_quad_type(pictures, facts.registry, model));
    if (!quads) return tl::unexpected(quads.error());
    facts.quad_models[i] = *quads;
  }
  for (std::size_t i = 0; i < pictures->count(); ++i)
    facts.picture_parameters.push_back(world::picture_parameters(i));
  facts.pictures = std::move(pictures);
  return {};
}

// Measured models of each type.
constexpr std::size_t kSamples = 8;
constexpr core::Bounds kWhole{glm::vec3(-1.0F), glm::vec3(1.0F)};

std::optional<core::Bounds> tight_box(const models::ModelType& type,
                                      const models::Parameters& parameters) {
  const int level = std::max(type.level_count_of(parameters) - 1, 0);
  const auto destination = synthesis::HeapDestination::make(type, parameters, level);
  if (!destination) return std::nullopt;
  const synthesis::SynthesisOutcome outcome =
      synthesis::synthesise_guarded(type, parameters, level, destination->view());
  if (!outcome.ok) return std::nullopt;
  return outcome.tight;
}

constexpr std::size_t kNodesPerLevel = 2, kPerType = 24;
constexpr int kMaxBlocks = 48;

// Takes models block by block until there are enough of each type.
class ModelSamples {
 public:
  explicit ModelSamples(const WorldFacts& facts)
      : facts_(facts), taken_(facts.registry.size(), 0) {}

  void take(core::BlockCoord block, std::vector<synthesis::CostSample>& samples) {
    world::place_models(facts_.world, facts_.registry, block, placements_);
    for (const world::Placement& placement : placements_) {
      if (taken_[placement.model]++ < kPerType)
        samples.push_back({placement.model, placement.parameters});
    }
  }
  bool complete() const {
    return std::ranges::all_of(facts_.world.scatter, [this](const world::Scatter& scatter) {
      return scatter.count == 0 || taken_[scatter.model] >= kPerType;
    });
  }

 private:
  const WorldFacts& facts_;
  std::vector<std::size_t> taken_;
  std::vector<world::Placement> placements_;
};

}  // namespace

core::Result<void> derive(const SceneSettings& settings, bool pictures, WorldFacts& facts,
                          const DerivedWorldData* before) {
  WorldFacts given;
  given.world = std::move(facts.world);
  given.registry = std::move(facts.registry);
  given.given_types = facts.given_types;
  facts = std::move(given);
  if (facts.given_types == 0) facts.given_types = facts.registry.size();
  facts.registry.shrink(facts.given_types);
  const world::World& world = facts.world;
  facts.light = light_of(world, settings.view_distance_m);
  facts.palette = palette_of(world);
  facts.models_per_block = static_cast<std::uint32_t>(world::models_per_block(world));
  facts.cell_m = static_cast<float>(world.cell_m());
  facts.scattered_reach_m = world::models_reach_m(world, facts.registry);
  facts.models_reach_m = facts.scattered_reach_m;
  facts.standing = obstacles_on_block(world, facts.registry);
  if (pictures) {
    const world::ImpostorSet* known = before != nullptr ? before->pictures.get() : nullptr;
    if (auto ok = find_pictures(settings, facts, known); !ok) return ok;
  }
  if (auto ok = core::check_cancelled(); !ok) return ok;
  if (auto ok = find_levels(settings, facts, before); !ok) return ok;
  const auto water = facts.registry.add(models::make_water_type());
  if (!water) return tl::unexpected(water.error());
  facts.water_model = *water;
  if (world.shaped.layer && world.shaped.layer->ground.network) {
    const auto patch = facts.registry.add(models::make_ground_patch_type());
    if (!patch) return tl::unexpected(patch.error());
    facts.patch_model = *patch;
  }
  return check_size(world, facts.levels, settings);
}

std::vector<core::Bounds> typical_bounds(const models::Registry& registry,
                                         std::span<const synthesis::CostSample> samples) {
  std::vector<std::optional<core::Bounds>> found(registry.size());
  std::vector<std::size_t> taken(registry.size(), 0);
  for (const synthesis::CostSample& sample : samples) {
    if (taken[sample.model]++ >= kSamples) continue;
    const models::ModelType& type = registry[sample.model];
    const core::Bounds whole = type.bounds(sample.parameters);
    const core::Bounds tight = tight_box(type, sample.parameters).value_or(whole);
    const glm::vec3 extent = glm::max(whole.half_extent(), glm::vec3(1e-6F));
    const core::Bounds part{glm::clamp((tight.min - whole.centre()) / extent, -1.0F, 1.0F),
                            glm::clamp((tight.max - whole.centre()) / extent, -1.0F, 1.0F)};
    std::optional<core::Bounds>& all = found[sample.model];
    all = all ? core::united(*all, part) : part;
  }
  std::vector<core::Bounds> boxes;
  for (const std::optional<core::Bounds>& box : found)
    boxes.push_back(box.value_or(kWhole));
  return boxes;
}

std::vector<synthesis::CostSample> cost_samples(const WorldFacts& facts) {
  core::RandomStream random(0, 0, 0, 0, core::Purpose::kParameters);
  const SampleBlocks blocks(facts.world);
  std::vector<synthesis::CostSample> samples;
  for (std::size_t k = 0; k < facts.levels.size(); ++k) {
    for (std::size_t i = 0; i < kNodesPerLevel; ++i) {
      const auto level = static_cast<std::uint8_t>(k);
      const visibility::NodeCoord node = visibility::node_of(blocks.next(random, level), level);
      samples.push_back({facts.world.terrain_model, node_terrain(facts.world, node)});
      if (facts.levels[k].merged)
        samples.push_back({facts.merged_model, world::merged_parameters(node.coord, level)});
    }
  }
  ModelSamples models(facts);
  for (int i = 0; i < kMaxBlocks && !models.complete(); ++i)
    models.take(blocks.next(random), samples);
  return samples;
}

std::vector<synthesis::CostSample> models_on(const WorldFacts& facts, core::BlockCoord block) {
  std::vector<synthesis::CostSample> samples;
  ModelSamples(facts).take(block, samples);
  return samples;
}

}  // namespace psygen::scene
