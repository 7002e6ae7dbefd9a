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
#include "engine/render/types.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// An index list within the buffer of all shared lists, or within a pool block.
struct IndexList {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
};

// The indices of a mesh, from its own list or a shared one. A non-empty `part` selects a part of
// them. `lists` is indexed by shared_indices − 1.
IndexList indices_of(const core::GeometryRange& range, std::uint32_t shared_indices,
                     core::IndexPart part, std::span<const IndexList> lists);

// The data of a draw for the shaders.
shaders::DrawData data_of(const TerrainDraw& draw);
shaders::DrawData data_of(const MeshDraw& draw);
shaders::DrawData data_of(const ObjectDraw& draw);
// Which of its pixels a draw covers. Each has a pipeline of its own.
enum class Coverage : std::uint8_t {
  kWhole,
  kPart,      // models that fade in or out, objects with holes; of terrain, what is near
  kPictured,  // models with pictures, whether they fade or not
  kNear,      // near models, whether they fade or not
};
constexpr Coverage coverage_of(const TerrainDraw& draw) {
  return draw.near ? Coverage::kPart : Coverage::kWhole;
}
constexpr Coverage coverage_of(const MeshDraw& draw) {
  return draw.pictured      ? Coverage::kPictured
         : draw.near        ? Coverage::kNear
         : draw.fade < 1.0F ? Coverage::kPart
                            : Coverage::kWhole;
}
// Puts the debug colour of a draw into its data, for the views that show it.
void set_colour(shaders::DrawData& data, const TerrainDraw& draw);
void set_colour(shaders::DrawData& data, const MeshDraw& draw);
void set_colour(shaders::DrawData& data, const ObjectDraw& draw);

// How the draws of a material differ from those of others. Materials are named by their place in a
// span; those beyond it are plain.
struct MaterialKind {
  bool textured = false;  // its textures are bound
  bool holes = false;     // pixels of little opacity are left out
};
using MaterialKinds = std::span<const MaterialKind>;
inline MaterialKind kind_of(MaterialKinds kinds, MaterialId material) {
  return material < kinds.size() ? kinds[material] : MaterialKind{};
}

inline Coverage coverage_of(const ObjectDraw& draw, MaterialKind kind) {
  return kind.holes || draw.fade < 1.0F ? Coverage::kPart : Coverage::kWhole;
}

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

  // Whether this draw can be appended to the run `r`.
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

  // Replaces the list: terrain first, then models, then objects. `lists` is indexed by
  // shared_indices − 1. Meshes with at least `pushed_from` indices are pushed. With `coloured` the
  // data has the debug colour of each draw (shared.h). Runs that `lights` may reach are apart.
  void build(std::span<const TerrainDraw> terrain, std::span<const MeshDraw> models,
             std::span<const IndexList> lists, std::uint32_t pushed_from = UINT32_MAX,
             bool coloured = false, std::span<const ObjectDraw> objects = {},
             MaterialKinds materials = {}, std::span<const PointLight> lights = {});

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
  std::span<const IndexList> lists_;    // while build() runs
  MaterialKinds materials_;             // the same
  std::span<const PointLight> lights_;  // the same
  std::uint32_t pushed_from_ = UINT32_MAX;
  bool coloured_ = false;
};

}  // namespace psygen::render
