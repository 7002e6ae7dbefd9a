// Persistent edits of a world: remove, move and place models; raise, flatten and shape ground by
// heightmaps; add rivers and lakes. A sparse layer over the world's function. Everything that shows
// the world shows its edits, after set_edits(world, edits.layer()), or Scene::edit() for a running
// scene. A value: copies are O(1), and an earlier copy restores everything exactly. A change copies
// a path of the tree and the edits of its block; an edit of the ground also copies the edits that
// overlap it: O(log n + edits copied). Impossible edits are rejected with an error message and
// change nothing. One thread at a time may change an object; layers that layer() returned are
// immutable, for any thread.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/models/edits.hpp"
#include "engine/world/water.hpp"
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

// A model to place. Its base point stays on the ground after later edits, or `above_m` over it.
struct NewModel {
  models::ModelIndex model = 0;
  models::Parameters parameters;  // legal for the type; the slope of the ground is set
  core::WorldPosition at;         // y is not used
  double above_m = 0;             // −1000 … 1000
};

// Limits of edits. Heights must be between 0 and the terrain's height range (relief_m), as all
// ground is. Raised ground is cut off at these limits.
inline constexpr double kMinEditRadiusM = 0.1, kMaxEditRadiusM = 20'000;
inline constexpr std::uint32_t kMaxHeightmapSide = 1024;
inline constexpr std::size_t kMaxEditsPerBlock = 16'384;
// Heights in all heightmaps of one block, so that its bytes stay below 16 MiB (save/save_game.hpp).
inline constexpr std::size_t kMaxHeightsPerBlock = std::size_t{3} << 20;

// Numbers of edits.
struct EditCounts {
  std::uint64_t removed = 0, placed = 0, ground = 0;  // a moved model is removed and placed
};

// A river or lake that a game added, and sentences that name doubtful input.
struct AddedWater {
  WaterBody body = kNoWater;  // at least kFirstAdded
  std::vector<std::string> warnings;
};

// The edits of one world.
class Edits {
 public:
  // No edits.
  Edits() = default;
  // Wraps the edits of a world, or of another layer of the same world; null: none.
  explicit Edits(std::shared_ptr<const models::EditLayer> layer) : layer_(std::move(layer)) {}

  // The layer for set_edits(). Null if there are no edits.
  const std::shared_ptr<const models::EditLayer>& layer() const { return layer_; }
  bool empty() const { return layer_ == nullptr; }
  EditCounts counts() const;

  // Models -------------------------------------------------------------------------------------
  // Removes a model, such as a felled tree. Does nothing if it is already removed.
  core::Result<void> remove(const World& world, const InstanceName& model);
  // Moves a model, which keeps its parameters and becomes a placed model. Also fails for a model
  // that does not exist or is removed.
  core::Result<EditName> move(const World& world, const models::Registry& registry,
                              const InstanceName& model, const core::WorldPosition& to);
  // Undoes remove() or move().
  core::Result<void> restore(const InstanceName& model);
  // Places a model. The edits keep the name of its type, not its index.
  core::Result<EditName> place(const World& world, const models::Registry& registry,
                               const NewModel& model);
  // Removes a placed model, also one that was moved.
  core::Result<void> remove_placed(const EditName& model);

  // Ground -------------------------------------------------------------------------------------
  // Adds an edit of the ground, after all others. Stamps are squares along the axes; only they have
  // a heightmap. Ignores `id` of the argument and the members that seal() sets. Roads and rotated
  // stamps exist in world files only (shaped_ground.hpp).
  core::Result<EditName> edit_ground(const World& world, models::GroundEdit edit);
  // Common edits: raises ground (or digs, with a negative height), or flattens it to a height, in a
  // disc of this radius whose outer half fades out.
  core::Result<EditName> raise(const World& world, const core::WorldPosition& at, double radius_m,
                               double height_m);
  core::Result<EditName> flatten(const World& world, const core::WorldPosition& at, double radius_m,
                                 double height_m);
  // Adds a river or a lake over the ground as it is now, and returns its name (water.hpp): it may
  // join, or cross as a lake, all water of the world file and of earlier edits. Later edits of the
  // ground move no water. Fails as river_edits() and lake_edits() do (water_shapes.hpp).
  core::Result<AddedWater> add_river(const World& world, const River& river);
  core::Result<AddedWater> add_lake(const World& world, const Lake& lake);
  // Undoes add_river() or add_lake(). Water that joins it stays. O(edits).
  core::Result<void> remove_water(const World& world, WaterBody body);
  // Undoes one edit of the ground and keeps all later ones.
  core::Result<void> remove_ground(const World& world, const EditName& edit);

  // Whole blocks (edit_bytes.hpp) -----------------------------------------------------------------
  // Replaces all edits of a block, which must be legal.
  core::Result<void> replace_block(const World& world, core::BlockCoord block,
                                   models::BlockEdits edits);

 private:
  core::Result<std::uint32_t> next_id() const;
  template <class Make>
  core::Result<AddedWater> add_water(const World& world, std::string_view type, const Make& make);
  friend Edits fitted(const Edits&, const World&, const models::Registry&,
                      const models::EditLayer*);
  // Moves the edits into blocks of the world's size.
  void resize_blocks(const World& world);
  // Copies to be changed: of all edits, and of the edits of a block.
  models::EditLayer copy(const World& world) const;
  models::BlockEdits edits_of(core::BlockCoord block) const;
  // Stores a changed layer with these edits of a block.
  void commit(models::EditLayer layer, core::BlockCoord block, models::BlockEdits edits);

  std::shared_ptr<const models::EditLayer> layer_;
};

// The edits as they hold in a world that replaces the one they were made for: placed models get the
// types of the same names in `registry`, and are left out where none allows their parameters. With
// blocks of another size all edits keep their places, and no instance of the world's function is
// removed. Keep `edits` themselves: they hold again when the old world returns. The same layer if
// nothing differs. `fitting` is a layer that holds in the world, null: none; only blocks that
// differ from it are looked at. A change of edits by functions that get a world with blocks of
// another size keeps what fitted() keeps.
Edits fitted(const Edits& edits, const World& world, const models::Registry& registry,
             const models::EditLayer* fitting = nullptr);

// The placed models that no type of the registry shows, in no particular order. The edits keep
// them, and stored bytes too: they stand again when a type of their name allows them. O(edits).
std::vector<EditName> hidden_models(const Edits& edits, const models::Registry& registry);

// The blocks whose edits differ, in no particular order: the blocks to store again. O(differences ·
// log n).
std::vector<core::BlockCoord> changed_blocks(const Edits& before, const Edits& after);

}  // namespace psygen::world
