// From the draws of a frame to what is submitted: the data of each draw for the shaders, and runs
// of draws that share buffers. Keeps the given order within windows of draws and gathers those of
// the same buffers inside a window. Plain memory, no Vulkan; reused from frame to frame.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/vertex_layout.hpp"
#include "engine/render/types.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// One shared index list within the buffer of all of them.
struct IndexList {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
};

// The indices of a mesh with a list of its own or a shared one, or a part of them; `lists` is
// indexed by shared_indices − 1.
IndexList indices_of(const core::GeometryRange& range, std::uint32_t shared_indices,
                     core::IndexPart part, std::span<const IndexList> lists);

// What the shaders read of a draw.
shaders::DrawData data_of(const TerrainDraw& draw);
shaders::DrawData data_of(const MeshDraw& draw);
// Whether it leaves out pixels.
constexpr bool is_fading(const TerrainDraw&) {
  return false;
}
constexpr bool is_fading(const MeshDraw& draw) {
  return draw.fade < 1.0F;
}
// The draw's colour in its data, for the views that show it.
void set_colour(shaders::DrawData& data, const TerrainDraw& draw);
void set_colour(shaders::DrawData& data, const MeshDraw& draw);

// Same layout as VkMultiDrawIndexedInfoEXT.
struct IndexedDraw {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
  std::int32_t vertex_offset = 0;
};

// Draws [first, first + count) with the same vertex layout and buffers.
struct DrawRun {
  core::VertexLayout layout = core::VertexLayout::kModel;
  bool shared = false;  // indices from the shared lists, else from the pool block
  bool pushed = false;  // one call per draw with its data pushed, else one call for all
  bool fading = false;  // models that come or go
  std::uint32_t pool_block = 0;
  std::uint32_t first = 0;
  std::uint32_t count = 0;

  bool continues(const DrawRun& r) const {
    return layout == r.layout && shared == r.shared && pushed == r.pushed && fading == r.fading &&
           pool_block == r.pool_block;
  }
};

class DrawList {
 public:
  static constexpr std::size_t kWindow = 512;  // draws whose order may be changed

  // Replaces the list: terrain first, then models. `lists` is indexed by shared_indices − 1.
  // Meshes of at least `pushed_from` indices are pushed. `coloured`: their data has the colour of
  // each draw (shared.h).
  void build(std::span<const TerrainDraw> terrain, std::span<const MeshDraw> models,
             std::span<const IndexList> lists, std::uint32_t pushed_from = UINT32_MAX,
             bool coloured = false);

  std::span<const DrawRun> runs() const { return runs_; }
  std::span<const IndexedDraw> draws() const { return draws_; }
  std::span<const shaders::DrawData> data() const { return data_; }  // parallel to draws()
  std::uint64_t triangle_count() const { return triangle_count_; }

 private:
  template <class Draw>
  void add(std::span<const Draw> input);
  template <class Draw>
  void append(const Draw& draw);

  std::vector<DrawRun> runs_;
  std::vector<IndexedDraw> draws_;
  std::vector<shaders::DrawData> data_;
  std::vector<std::pair<std::uint64_t, std::size_t>> order_;  // (buffers, position) of a window
  std::uint64_t triangle_count_ = 0;
  std::span<const IndexList> lists_;  // while build() runs
  std::uint32_t pushed_from_ = UINT32_MAX;
  bool coloured_ = false;
};

}  // namespace psygen::render
