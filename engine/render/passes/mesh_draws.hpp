// Draws the runs of a list, for the landscape and for shadows. Private to engine/render.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace psygen::render {

// Binds what draws from these buffers need, unless it is bound.
class MeshBinder {
 public:
  explicit MeshBinder(const Recording& to) : to_(to), textures_(to) {}
  // `Draws`: a run or a group.
  template <class Draws>
  void bind(VkPipeline pipeline, const Draws& draws) {
    const VkBuffer vertices = to_.buffers.pool_blocks[draws.pool_block].buffer.get();
    const VkBuffer indices = draws.shared ? to_.buffers.shared_indices : vertices;
    if (pipeline != pipeline_) to_.bind_pipeline(pipeline);
    if (vertices != vertices_) {
      const VkDeviceSize zero = 0;
      to_.device.vk.vkCmdBindVertexBuffers(to_.commands(), 0, 1, &vertices, &zero);
    }
    if (indices != indices_) {
      to_.device.vk.vkCmdBindIndexBuffer(to_.commands(), indices, 0, VK_INDEX_TYPE_UINT16);
    }
    textures_.bind(draws.textures);
    pipeline_ = pipeline;
    vertices_ = vertices;
    indices_ = indices;
  }

 private:
  const Recording& to_;
  TextureBinder textures_;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkBuffer vertices_ = VK_NULL_HANDLE, indices_ = VK_NULL_HANDLE;
};

// Draws one run, whose buffers are bound.
void draw_run(const Recording& to, const DrawRun& run);

// Draws all runs with the pipelines of a use. Calls drawn(run) after each.
template <class Drawn>
void draw_list(const Recording& to, MeshUse use, const Drawn& drawn) {
  MeshBinder binder(to);
  for (const DrawRun& run : to.list.runs()) {
    binder.bind(to.meshes.find(run.layout, use, run.variant()), run);
    draw_run(to, run);
    drawn(run);
  }
}

}  // namespace psygen::render
