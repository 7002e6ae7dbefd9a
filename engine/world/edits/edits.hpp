// Edits of a world that persist: models are removed, moved and placed, ground is raised, flattened
// and shaped by heightmaps. A sparse layer over the world's function. Everything that shows the
// world shows its edits: set_edits(world, edits.layer()), or Scene::edit() for a running scene.
// A value: copies are O(1), and a copy that was kept takes everything back, exactly. A change
// copies a path of the tree and the edits of its block; one of the ground also the edits that
// overlap it: O(log n + edits copied). What is impossible is refused with a sentence and changes
// nothing. One thread at a time may change an object; layers that it gave away are immutable, for
// any thread.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/models/edits.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// A model of the world's function: the block, and Placement::index.
struct InstanceName {
  core::BlockCoord block;
  std::uint32_t index = 0;
};

// An edit that has an id: a placed model, or an edit of the ground. It belongs to a block.
struct EditName {
  core::BlockCoord block;
  std::uint32_t id = 0;
  friend bool operator==(const EditName&, const EditName&) = default;
};

// A model to place. Its foot stands on the ground, at any time, or `above_m` over it.
struct NewModel {
  models::ModelIndex model = 0;
  models::Parameters parameters;  // legal for the type; the slope of the ground is set
  core::WorldPosition at;         // y is not used
  double above_m = 0;             // −1000 … 1000
};

// Limits of edits. Heights must lie between 0 and the relief of the terrain (relief_m): all ground
// does. What raised ground would exceed is cut off there.
inline constexpr double kMinEditRadiusM = 0.1, kMaxEditRadiusM = 20'000;
inline constexpr std::uint32_t kMaxHeightmapSide = 1024;
inline constexpr std::size_t kMaxEditsPerBlock = 16'384;
// Heights in all heightmaps of one block, so that its bytes stay below 16 MiB (save/save_game.hpp).
inline constexpr std::size_t kMaxHeightsPerBlock = std::size_t{3} << 20;

// How many edits there are.
struct EditCounts {
  std::uint64_t removed = 0, placed = 0, ground = 0;  // a moved model is removed and placed
};

// The edits of one world.
class Edits {
 public:
  // No edits.
  Edits() = default;
  // Those of a world, or of another layer of the same world; null: none.
  explicit Edits(std::shared_ptr<const models::EditLayer> layer) : layer_(std::move(layer)) {}

  // For set_edits(). Null where there are no edits.
  const std::shared_ptr<const models::EditLayer>& layer() const { return layer_; }
  bool empty() const { return layer_ == nullptr; }
  EditCounts counts() const;

  // Models -------------------------------------------------------------------------------------
  // Removes a model, such as a felled tree. Nothing happens if it is removed already.
  core::Result<void> remove(const World& world, const InstanceName& model);
  // Moves a model; it keeps its parameters. It is a placed model from then on. Fails also for one
  // that does not exist or is removed.
  core::Result<EditName> move(const World& world, const models::Registry& registry,
                              const InstanceName& model, const core::WorldPosition& to);
  // Takes remove() or move() back.
  core::Result<void> restore(const InstanceName& model);
  // Places a model. The types of placed models must stay at their places in the registry.
  core::Result<EditName> place(const World& world, const models::Registry& registry,
                               const NewModel& model);
  // Removes a placed model; one that was moved is gone then.
  core::Result<void> remove_placed(const EditName& model);

  // Ground -------------------------------------------------------------------------------------
  // Adds an edit of the ground, after all others. Stamps are always squares along the axes, and
  // only they have a heightmap. `id` of the argument, and what seal() sets, are not used. Roads and
  // turned stamps are in world files only (shaped_ground.hpp).
  core::Result<EditName> edit_ground(const World& world, models::GroundEdit edit);
  // The usual ones: raises ground (or digs, with a negative height), and flattens it to a height,
  // in a disc of this radius whose outer half fades out.
  core::Result<EditName> raise(const World& world, const core::WorldPosition& at, double radius_m,
                               double height_m);
  core::Result<EditName> flatten(const World& world, const core::WorldPosition& at, double radius_m,
                                 double height_m);
  // Takes one edit of the ground back, whatever came after it.
  core::Result<void> remove_ground(const World& world, const EditName& edit);

  // Whole blocks (edit_bytes.hpp) -----------------------------------------------------------------
  // Replaces all edits of a block, which must be legal.
  core::Result<void> replace_block(const World& world, core::BlockCoord block,
                                   models::BlockEdits edits);

 private:
  core::Result<std::uint32_t> next_id() const;
  // Copies, to be changed: of all edits, and of those of a block.
  models::EditLayer copy() const;
  models::BlockEdits edits_of(core::BlockCoord block) const;
  // Takes over a changed layer with these edits of a block.
  void commit(models::EditLayer layer, core::BlockCoord block, models::BlockEdits edits);

  std::shared_ptr<const models::EditLayer> layer_;
};

// The blocks whose edits differ, in no particular order: those that must be stored again.
// O(differences · log n).
std::vector<core::BlockCoord> changed_blocks(const Edits& before, const Edits& after);

}  // namespace psygen::world
