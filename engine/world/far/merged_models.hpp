// The model type "vegetation": one merged mesh for all models on the 2^k × 2^k blocks of a node of
// level k. Each scattered tree or rock has a few triangles; from level 4 on, several share one
// form. Models of one shape (ModelType::turn_deg) and placed ones keep a coarse level of their own
// mesh. Positions are those of place_models(); from level 3 on, slopes come from a coarser lattice
// of the same ground. Heights are those of the node's drawn ground, so replacing single models by
// their merged mesh moves them only up or down, with the ground. Models removed by edits are left
// out. No model type gets special treatment.
// docs/models.md, "Vegetation".
#pragma once

#include <memory>
#include <optional>
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

// Maximum levels of a node whose merged mesh has scattered and placed models; the minimum is 1.
inline constexpr int kMaxMergedLevel = 5, kMaxPlacedLevel = 15;

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
// `world` are ignored: a mesh shows the edits that its parameters name. The type may run on the
// main thread if all types of `registry` that are seen from far may. `pictures` and `scatters` must
// belong to this world; without `pictures` there are no impostors, without `scatters` they are made
// here.
std::unique_ptr<models::ModelType> make_merged_type(
    std::shared_ptr<const World> world, const models::Registry& registry,
    std::shared_ptr<const ImpostorSet> pictures = nullptr,
    std::shared_ptr<const FarScatters> scatters = nullptr);

// ModelType::identity() of that type without pictures, for a world without edits: a hash of
// everything in the world that its meshes depend on.
std::uint64_t merged_identity(const World& world, const models::Registry& registry);

// The bounds of the scattered models on any node of this level; nothing if it shows none. `merged`
// is a result of make_merged_type().
std::optional<core::Bounds> scattered_bounds(const models::ModelType& merged, int node_level);

// True if a node of this level may show models that the file or edits of the world place.
bool has_placed(const World& world, core::BlockCoord node, int node_level);
// Largest error in metres of nodes of this level because of placed models, whose forms differ from
// them or are missing; 0: nothing is placed.
double placed_error_m(const World& world, int node_level);

// The parameters of one node without edits. `node` is in nodes of its level, 1 … kMaxPlacedLevel.
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
