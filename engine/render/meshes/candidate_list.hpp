// Turns the draws of a frame into the input of the culling shader: candidates with their boxes, and
// groups of candidates that share buffers (one indirect draw each). Plain memory, no Vulkan. Reused
// from frame to frame, linear in the draws. Main thread. Private to engine/render.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "engine/render/meshes/draw_list.hpp"
#include "shaders/cull_shared.h"

namespace psygen::render {

// Candidates that are drawn with the same pipeline and buffers, and the place of their commands
// among those of a phase. There is room for the commands of all of them.
struct DrawGroup {
  core::VertexLayout layout = core::VertexLayout::kModel;
  bool shared = false;  // indices from the shared lists, else from the pool block
  Coverage coverage = Coverage::kWhole;
  std::uint32_t pool_block = 0;
  std::uint32_t first_command = 0;
  std::uint32_t capacity = 0;
  MaterialId textures = kPlainMaterial;  // of objects: the material whose textures are bound

  // The variant of a group in a frame with or without point lights.
  MeshVariant variant(bool lamps) const {
    return {.coverage = coverage, .textured = textures != kPlainMaterial, .lamps = lamps};
  }
};

// The candidates of one frame. Spans are valid until the next build().
class CandidateList {
 public:
  // Number of draws that every device with indirect draws accepts in one call.
  static constexpr std::uint32_t kGroupCapacity = 65535;

  // Replaces the list: terrain first, then models, then objects. Uses no lights.
  void build(const ListFacts& facts, std::span<const TerrainDraw> terrain,
             std::span<const MeshDraw> models, std::span<const ObjectDraw> objects = {});

  // The list: candidates, groups, and first commands in the order of groups().
  std::span<const shaders::CullCandidate> candidates() const { return candidates_; }
  std::span<const DrawGroup> groups() const { return groups_; }
  std::span<const std::uint32_t> first_commands() const { return first_commands_; }  // of groups()
  std::uint32_t command_count() const { return static_cast<std::uint32_t>(candidates_.size()); }
  // One more than the largest bit number of a candidate.
  std::uint32_t name_count() const { return name_count_; }

 private:
  template <class Draw>
  void add(const Draw& draw, std::uint32_t group, std::uint32_t name);
  template <class Draw>
  void add_meshes(std::span<const Draw> draws);
  std::uint32_t group_for(const core::GeometryRange& range, bool shared, Coverage coverage);
  std::uint32_t group_for(const ObjectDraw& draw, MaterialKind kind);
  void place_groups();

  std::vector<shaders::CullCandidate> candidates_;
  std::vector<DrawGroup> groups_;
  std::vector<std::uint32_t> first_commands_;
  std::vector<std::uint32_t> open_;  // 1 + the group being filled, by layout and buffers
  std::unordered_map<std::uint64_t, std::uint32_t> open_objects_;  // the group being filled
  ListFacts facts_;                                                // while build() runs
  std::uint32_t name_count_ = 0;
};

}  // namespace psygen::render
