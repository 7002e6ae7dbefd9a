// The model type "vegetation": one mesh for everything that is scattered over the 2^k × 2^k blocks
// of a node of level k, each tree or rock as a few triangles, from level 4 on one form for several.
// It stands where place_models() puts the single models (from level 3 on by the slopes of a coarser
// lattice of the same ground), as high as the ground that the node draws, so changing from one to
// the other moves nothing but up or down with the ground. docs/models.md, "Vegetation".
#pragma once

#include <memory>

#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Positions in the schema of the type "vegetation".
enum MergedParameter : std::size_t {
  kMergedBlockX = 0,  // the node, counted in nodes of its level
  kMergedBlockZ,
  kMergedNodeLevel,
  kMergedParameterCount
};

inline constexpr int kMaxMergedLevel = 5;

// Two levels of detail: what belongs to the node level, and, coarser than anything single but the
// smallest stones, the forms of the next one. Positions are metres from the node's corner. Models
// that find no place leave degenerate triangles at the end of the mesh. Needs 1.1 MiB of stack.
// Makes a few instances of every scatter at once (about 0.1 ms a scatter). The model types of
// `registry` must outlive the result, which may become one of them; `world` must be one of this
// registry.
std::unique_ptr<models::ModelType> make_merged_type(std::shared_ptr<const World> world,
                                                    const models::Registry& registry);

models::Parameters merged_parameters(core::BlockCoord node, int node_level);

// Of a world's models as they are seen from above, for colouring the ground further out.
struct FarCover {
  glm::vec3 albedo{0.0F};  // linear, mean over the ground that they cover, darkened by their own
                           // ambient visibility
  float share = 0;         // of the ground that they cover, on average over the world
};
// Takes about 2 ms: it looks for places on kSizeBlocks blocks.
FarCover far_cover(const World& world, const models::Registry& registry);

}  // namespace psygen::world
