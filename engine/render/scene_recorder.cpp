#include "engine/render/scene_recorder.hpp"

#include <algorithm>
#include <cstddef>

namespace psygen::render {

static_assert(sizeof(IndexedDraw) == sizeof(VkMultiDrawIndexedInfoEXT));
static_assert(offsetof(IndexedDraw, index_count) ==
              offsetof(VkMultiDrawIndexedInfoEXT, indexCount));
static_assert(offsetof(IndexedDraw, vertex_offset) ==
              offsetof(VkMultiDrawIndexedInfoEXT, vertexOffset));

void bind_set(const Device& device, const Pipelines& pipelines, const FrameSlot& slot,
              std::size_t emitter) {
  const VkDescriptorSet set = slot.set();
  const auto offset = static_cast<std::uint32_t>(emitter * sizeof(shaders::EmitterData));
  device.vk.vkCmdBindDescriptorSets(slot.commands(), VK_PIPELINE_BIND_POINT_GRAPHICS,
                                    pipelines.layout(), 0, 1, &set, 1, &offset);
}

void bind_pipeline(const Device& device, VkCommandBuffer commands, VkPipeline pipeline) {
  device.vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
}

namespace {

constexpr std::uint64_t kTrianglesOfPart = 12'000;

void draw_pushed(const Device& device, VkCommandBuffer commands, VkPipelineLayout layout,
                 const DrawList& list, const DrawRun& run) {
  for (std::uint32_t i = run.first; i < run.first + run.count; ++i) {
    const IndexedDraw& draw = list.draws()[i];
    device.vk.vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_VERTEX_BIT, 0,
                                 sizeof(shaders::DrawData), &list.data()[i]);
    device.vk.vkCmdDrawIndexed(commands, draw.index_count, 1, draw.first_index, draw.vertex_offset,
                               0);
  }
}

void draw_many(const Device& device, VkCommandBuffer commands, const DrawList& list,
               const DrawRun& run) {
  for (std::uint32_t done = 0; done < run.count; done += device.max_multi_draw) {
    const std::uint32_t first = run.first + done;
    const std::uint32_t count = std::min(run.count - done, device.max_multi_draw);
    device.vk.vkCmdDrawMultiIndexedEXT(
        commands, count,
        reinterpret_cast<const VkMultiDrawIndexedInfoEXT*>(list.draws().data() + first), 1, first,
        sizeof(IndexedDraw), nullptr);
  }
}

// Binds the textures of a material of objects, unless they are bound.
class TextureBinder {
 public:
  TextureBinder(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands,
                const MaterialTable* materials)
      : device_(device), pipelines_(pipelines), commands_(commands), materials_(materials) {}

  void bind(MaterialId material) {
    if (material == bound_ || material == kPlainMaterial) return;
    const VkDescriptorSet set = materials_->set(material);
    device_.vk.vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS,
                                       pipelines_.layout(), 1, 1, &set, 0, nullptr);
    bound_ = material;
  }

 private:
  const Device& device_;
  const Pipelines& pipelines_;
  VkCommandBuffer commands_;
  const MaterialTable* materials_;
  MaterialId bound_ = kPlainMaterial;
};

// `Draws`: a run or a group.
template <class Draws>
VkPipeline picture_pipeline(const Pipelines& pipelines, const Draws& draws, bool pushed, bool lamps,
                            View view) {
  if (draws.layout != core::VertexLayout::kObject)
    return pipelines.mesh(draws.layout, pushed, draws.coverage, lamps, view);
  return pipelines.object(pushed, draws.textures != kPlainMaterial,
                          draws.coverage != Coverage::kWhole, lamps, view);
}

// Draws the runs of the list, each with the pipeline pipeline_of(run). After each, drawn(run).
template <class PipelineOf, class Drawn>
void draw_meshes(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands,
                 const ScenePass& pass, const PipelineOf& pipeline_of, const Drawn& drawn) {
  VkPipeline bound = VK_NULL_HANDLE;
  VkBuffer bound_vertices = VK_NULL_HANDLE, bound_indices = VK_NULL_HANDLE;
  TextureBinder textures(device, pipelines, commands, pass.materials);
  for (const DrawRun& run : pass.list.runs()) {
    const VkPipeline pipeline = pipeline_of(run);
    const VkBuffer vertices = pass.buffers.pool_blocks[run.pool_block].buffer.get();
    const VkBuffer indices = run.shared ? pass.buffers.shared_indices : vertices;
    if (pipeline != bound) bind_pipeline(device, commands, pipeline);
    if (vertices != bound_vertices) {
      const VkDeviceSize zero = 0;
      device.vk.vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &zero);
    }
    if (indices != bound_indices) {
      device.vk.vkCmdBindIndexBuffer(commands, indices, 0, VK_INDEX_TYPE_UINT16);
    }
    textures.bind(run.textures);
    bound = pipeline;
    bound_vertices = vertices;
    bound_indices = indices;
    if (run.pushed) {
      draw_pushed(device, commands, pipelines.layout(), pass.list, run);
    } else {
      draw_many(device, commands, pass.list, run);
    }
    drawn(run);
  }
}

