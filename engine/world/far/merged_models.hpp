// The model type "vegetation": one merged mesh for all models scattered over the 2^k × 2^k blocks
// of a node of level k. Each tree or rock has a few triangles; from level 4 on, several share one
// form. Positions are those of place_models(); from level 3 on, slopes come from a coarser lattice
// of the same ground. Heights are those of the node's drawn ground, so replacing single models by
// their merged mesh moves them only up or down, with the ground. Models removed by edits are left
// out, and placed models have forms of their own. No model type gets special treatment.
// docs/models.md, "Vegetation".
#pragma once

#include <memory>
#include <span>

#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Indices in the schema of the type "vegetation".
enum MergedParameter : std::size_t {
  kMergedBlockX = 0,  // the node, in nodes of its level
  kMergedBlockZ,
  kMergedNodeLevel,
  kMergedParameterCount
};

// Maximum level of a node with a merged mesh; the minimum is 1.
inline constexpr int kMaxMergedLevel = 5;

class ImpostorSet;

// The distant representation of each scatter (scatter.hpp). Synthesises 32 instances of every
// scatter, some milliseconds in all. The model types of `registry` must outlive the result; `world`
// must belong to this registry. Scatters that equal one of `before`, from an earlier world, are
// copied from it. `before` may be null, and its model types may be destroyed.
class FarScatters;
std::shared_ptr<const FarScatters> far_scatters(std::shared_ptr<const World> world,
                                                const models::Registry& registry,
                                                const FarScatters* before = nullptr);

// The model type of a world. It has two levels of detail: the forms of the node level, and those of
// the next node level, which are coarser than all single models except the smallest stones.
// Positions are in metres from the node's corner. Models that find no position leave degenerate
// triangles at the end of the mesh. The model types of `registry`
// must outlive the result, which may be added to it; `world` must belong to this registry. Edits of
// `world` are ignored: a mesh shows the edits that its parameters name. Placed models of types that
// may not run on the main thread are left out. `pictures` and `scatters` must belong to this world;
// without `pictures` there are no impostors, without `scatters` they are made here.
std::unique_ptr<models::ModelType> make_merged_type(
    std::shared_ptr<const World> world, const models::Registry& registry,
    std::shared_ptr<const ImpostorSet> pictures = nullptr,
    std::shared_ptr<const FarScatters> scatters = nullptr);

// ModelType::identity() of that type without pictures, for a world without edits: a hash of
// everything in the world that its meshes depend on.
std::uint64_t merged_identity(const World& world, const models::Registry& registry);

// The parameters of one node without edits. `node` is in nodes of its level, 1 … kMaxMergedLevel.
models::Parameters merged_parameters(core::BlockCoord node, int node_level);
// The same with the edits of the world.
models::Parameters merged_parameters(const World& world, core::BlockCoord node, int node_level);

// A world's models from above, for the colour of distant ground.
struct FarCover {
  glm::vec3 albedo{0.0F};  // linear; mean over the covered ground, darkened by the models' ambient
                           // visibility
  float share = 0;         // covered fraction of the ground, mean over the world; 0 … 1
};
// The cover of a world. `scatters` must belong to it, and so must `placed`, the result of
// placed_per_block(), which takes some milliseconds.
FarCover far_cover(const World& world, const FarScatters& scatters, std::span<const double> placed);

}  // namespace psygen::world
