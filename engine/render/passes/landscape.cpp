#include "engine/render/passes/landscape.hpp"

#include <algorithm>
#include <cstddef>

#include "engine/render/passes/gpu_culling.hpp"

namespace psygen::render {

namespace {

static_assert(sizeof(IndexedDraw) == sizeof(VkMultiDrawIndexedInfoEXT));
static_assert(offsetof(IndexedDraw, index_count) ==
              offsetof(VkMultiDrawIndexedInfoEXT, indexCount));
static_assert(offsetof(IndexedDraw, vertex_offset) ==
              offsetof(VkMultiDrawIndexedInfoEXT, vertexOffset));

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
void draw_run(const Recording& to, const DrawRun& run) {
  const VkCommandBuffer commands = to.commands();
  const IndexedDraw* const draws = to.list.draws().data();
  for (std::uint32_t i = run.first; run.pushed && i < run.first + run.count; ++i) {
    to.device.vk.vkCmdPushConstants(commands, to.sets.layout(), VK_SHADER_STAGE_VERTEX_BIT, 0,
                                    sizeof(shaders::DrawData), &to.list.data()[i]);
    to.device.vk.vkCmdDrawIndexed(commands, draws[i].index_count, 1, draws[i].first_index,
                                  draws[i].vertex_offset, 0);
  }
  const std::uint32_t most = to.device.max_multi_draw;
  for (std::uint32_t done = 0; !run.pushed && done < run.count; done += most) {
    const std::uint32_t first = run.first + done;
    to.device.vk.vkCmdDrawMultiIndexedEXT(
        commands, std::min(run.count - done, most),
        reinterpret_cast<const VkMultiDrawIndexedInfoEXT*>(draws + first), 1, first,
        sizeof(IndexedDraw), nullptr);
  }
}

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

constexpr std::uint64_t kTrianglesOfPart = 12'000;

// Draws the meshes of the CPU's list. On software devices pixels are filled while the next
// kTrianglesOfPart triangles are set up.
void record_listed(const Recording& to) {
  begin_rendering(to.device, to.commands(), to.targets);
  std::uint64_t triangles = 0;
  draw_list(to, use_in(to.view), [&](const DrawRun& run) {
    for (std::uint32_t i = run.first; to.targets.in_parts && i < run.first + run.count; ++i)
      triangles += to.list.draws()[i].index_count / 3;
    if (triangles < kTrianglesOfPart) return;
    triangles = 0;
    split_rendering(to.device, to.commands(), to.targets);
  });
}

// Draws the meshes that the device chose in a phase of culling.
void draw_chosen(const Recording& to, std::uint32_t phase) {
  const GpuCulling& culling = *to.culling;
  MeshBinder binder(to);
  for (std::size_t i = 0; i < culling.groups().size(); ++i) {
    const DrawGroup& group = culling.groups()[i];
    binder.bind(to.meshes.find(group.layout, use_in(to.view), group.variant(to.lamps)), group);
    culling.draw_group(to.device, to.commands(), {to.slot.number(), i, phase});
  }
}

void record_chosen(const Recording& to) {
  GpuCulling& culling = *to.culling;
  const std::size_t slot = to.slot.number();
  culling.record_first(to.device, to.commands(), slot);
  begin_rendering(to.device, to.commands(), to.targets,
                  culling.two_passes() ? RenderingPart::kFirst : RenderingPart::kWhole);
  draw_chosen(to, 0);
  if (!culling.two_passes()) return;
  to.device.vk.vkCmdEndRendering(to.commands());
  culling.record_second(to.device, to.commands(), slot, to.targets.depth);
  begin_rendering(to.device, to.commands(), to.targets, RenderingPart::kSecond);
  draw_chosen(to, 1);
}

}  // namespace

void Landscape::record(const Recording& to) const {
  if (to.culling != nullptr) {
    record_chosen(to);
  } else {
    record_listed(to);
  }
}

void Landscape::warm_up(const Recording& to, const WarmUpStep& step) const {
  const auto draw = [&](core::VertexLayout layout, MeshVariant variant) {
    variant.lamps = step.lamps;
    for (const bool pushed : {false, true}) {
      if (!pushed && !to.device.info.numbers_draws()) continue;
      variant.pushed = pushed;
      to.bind_pipeline(to.meshes.find(layout, MeshUse::kLandscape, variant));
      to.device.vk.vkCmdDrawIndexed(to.commands(), 3, 1, 0, 0, 0);
    }
  };
  if (step.feature == Feature::kObjects) {
    for (const Coverage coverage : {Coverage::kWhole, Coverage::kPart})
      draw(core::VertexLayout::kObject, {.coverage = coverage, .textured = step.number == 1});
  } else if (step.number == 0) {
    draw(core::VertexLayout::kTerrain, {.coverage = Coverage::kWhole});
    draw(core::VertexLayout::kTerrain, {.coverage = Coverage::kPart});
  } else if (step.number == 1) {
    draw(core::VertexLayout::kModel, {.coverage = Coverage::kWhole});
    draw(core::VertexLayout::kModel, {.coverage = Coverage::kNear});
  } else {
    draw(core::VertexLayout::kModel, {.coverage = Coverage::kPart});
    draw(core::VertexLayout::kModel, {.coverage = Coverage::kPictured});
  }
}

void Shadows::record(const Recording& to) const {
  if (!active_) return;
  to.sets.shadows().record(to.device, to.commands(), [&](std::uint32_t cascade) {
    to.device.vk.vkCmdPushConstants(to.commands(), to.sets.layout(), VK_SHADER_STAGE_VERTEX_BIT,
                                    sizeof(shaders::DrawData), sizeof(cascade), &cascade);
    draw_list(to, MeshUse::kShadow, [](const DrawRun&) {});
  });
  to.slot.timer().mark(to.device, to.commands(), GpuTimer::Mark::kShadows);
}

}  // namespace psygen::render