// Draws the meshes on the CPU path, whose pass stays open. On software devices pixels are filled
// while the next kTrianglesOfPart triangles are set up.
void draw_listed(const Device& device, const Pipelines& pipelines, const FrameSlot& slot,
                 Targets& targets, const ScenePass& pass) {
  const VkCommandBuffer commands = slot.commands();
  begin_pass(device, commands, targets);
  bind_set(device, pipelines, slot);
  const auto pipeline_of = [&](const DrawRun& run) {
    return picture_pipeline(pipelines, run, run.pushed, run.lamps, pass.view);
  };
  std::uint64_t triangles = 0;
  draw_meshes(device, pipelines, commands, pass, pipeline_of, [&](const DrawRun& run) {
    for (std::uint32_t i = run.first; targets.in_parts && i < run.first + run.count; ++i)
      triangles += pass.list.draws()[i].index_count / 3;
    if (triangles < kTrianglesOfPart) return;
    triangles = 0;
    go_on_in_new_pass(device, commands, targets);
  });
}

void draw_culled(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands,
                 const ScenePass& pass, std::uint32_t phase) {
  const GpuCulling& culling = *pass.culled.culling;
  VkPipeline bound = VK_NULL_HANDLE;
  TextureBinder textures(device, pipelines, commands, pass.materials);
  for (std::size_t i = 0; i < culling.groups().size(); ++i) {
    const DrawGroup& group = culling.groups()[i];
    const VkPipeline pipeline = picture_pipeline(pipelines, group, false, pass.lamps, pass.view);
    textures.bind(group.textures);
    const VkBuffer vertices = pass.buffers.pool_blocks[group.pool_block].buffer.get();
    const VkBuffer indices = group.shared ? pass.buffers.shared_indices : vertices;
    const VkDeviceSize zero = 0;
    if (pipeline != bound) bind_pipeline(device, commands, pipeline);
    bound = pipeline;
    device.vk.vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &zero);
    device.vk.vkCmdBindIndexBuffer(commands, indices, 0, VK_INDEX_TYPE_UINT16);
    culling.draw_group(device, commands, pass.culled.slot, i, phase);
  }
}

// Draws the meshes on the GPU path. The last pass of the frame stays open, for what follows meshes.
void draw_culled_passes(const Device& device, const Pipelines& pipelines, const FrameSlot& slot,
                        Targets& targets, const ScenePass& pass) {
  const auto [culling, index] = pass.culled;
  const VkCommandBuffer commands = slot.commands();
  culling->record_first(device, commands, index);
  begin_pass(device, commands, targets,
             culling->two_passes() ? PassPart::kFirst : PassPart::kWhole);
  bind_set(device, pipelines, slot);
  draw_culled(device, pipelines, commands, pass, 0);
  if (!culling->two_passes()) return;
  device.vk.vkCmdEndRendering(commands);
  culling->record_second(device, commands, index, targets.depth);
  begin_pass(device, commands, targets, PassPart::kSecond);
  draw_culled(device, pipelines, commands, pass, 1);
}

void draw_shadows(const Device& device, const Pipelines& pipelines, const FrameSlot& slot,
                  const ScenePass& pass) {
  const VkCommandBuffer commands = slot.commands();
  pipelines.bindings().shadows().record(device, commands, [&](std::uint32_t cascade) {
    bind_set(device, pipelines, slot);
    device.vk.vkCmdPushConstants(commands, pipelines.layout(), VK_SHADER_STAGE_VERTEX_BIT,
                                 sizeof(shaders::DrawData), sizeof(cascade), &cascade);
    const auto pipeline_of = [&](const DrawRun& run) {
      if (run.layout != core::VertexLayout::kObject)
        return pipelines.mesh_shadow(run.layout, run.pushed, run.coverage);
      return pipelines.object_shadow(run.pushed, run.textures != kPlainMaterial,
                                     run.coverage != Coverage::kWhole);
    };
    draw_meshes(device, pipelines, commands, pass, pipeline_of, [](const DrawRun&) {});
  });
}

void draw_particles(const Device& device, const Pipelines& pipelines, const FrameSlot& slot,
                    const ScenePass& pass) {
  const VkCommandBuffer commands = slot.commands();
  TextureBinder textures(device, pipelines, commands, pass.materials);
  VkPipeline bound = VK_NULL_HANDLE;
  for (std::size_t i = 0; i < pass.emitters.size(); ++i) {
    const EmitterRun& run = pass.emitters[i];
    const VkPipeline pipeline = pipelines.particles(run.textures != kPlainMaterial);
    if (pipeline != bound) bind_pipeline(device, commands, pipeline);
    bound = pipeline;
    bind_set(device, pipelines, slot, i);
    textures.bind(run.textures);
    device.vk.vkCmdDraw(commands, run.count * PSYGEN_PARTICLE_VERTICES, 1, 0, 0);
  }
}

