// Turns the draws of a frame into the lists that are submitted: the data of each draw for the
// shaders, and runs of draws that share buffers. Windows of draws keep their order; inside a
// window, draws with the same buffers are grouped. Plain memory, no Vulkan. Reused from frame to
// frame, O(n log window). Main thread.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/vertex_layout.hpp"
#include "engine/render/memory/shared_index_lists.hpp"
#include "engine/render/meshes/layouts.hpp"
#include "engine/render/meshes/mesh_tables.hpp"
#include "engine/render/textures/materials.hpp"
#include "engine/render/types.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// The indices of a mesh, from its own list or a shared one. A non-empty `part` selects a part of
// them. `lists` is indexed by shared_indices − 1.
IndexList indices_of(const core::GeometryRange& range, std::uint32_t shared_indices,
                     core::IndexPart part, std::span<const IndexList> lists);
template <class Draw>
IndexList indices_of(const Draw& draw, std::span<const IndexList> lists) {
  return indices_of(draw.range, draw.shared_indices, draw.part, lists);
}
inline IndexList indices_of(const ObjectDraw& draw, std::span<const IndexList>) {
  return {draw.range.first_index, draw.range.index_count};
}

// Facts about the draws of a frame that decide how they are listed. Valid while a list is built.
struct ListFacts {
  std::span<const IndexList> shared = {};  // indexed by shared_indices − 1
  MaterialKinds materials = {};
  std::span<const PointLight> lights = {};  // runs that they may reach are apart
  std::uint32_t pushed_from = UINT32_MAX;   // meshes with at least this many indices are pushed
  bool coloured = false;                    // the data has the debug colour of each draw (shared.h)
};

// One draw, in indices and vertices of its buffers. Same layout as VkMultiDrawIndexedInfoEXT.
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
  Coverage coverage = Coverage::kWhole;
  bool lamps = false;  // point lights may reach it
  std::uint32_t pool_block = 0;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  MaterialId textures = kPlainMaterial;  // of objects: the material whose textures are bound

  MeshVariant variant() const {
    return {.coverage = coverage,
            .pushed = pushed,
            .textured = textures != kPlainMaterial,
            .lamps = lamps};
  }
  // Returns true if this draw can be appended to the run `r`.
  bool continues(const DrawRun& r) const {
    return layout == r.layout && shared == r.shared && pushed == r.pushed &&
           coverage == r.coverage && lamps == r.lamps && pool_block == r.pool_block &&
           textures == r.textures;
  }
};

// The draws of one frame. Spans are valid until the next build().
class DrawList {
 public:
  static constexpr std::size_t kWindow = 512;  // draws that may be reordered together

  // Replaces the list: terrain first, then models, then objects.
  void build(const ListFacts& facts, std::span<const TerrainDraw> terrain,
             std::span<const MeshDraw> models, std::span<const ObjectDraw> objects = {});

  // The list: runs, draws, their data, and the triangles of all of them.
  std::span<const DrawRun> runs() const { return runs_; }
  std::span<const IndexedDraw> draws() const { return draws_; }
  std::span<const shaders::DrawData> data() const { return data_; }  // parallel to draws()
  std::uint64_t triangle_count() const { return triangle_count_; }

 private:
  template <class Draw>
  void add(std::span<const Draw> input);
  template <class Draw>
  DrawRun run_of(const Draw& draw) const;
  template <class Draw>
  void append(const Draw& draw);

  std::vector<DrawRun> runs_;
  std::vector<IndexedDraw> draws_;
  std::vector<shaders::DrawData> data_;
  std::vector<std::pair<std::uint64_t, std::size_t>> order_;  // (buffers, position) of a window
  std::uint64_t triangle_count_ = 0;
  ListFacts facts_;  // while build() runs
};

}  // namespace psygen::render
