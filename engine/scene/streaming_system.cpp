// Keeps one entity per block of the window around the camera, and one per model on it: created and
// destroyed in batches, nearest first, within a time budget per tick.
#include <algorithm>
#include <cmath>

#include "engine/core/clock.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {
namespace {

Placed placed_at(core::BlockCoord block, glm::vec3 position, const core::Bounds& box) {
  Placed placed;
  placed.block = block;
  placed.position = position;
  placed.box_center = box.center();
  placed.box_half_extent = box.half_extent();
  placed.radius_m = glm::length(placed.box_half_extent);
  return placed;
}

Detail detail_of(const models::ModelType& type, const models::Parameters& parameters) {
  Detail detail;
  detail.level_count =
      std::min<std::uint32_t>(static_cast<std::uint32_t>(type.level_count()), kMaxLevels);
  for (std::uint32_t level = 0; level < detail.level_count; ++level) {
    detail.error_m[level] =
        static_cast<float>(type.level_error_m(parameters, static_cast<int>(level)));
  }
  return detail;
}

// Fills row `i` of the shared columns of blocks and models.
template <class Created>
void fill(const Created& created, std::size_t i, const models::Registry& registry,
          core::BlockCoord block, const world::Placement& placement) {
  const models::ModelType& type = registry[placement.model];
  created.template column<Placed>()[i] =
      placed_at(block, placement.position, type.bounds(placement.parameters));
  created.template column<Detail>()[i] = detail_of(type, placement.parameters);
  created.template column<Source>()[i] = {placement.parameters,
                                          models::parameters_hash(type, placement.parameters),
                                          placement.index, placement.model};
}

void create_block(const WorldFacts& facts, core::BlockCoord coord,
                  std::vector<world::Placement>& scratch, Streaming& streaming,
                  ecs::World& entities) {
  const auto created =
      entities.create<Block, ecs::Children, Visibility, Placed, Detail, Source, Demand, Mesh>(1);
  created.template column<Block>()[0] = {coord};
  fill(created, 0, facts.registry, coord,
       {facts.world.terrain_model, kTerrainIndex, glm::vec3(0.0F),
        world::terrain_parameters(facts.world, coord)});
  const ecs::Entity block = created.entities[0];
  streaming.grid.entity_of(coord) = block;

  world::place_models(facts.world, facts.registry, coord, scratch);
  const auto models = entities.create<Placed, Detail, Source, Demand, Mesh>(scratch.size());
  for (std::size_t i = 0; i < scratch.size(); ++i) {
    fill(models, i, facts.registry, coord, scratch[i]);
  }
  entities.set_children(block, models.entities);
}

// Their meshes stay in the cache while there is room: the camera may come back.
void destroy_leaving_blocks(Streaming& streaming, ecs::World& entities,
                            synthesis::GeometryCache& cache, Counters& counters) {
  std::vector<ecs::Entity> leaving;
  const BlockGrid& grid = streaming.grid;
  entities.each<const Block>([&](std::span<const ecs::Entity> rows, std::span<const Block> blocks) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!grid.contains(blocks[i].coord)) leaving.push_back(rows[i]);
    }
  });
  counters.blocks_destroyed += static_cast<std::uint32_t>(leaving.size());
  const auto give_back = [&](std::span<const ecs::Entity>, std::span<const Demand> demands,
                             std::span<const Mesh> meshes) {
    for (std::size_t i = 0; i < demands.size(); ++i) {
      if (demands[i].drawn_level == kNoLevel) continue;
      cache.set_rank(meshes[i].handle, synthesis::Rank::unwanted());
    }
  };
  entities.each_of<const Demand, const Mesh>(leaving, give_back);
  for (const ecs::Entity block : leaving)
    entities.each_of<const Demand, const Mesh>(entities.children(block), give_back);
  entities.destroy_with_children(leaving);
}

void list_missing_blocks(const WorldFacts& facts, const ecs::World& entities,
                         Streaming& streaming) {
  streaming.missing.clear();
  const BlockGrid& grid = streaming.grid;
  for (std::uint32_t row = 0; row < grid.side(); ++row) {
    for (std::uint32_t column = 0; column < grid.side(); ++column) {
      const core::BlockCoord coord = grid.coord_at(column, row);
      if (facts.world.contains(coord) && !entities.alive(grid.entity_of(coord))) {
        streaming.missing.push_back(coord);
      }
    }
  }
  const auto distance_squared = [centre = grid.centre()](core::BlockCoord c) {
    const auto dx = static_cast<std::int32_t>(static_cast<std::uint32_t>(c.x) -
                                              static_cast<std::uint32_t>(centre.x));
    const auto dz = static_cast<std::int32_t>(static_cast<std::uint32_t>(c.z) -
                                              static_cast<std::uint32_t>(centre.z));
    return std::int64_t{dx} * dx + std::int64_t{dz} * dz;
  };
  std::ranges::sort(streaming.missing, std::greater{}, distance_squared);
}

}  // namespace

void streaming_system(const Settings& settings, const Camera& camera, const WorldFacts& facts,
                      Streaming& streaming, ecs::World& entities, Synthesis& synthesis,
                      Counters& counters) {
  const core::BlockCoord centre = camera.pose.position.block;
  if (!streaming.centred || centre != streaming.grid.centre()) {
    streaming.grid.set_centre(centre);
    streaming.centred = true;
    destroy_leaving_blocks(streaming, entities, *synthesis.cache, counters);
    list_missing_blocks(facts, entities, streaming);
  }
  const double start_s = core::monotonic_seconds();
  std::vector<world::Placement> scratch;
  while (!streaming.missing.empty()) {
    create_block(facts, streaming.missing.back(), scratch, streaming, entities);
    streaming.missing.pop_back();
    ++counters.blocks_created;
    if (settings.paradigm == Paradigm::kLazyEvaluation) continue;  // all of it, in every frame
    if ((core::monotonic_seconds() - start_s) * 1000.0 > settings.streaming_budget_ms) break;
  }
}

}  // namespace psygen::scene
