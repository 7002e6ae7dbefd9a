// From the draws of a frame to what the culling shader reads: candidates with their boxes, levels
// of detail, and groups of levels that share buffers (one indirect draw each). Plain memory, no
// Vulkan; reused from frame to frame. Private to engine/render.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/render/draw_list.hpp"
#include "shaders/cull_shared.h"

namespace psygen::render {

// Levels that are drawn with the same pipeline and buffers, and where their commands lie among
// those of a phase. There is room for all of them.
struct DrawGroup {
  core::VertexLayout layout = core::VertexLayout::kModel;
  bool shared = false;  // indices from the shared lists, else from the pool block
  bool fading = false;  // models that come or go
  std::uint32_t pool_block = 0;
  std::uint32_t first_command = 0;
  std::uint32_t capacity = 0;
};

class CandidateList {
 public:
  // What every device with indirect draws can take in one call.
  static constexpr std::uint32_t kGroupCapacity = 65535;

  // Replaces the list: terrain first, then models. `coarser` levels are taken where `choose`,
  // data has the colour of each draw where `coloured`.
  // `lists` is indexed by shared_indices − 1.
  void build(std::span<const TerrainDraw> terrain, std::span<const MeshDraw> models,
             std::span<const IndexList> lists, bool choose, bool coloured = false);

  std::span<const shaders::CullCandidate> candidates() const { return candidates_; }
  std::span<const shaders::CullLevel> levels() const { return levels_; }
  std::span<const DrawGroup> groups() const { return groups_; }
  std::span<const std::uint32_t> first_commands() const { return first_commands_; }  // of groups()
  std::uint32_t command_count() const { return static_cast<std::uint32_t>(levels_.size()); }
  // One more than the largest name of a bit.
  std::uint32_t name_count() const { return name_count_; }

 private:
  template <class Draw>
  void add(const Draw& draw, bool choose, bool coloured);
  void add_level(const core::GeometryRange& range, const IndexList& indices, bool shared,
                 bool fading, float error_m);
  std::uint32_t group_for(const core::GeometryRange& range, bool shared, bool fading);

  std::vector<shaders::CullCandidate> candidates_;
  std::vector<shaders::CullLevel> levels_;
  std::vector<DrawGroup> groups_;
  std::vector<std::uint32_t> first_commands_;
  std::vector<std::uint32_t> open_;   // 1 + the group that is filled, by layout and buffers
  std::span<const IndexList> lists_;  // while build() runs
  std::uint32_t name_count_ = 0;
};

}  // namespace psygen::render
