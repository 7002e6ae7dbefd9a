#include "engine/amplify/block_synthesiser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "engine/core/rounding.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/synthesis/synthesise.hpp"

namespace psygen::amplify {
namespace {

// Hash of the mesh data that is neither in its bytes nor in its key.
std::uint64_t frame_hash(const world::Placement& placement, const models::MeshSize& size,
                         const core::Bounds& tight) {
  const glm::vec3& at = placement.position;
  const float frame[] = {at.x,        at.y,        at.z,        tight.min.x, tight.min.y,
                         tight.min.z, tight.max.x, tight.max.y, tight.max.z};
  const std::uint64_t counts = (std::uint64_t{size.vertex_count} << 32) | size.index_count;
  return core::hash_bytes(std::as_bytes(std::span(frame)), counts);
}

}  // namespace

void Totals::add(const Totals& part) {
  blocks += part.blocks;
  models += part.models;
  triangles += part.triangles;
  bytes += part.bytes;
  failed += part.failed;
  if (first_failure.empty()) first_failure = part.first_failure;
  hash.add(part.hash);
}

BlockSynthesiser::BlockSynthesiser(const world::World& world, const models::Registry& registry,
                                   int level)
    : world_(world), registry_(registry), level_(level) {}

models::MeshView BlockSynthesiser::room_for(const models::MeshSize& size) {
  const std::size_t vertex_bytes = size.vertex_bytes(), own_indices = size.own_index_count();
  const std::size_t vertex_lines = lines_of(vertex_bytes);
  const std::size_t needed = vertex_lines + lines_of(own_indices * sizeof(std::uint16_t));
  if (needed > line_count_) {
    line_count_ = std::bit_ceil(needed);
    memory_.reset();
    memory_ = std::make_unique_for_overwrite<CacheLine[]>(line_count_);
  }
  return {{reinterpret_cast<std::byte*>(memory_.get()), vertex_bytes},
          {reinterpret_cast<std::uint16_t*>(memory_.get() + vertex_lines), own_indices}};
}

void BlockSynthesiser::synthesise(core::BlockCoord block, Totals& totals,
                                  const std::function<void(const BlockMesh&)>& visit) {
  const core::RoundToNearest rounding;
  const world::Placement terrain{world_.terrain_model, world::kTerrainIndex, glm::vec3(0.0F),
                                 world::terrain_parameters(world_, block)};
  const bool made = make_levels(terrain, block, totals, visit);
  if (made && level_ == 0) {  // the memory still has the terrain
    const models::BlockGround ground(world_.terrain, block,
                                     std::as_bytes(std::span(memory_.get(), line_count_)));
    world::place_models(world_, registry_, block, ground, placements_);
  } else {
    world::place_models(world_, registry_, block, placements_);
  }
  for (const world::Placement& placement : placements_)
    make_levels(placement, block, totals, visit);
  ++totals.blocks;
  totals.models += placements_.size();
}

bool BlockSynthesiser::make_levels(const world::Placement& placement, core::BlockCoord block,
                                   Totals& totals,
                                   const std::function<void(const BlockMesh&)>& visit) {
  const int coarsest = registry_[placement.model].level_count_of(placement.parameters) - 1;
  const int first = level_ == kAllLevels ? 0 : std::min(level_, coarsest);
  const int last = level_ == kAllLevels ? coarsest : first;
  const std::uint64_t failed = totals.failed;
  for (int level = first; level <= last; ++level)
    make(placement, block, level, totals, visit);
  return totals.failed == failed;
}

void BlockSynthesiser::make(const world::Placement& placement, core::BlockCoord block, int level,
                            Totals& totals, const std::function<void(const BlockMesh&)>& visit) {
  const models::ModelType& type = registry_[placement.model];
  const auto size = synthesis::mesh_size_guarded(type, placement.parameters, level);
  const auto fail = [&totals](const std::string& why) {
    ++totals.failed;
    if (totals.first_failure.empty()) totals.first_failure = why;
  };
  if (!size) return fail(size.error().message);
  const models::MeshView view = room_for(*size);
  const auto outcome = synthesis::synthesise_guarded(type, placement.parameters, level, view);
  if (!outcome.ok) return fail(outcome.error);
  totals.triangles += placement.index == world::kTerrainIndex
                          ? models::terrain_surface_triangles(placement.parameters, level)
                          : size->triangle_count();
  totals.bytes += view.vertices.size() + view.indices.size_bytes();
  const std::uint64_t content = synthesis::content_hash(
      {block, placement.index, placement.model, static_cast<std::uint16_t>(level),
       models::parameters_hash(type, placement.parameters)},
      view);
  totals.hash.add(core::combine(content, frame_hash(placement, *size, outcome.tight)));
  if (visit) visit({placement, level, *size, outcome.tight, view});
}

std::optional<std::uint64_t> sample_world_hash(const world::World& world,
                                               const models::Registry& registry,
                                               core::BlockCoord block) {
  BlockSynthesiser synthesiser(world, registry, kAllLevels);
  Totals totals;
  for (std::int64_t z = std::int64_t{block.z} - 1; z <= std::int64_t{block.z} + 1; ++z) {
    for (std::int64_t x = std::int64_t{block.x} - 1; x <= std::int64_t{block.x} + 1; ++x) {
      const core::BlockCoord coord{static_cast<std::int32_t>(x), static_cast<std::int32_t>(z)};
      const bool exists = coord.x == x && coord.z == z && world.contains(coord);
      if (exists) synthesiser.synthesise(coord, totals);
    }
  }
  if (totals.failed > 0) return std::nullopt;
  return totals.hash.value();
}

}  // namespace psygen::amplify
