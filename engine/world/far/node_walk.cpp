#include "engine/world/far/node_walk.hpp"

#include <algorithm>
#include <cmath>

#include "engine/models/terrain/grid.hpp"
#include "engine/models/terrain/terrain.hpp"

namespace psygen::world {
namespace {

constexpr std::size_t kMany = 65'536;  // expected calls of at(), enough to evaluate all heights
// Meshes of nodes have at least this many triangles; otherwise they use the next finer level.
constexpr std::uint32_t kFewestTriangles = 98;

// Every other bit of `v`, from bit 0 on.
std::uint32_t even_bits(std::uint32_t v) {
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < 16; ++i)
    bits |= ((v >> (2 * i)) & 1U) << i;
  return bits;
}

std::int32_t shifted(std::int32_t index, int levels, std::uint32_t offset) {
  return static_cast<std::int32_t>((static_cast<std::uint32_t>(index) << levels) + offset);
}

glm::dvec2 metres(std::uint32_t x, std::uint32_t z, double block_size_m) {
  return glm::dvec2(x, z) * block_size_m;
}

}  // namespace

int tile_level(const World& world, int node_level) {
  const auto has_limits = [](const Scatter& scatter) { return scatter.has_filter(); };
  if (node_level <= 2) return 0;
  const bool cheap = !world.has_costly_heights() && world.terrain.real(models::kTerrainWarp) == 0;
  if (cheap && std::ranges::any_of(world.scatter, has_limits)) return 0;
  return node_level - (world.has_costly_heights() ? 1 : 2);
}

std::uint32_t ground_tiles(const World& world, int node_level) {
  return 1U << (2 * (node_level - tile_level(world, node_level)));
}

int node_mesh_level(const World& world) {
  return models::terrain_surface_triangles(world.terrain, 1) >= kFewestTriangles ? 1 : 0;
}

NodeWalk::NodeWalk(const World& world, core::BlockCoord node, int node_level)
    : world_(world), node_(node), level_(node_level), tile_(tile_level(world, node_level)) {}

NodeBlock NodeWalk::block(std::uint32_t ordinal) const {
  const std::uint32_t x = even_bits(ordinal), z = even_bits(ordinal >> 1);
  const std::uint32_t in_tile = (1U << tile_) - 1;
  const double size = world_.block_size_m();
  return {{shifted(node_.x, level_, x), shifted(node_.z, level_, z)},
          ordinal,
          metres(x, z, size),
          metres(x & in_tile, z & in_tile, size)};
}

void NodeWalk::make_ground(std::uint32_t ordinal, std::size_t questions,
                           std::optional<models::BlockGround>& out) const {
  models::Parameters terrain = world_.terrain;
  terrain.set_integer(models::kTerrainNodeLevel, tile_);
  const std::uint32_t x = even_bits(ordinal) >> tile_, z = even_bits(ordinal >> 1) >> tile_;
  const core::BlockCoord tile{shifted(node_.x, level_ - tile_, x),
                              shifted(node_.z, level_ - tile_, z)};
  out.emplace(terrain, tile, questions);
}

models::BlockGround NodeWalk::whole_ground(const models::EditLayer* edits) const {
  models::Parameters terrain = world_.terrain;
  if (edits != nullptr) terrain.set_edits(edits, 0);
  terrain.set_integer(models::kTerrainNodeLevel, level_);
  return {terrain, node_, kMany};
}

int NodeWalk::drawn_stride() const {
  const auto size = static_cast<int>(world_.terrain.integer(models::kTerrainSize));
  return models::terrain_strides(size)[static_cast<std::size_t>(node_mesh_level(world_))];
}

}  // namespace psygen::world
