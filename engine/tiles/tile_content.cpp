#include "engine/tiles/tile_content.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "engine/amplify/block_files.hpp"
#include "engine/exchange/unpack.hpp"
#include "engine/exchange/water_object.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/placement.hpp"

namespace psygen::tiles {
namespace {

// The length of skirts, as a multiple of their node's error.
constexpr double kSkirtErrors = 2;

// Drops triangles without area, which represent models that found no position, and the vertices
// that no other triangle uses.
void drop_empty_triangles(exchange::Part& part) {
  exchange::Part kept{part.material, {}, {}, {}, {}};
  std::vector<std::uint32_t> places(part.positions.size(), UINT32_MAX);
  for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
    const std::uint32_t a = part.indices[i], b = part.indices[i + 1], c = part.indices[i + 2];
    const glm::vec3 &pa = part.positions[a], &pb = part.positions[b], &pc = part.positions[c];
    if (pa == pb || pb == pc || pc == pa) continue;
    for (const std::uint32_t vertex : {a, b, c}) {
      if (places[vertex] == UINT32_MAX) {
        places[vertex] = static_cast<std::uint32_t>(kept.positions.size());
        kept.positions.push_back(part.positions[vertex]);
        kept.normals.push_back(part.normals[vertex]);
        kept.colours.push_back(part.colours[vertex]);
      }
      kept.indices.push_back(places[vertex]);
    }
  }
  part = std::move(kept);
}

}  // namespace

TileMaker::TileMaker(const world::World& world, const models::Registry& registry)
    : world_(world),
      registry_(registry),
      merged_(world::make_merged_type(std::make_shared<const world::World>(world), registry)) {}

TileMaker::~TileMaker() = default;

double TileMaker::error_m(int node_level) const {
  return std::ldexp(world_.cell_m(), node_level);
}

core::Result<exchange::Object> TileMaker::object(const models::ModelType& type,
                                                 const models::Parameters& p, float skirt_m) const {
  const auto mesh = synthesis::HeapDestination::make(type, p, 0);
  if (!mesh) return tl::unexpected(mesh.error());
  const auto outcome = synthesis::synthesise_guarded(type, p, 0, mesh->view());
  if (!outcome.ok) return core::fail(core::ErrorCode::kSynthesisFailed, outcome.error);
  return exchange::unpack(type, p, 0, mesh->size(), mesh->view(), world::drawn_palette(world_),
                          skirt_m);
}

core::Result<exchange::Document> TileMaker::document(const TileTree& tree, const Tile& tile) const {
  const int level = tree.node_level(tile);
  const core::BlockCoord node = tree.node(tile);
  const auto skirt_m = static_cast<float>(kSkirtErrors * error_m(level));
  exchange::Document document{"tile", {}, {}};
  auto ground = object(registry_[world_.terrain_model],
                       world::terrain_parameters(world_, node, level), skirt_m);
  if (!ground) return tl::unexpected(ground.error());
  if (level == 0) {
    auto block = amplify::block_document(world_, registry_, node, 0);
    if (!block) return block;
    document = std::move(*block);
    document.objects.front() = std::move(*ground);
  } else {
    document.objects.push_back(std::move(*ground));
    if ((level <= world::kMaxMergedLevel && world::scattered_bounds(*merged_, level)) ||
        world::has_placed(world_, node, level)) {
      auto models = object(*merged_, world::merged_parameters(world_, node, level), 0);
      if (!models) return tl::unexpected(models.error());
      document.objects.push_back(std::move(*models));
    }
    if (auto water = exchange::water_object(world_, node, level))
      document.objects.push_back(std::move(*water));
  }
  for (exchange::Object& part : document.objects)
    std::ranges::for_each(part.parts, drop_empty_triangles);
  const double block_m = world_.block_size_m();
  document.origin = {static_cast<double>(tree.east(tile)) * block_m, 0,
                     static_cast<double>(tree.south(tile)) * block_m};
  return document;
}

core::Bounds bounds_of(const exchange::Document& document) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  core::Bounds box{glm::vec3(kFar), glm::vec3(-kFar)};
  for (const exchange::Object& object : document.objects)
    for (const exchange::Part& part : object.parts)
      for (const glm::vec3& p : part.positions)
        box = {glm::min(box.min, p + object.position), glm::max(box.max, p + object.position)};
  return box;
}

}  // namespace psygen::tiles
