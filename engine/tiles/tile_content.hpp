// The content of a tile as a document: a block with all its models, or the ground and the merged
// vegetation of a coarser node. Ground has skirts, which hide gaps between tiles of different
// levels. One object per thread; the world and the registry are shared.
#pragma once

#include <memory>
#include <vector>

#include "engine/exchange/document.hpp"
#include "engine/models/registry.hpp"
#include "engine/tiles/tile_tree.hpp"
#include "engine/world/world.hpp"

namespace psygen::tiles {

class TileMaker {
 public:
  // `world` must belong to `registry`; both must outlive it.
  TileMaker(const world::World& world, const models::Registry& registry);
  ~TileMaker();

  // The document of a tile with content, in metres from its own north-west corner; its origin is
  // the position of that corner in the tileset. Any thread. Fails with kSynthesisFailed or
  // kOutOfMemory.
  core::Result<exchange::Document> document(const TileTree& tree, const Tile& tile) const;
  // The height error of nodes of a level in metres: the distance of their vertices.
  double error_m(int node_level) const;

 private:
  core::Result<exchange::Object> object(const models::ModelType& type, const models::Parameters& p,
                                        float skirt_m) const;

  const world::World& world_;
  const models::Registry& registry_;
  std::unique_ptr<models::ModelType> merged_;
};

// The smallest box around a document, relative to its origin. Requires a vertex.
core::Bounds bounds_of(const exchange::Document& document);

}  // namespace psygen::tiles
