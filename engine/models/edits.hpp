// Changes of a world made by hand, in the form that model types read: edits of the ground, and of
// the models of single blocks. A sparse layer over the world's function, which applies wherever the
// layer has nothing. Parameters name the layer that their mesh shows (model_type.hpp). Immutable in
// use: any thread may read. Made, checked and stored by world/edits.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/models/ground/stack.hpp"
#include "engine/models/kit/quad_map.hpp"
#include "engine/models/model_type.hpp"
#include "engine/models/registry.hpp"

namespace psygen::models {

// A model that was placed by hand, or moved to this block. It names its type, so it stays the same
// model under another registry; it is left out where no type of that name allows it (type_of()).
struct PlacedModel {
  std::uint32_t id = 0;     // unique in the layer, from 1
  glm::vec2 local_m{0.0F};  // from the block's corner along x and z
  float above_m = 0;        // of its base point, over the ground
  Parameters parameters;    // without the slope of the ground
  // Set by bind():
  std::string type = {};              // its name
  std::uint64_t identity = 0;         // ModelType::identity()
  std::uint32_t parameter_count = 0;  // of the type's schema
  glm::vec3 reach_m{0.0F};  // of its bounds from the base point: sideways, up, down; all >= 0
};
// Sets the members of a placed model that depend on its type, for which the others are legal.
void bind(PlacedModel& placed, const ModelType& type);
// True if `type` has the name and the schema of the placed model's type and, where its identity
// differs, allows the parameters. Compares three values in the usual case.
bool is_bound(const PlacedModel& placed, const ModelType& type);
// Returns the type of a placed model in a registry; nothing if there is none that is_bound(). O(1).
std::optional<ModelIndex> type_of(const PlacedModel& placed, const Registry& registry);

// A removed model of the world's function.
struct RemovedModel {
  std::uint32_t index = 0;     // among the instances of its block
  std::uint32_t moved_id = 0;  // the PlacedModel that replaces it; 0: none
  core::BlockCoord moved_to;   // its block, if it was moved
  friend bool operator==(const RemovedModel&, const RemovedModel&) = default;
};

// All edits that belong to one block.
struct BlockEdits {
  std::vector<RemovedModel> removed;                      // by growing index
  std::vector<PlacedModel> placed;                        // by growing id
  std::vector<std::shared_ptr<const GroundEdit>> ground;  // centred in the block, by growing id

  // Numbers of edits, of one block or of several.
  struct Summary {
    std::uint64_t removed = 0, placed = 0, ground = 0;
    glm::vec3 reach_m{0.0F};  // the largest of PlacedModel::reach_m
    // Adds the numbers of another summary.
    void add(const Summary& part) {
      removed += part.removed;
      placed += part.placed;
      ground += part.ground;
      for (int i = 0; i < 3; ++i)
        reach_m[i] = std::max(reach_m[i], part.reach_m[i]);
    }
  };
  // True if the block is as the world's function makes it.
  bool empty() const { return removed.empty() && placed.empty() && ground.empty(); }
  // Hash of all edits of the block; equal edits have equal hashes. Linear in the edits.
  std::uint64_t hash() const;
  // Counts the edits. Linear in the edits.
  Summary summary() const;
  // True if an instance of the world's function was removed or moved. O(log n).
  bool is_removed(std::uint32_t index) const {
    const auto at = std::ranges::lower_bound(removed, index, {}, &RemovedModel::index);
    return at != removed.end() && at->index == index;
  }
};

// The whole layer. A value: copies are O(1) and independent.
struct EditLayer {
  GroundStack ground;          // by position; its shapes are those of the world below the layer
  QuadMap<BlockEdits> blocks;  // all edits, by the block that they belong to; keys are blocks
  std::uint32_t next_id = 1;   // of placed models and edits of the ground
  double block_m = 0;  // side of the blocks that positions refer to; 0: that of the world in use

  // Returns the edits of one block, or null. O(log n).
  const BlockEdits* block(core::BlockCoord at) const { return blocks.find(QuadCoord::of(at)); }
};

}  // namespace psygen::models
