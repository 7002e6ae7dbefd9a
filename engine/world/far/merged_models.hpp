// The model type "vegetation": one mesh for all models scattered over the 2^k × 2^k blocks of a
// node of level k. Each tree or rock has a few triangles; from level 4 on, several share one form.
// Places are those of place_models(); from level 3 on, slopes come from a coarser lattice of the
// same ground. Heights are those of the ground that the node draws. So a change from single models
// to their merged mesh moves them only up or down, with the ground. Models that were removed by
// hand are left out, and those that were placed have forms of their own. Knows no single type of
// model. docs/models.md, "Vegetation".
#pragma once

#include <memory>
#include <span>

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

// Highest level of a node with a merged mesh; the lowest is 1.
inline constexpr int kMaxMergedLevel = 5;

class PictureSet;

// What stands for the instances of each scatter from afar (scatter.hpp). Synthesises 32 instances
// of every scatter, some milliseconds in all. The model types of `registry` must outlive it;
// `world` must belong to this registry. Scatters that are the same in a world before are taken over
// from it: `before` may be null, and its types may be gone.
class FarScatters;
std::shared_ptr<const FarScatters> far_scatters(std::shared_ptr<const World> world,
                                                const models::Registry& registry,
                                                const FarScatters* before = nullptr);

// The model type of a world. It has two levels of detail: the forms of the node level, and those of
// the next node level, which are coarser than all single models except the smallest stones.
// Positions are in metres from the node's corner. Models that find no place leave degenerate
// triangles at the end of the mesh. Synthesis needs 1.1 MiB of stack. The model types of `registry`
// must outlive the result, which may be added to it; `world` must belong to this registry. Edits of
// `world` are ignored: a mesh shows those that its parameters name. Placed models of types that may
// not run on the main thread are left out. `pictures`: those of this world; null for none.
// `scatters`: those of this world; null: they are made.
std::unique_ptr<models::ModelType> make_merged_type(
    std::shared_ptr<const World> world, const models::Registry& registry,
    std::shared_ptr<const PictureSet> pictures = nullptr,
    std::shared_ptr<const FarScatters> scatters = nullptr);

// The parameters of one node without edits, which is counted in nodes of its level,
// 1 … kMaxMergedLevel.
models::Parameters merged_parameters(core::BlockCoord node, int node_level);
// The same with the edits of the world.
models::Parameters merged_parameters(const World& world, core::BlockCoord node, int node_level);

// A world's models seen from above, for the colour of distant ground.
struct FarCover {
  glm::vec3 albedo{0.0F};  // linear; mean over the covered ground, darkened by the models' ambient
                           // visibility
  float share = 0;         // of the ground that is covered, mean over the world; 0 … 1
};
// The cover of a world. `scatters` must be those of this world, `placed` what placed_per_block()
// says of it, which takes some milliseconds.
FarCover far_cover(const World& world, const FarScatters& scatters, std::span<const double> placed);

}  // namespace psygen::world