void draw_lines(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands,
                const ScenePass& pass) {
  if (pass.line_vertex_count == 0) return;
  bind_pipeline(device, commands, pipelines.lines());
  device.vk.vkCmdDraw(commands, pass.line_vertex_count, 1, pass.glyph_vertex_count, 0);
}

void draw_gui(const Device& device, VkPipeline overlay, VkCommandBuffer commands,
              std::span<const GuiRun> runs) {
  if (runs.empty()) return;
  bind_pipeline(device, commands, overlay);
  for (const GuiRun& run : runs) {
    const VkRect2D clip{{static_cast<std::int32_t>(run.x), static_cast<std::int32_t>(run.y)},
                        {run.width, run.height}};
    device.vk.vkCmdSetScissor(commands, 0, 1, &clip);
    device.vk.vkCmdDraw(commands, run.vertex_count, 1, run.first_vertex, 0);
  }
}

}  // namespace

void draw_sky(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands) {
  if (pipelines.sun() == VK_NULL_HANDLE) {
    bind_pipeline(device, commands, pipelines.sky());
    return device.vk.vkCmdDraw(commands, 3, 1, 0, 0);
  }
  bind_pipeline(device, commands, pipelines.sky_below());
  device.vk.vkCmdDraw(commands, 2 * PSYGEN_BELOW_SIDES + 1, 1, 0, 0);
  bind_pipeline(device, commands, pipelines.sky());
  device.vk.vkCmdDraw(commands, PSYGEN_DOME_COLUMNS * PSYGEN_DOME_STRIP, 1, 0, 0);
  bind_pipeline(device, commands, pipelines.sun());
  device.vk.vkCmdDraw(commands, 4, 1, 0, 0);
}

void draw_water(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands,
                bool lamps) {
  bind_pipeline(device, commands, pipelines.water(lamps));
  device.vk.vkCmdDraw(commands, PSYGEN_WATER_COLUMNS * PSYGEN_WATER_STRIP, 1, 0, 0);
}

void draw_scaled_up(const Device& device, const Pipelines& pipelines, const FrameSlot& slot,
                    Targets& targets) {
  begin_pass_over_coarse(device, slot.commands(), targets);
  bind_set(device, pipelines, slot);
  bind_pipeline(device, slot.commands(), pipelines.scale_up());
  device.vk.vkCmdDraw(slot.commands(), 6, 1, 0, 0);
}

void draw_text(const Device& device, VkPipeline overlay, VkCommandBuffer commands,
               std::uint32_t glyph_vertex_count) {
  if (glyph_vertex_count == 0) return;
  bind_pipeline(device, commands, overlay);
  device.vk.vkCmdDraw(commands, glyph_vertex_count, 1, 0, 0);
}

void record_text(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                 Targets& targets, std::uint32_t glyph_vertex_count) {
  begin_pass(device, slot.commands(), targets);
  bind_set(device, pipelines, slot);
  draw_text(device, pipelines.overlay(false), slot.commands(), glyph_vertex_count);
  device.vk.vkCmdEndRendering(slot.commands());
}

void record_scene(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                  Targets& targets, const ScenePass& pass) {
  const VkCommandBuffer commands = slot.commands();
  slot.timer().mark(device, commands, GpuTimer::Mark::kBegin);
  if (pass.shadows) {
    draw_shadows(device, pipelines, slot, pass);
    slot.timer().mark(device, commands, GpuTimer::Mark::kShadows);
  }
  if (pass.culled.culling != nullptr) {
    draw_culled_passes(device, pipelines, slot, targets, pass);
  } else {
    draw_listed(device, pipelines, slot, targets, pass);
  }
  draw_sky(device, pipelines, commands);
  if (targets.mirrors) {
    device.vk.vkCmdEndRendering(commands);
    begin_pass(device, commands, targets, PassPart::kWater);
  }
  if (pass.water) draw_water(device, pipelines, commands, pass.lamps);
  draw_particles(device, pipelines, slot, pass);
  draw_lines(device, pipelines, commands, pass);
  if (targets.is_coarse()) {
    device.vk.vkCmdEndRendering(commands);
    draw_scaled_up(device, pipelines, slot, targets);
  }
  const VkPipeline overlay = pipelines.overlay(targets.is_coarse());
  draw_text(device, overlay, commands, pass.glyph_vertex_count);
  draw_gui(device, overlay, commands, pass.gui);
  device.vk.vkCmdEndRendering(commands);
  slot.timer().mark(device, commands, GpuTimer::Mark::kEnd);
  if (pass.culled.culling != nullptr) {
    pass.culled.culling->record_counts(device, slot.commands(), pass.culled.slot);
  }
}

}  // namespace psygen::render
