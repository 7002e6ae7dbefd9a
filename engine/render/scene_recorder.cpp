#include "engine/render/scene_recorder.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace psygen::render {

using core::Result;

static_assert(sizeof(IndexedDraw) == sizeof(VkMultiDrawIndexedInfoEXT));
static_assert(offsetof(IndexedDraw, index_count) ==
              offsetof(VkMultiDrawIndexedInfoEXT, indexCount));
static_assert(offsetof(IndexedDraw, vertex_offset) ==
              offsetof(VkMultiDrawIndexedInfoEXT, vertexOffset));

namespace {

bool has_samples(const Targets& targets) {
  return targets.samples.image.get() != VK_NULL_HANDLE;
}

// A frame has one pass, or two with a read of depth in between.
enum class Part : std::uint8_t { kWhole, kFirst, kSecond };

// Moves the targets to the layouts of attachments, after all previous uses.
void to_attachments(const Device& device, VkCommandBuffer commands, Targets& targets, Part part) {
  if (part == Part::kWhole && targets.host_ordered &&
      targets.colour_layout == VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL)
    return;
  VkImageMemoryBarrier2 colour = barrier_of(targets.colour.image.get(), VK_IMAGE_ASPECT_COLOR_BIT);
  colour.srcStageMask =
      VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_2_COPY_BIT;
  colour.srcAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
  colour.dstStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  colour.dstAccessMask =
      VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT;
  colour.newLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  VkImageMemoryBarrier2 depth = barrier_of(targets.depth.image.get(), VK_IMAGE_ASPECT_DEPTH_BIT);
  depth.srcStageMask = VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  depth.srcAccessMask = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  depth.dstStageMask =
      VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  depth.dstAccessMask = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
                        VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
  depth.newLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  if (part == Part::kSecond) {
    colour.oldLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    depth.oldLayout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
    depth.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    depth.srcAccessMask = VK_ACCESS_2_NONE;
  }
  VkImageMemoryBarrier2 samples = colour;
  samples.image = targets.samples.image.get();
  const std::array barriers{colour, depth, samples};
  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.imageMemoryBarrierCount = has_samples(targets) ? 3 : 2;
  dependency.pImageMemoryBarriers = barriers.data();
  device.vk.vkCmdPipelineBarrier2(commands, &dependency);
  targets.colour_layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
}

void begin_pass(const Device& device, VkCommandBuffer commands, Targets& targets,
                Part part = Part::kWhole) {
  to_attachments(device, commands, targets, part);
  VkRenderingAttachmentInfo colour_info{};
  colour_info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  colour_info.imageView = targets.colour.view.get();
  colour_info.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  colour_info.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;  // the sky covers all other pixels
  colour_info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  if (has_samples(targets)) {
    colour_info.imageView = targets.samples.view.get();
    colour_info.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    colour_info.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    colour_info.resolveImageView = targets.colour.view.get();
    colour_info.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  }
  if (part == Part::kFirst) {
    colour_info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    colour_info.resolveMode = VK_RESOLVE_MODE_NONE;
  }
  VkRenderingAttachmentInfo depth_info{};
  depth_info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  depth_info.imageView = targets.depth.view.get();
  depth_info.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  depth_info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;  // to 0, infinitely far
  depth_info.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  if (part == Part::kFirst) depth_info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  if (part == Part::kSecond) colour_info.loadOp = depth_info.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  const VkRect2D area{{0, 0}, {targets.extent.width, targets.extent.height}};
  VkRenderingInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  info.renderArea = area;
  info.layerCount = 1;
  info.colorAttachmentCount = 1;
  info.pColorAttachments = &colour_info;
  info.pDepthAttachment = &depth_info;
  device.vk.vkCmdBeginRendering(commands, &info);
  const VkViewport viewport{0.0F,
                            0.0F,
                            static_cast<float>(targets.extent.width),
                            static_cast<float>(targets.extent.height),
                            0.0F,
                            1.0F};
  device.vk.vkCmdSetViewport(commands, 0, 1, &viewport);
  device.vk.vkCmdSetScissor(commands, 0, 1, &area);
}

// `emitter`: whose data the shaders of particles read.
void bind_set(const Device& device, const Pipelines& pipelines, const FrameSlot& slot,
              std::size_t emitter = 0) {
  const VkDescriptorSet set = slot.set();
  const auto offset = static_cast<std::uint32_t>(emitter * sizeof(shaders::EmitterData));
  device.vk.vkCmdBindDescriptorSets(slot.commands(), VK_PIPELINE_BIND_POINT_GRAPHICS,
                                    pipelines.layout(), 0, 1, &set, 1, &offset);
}

void bind_pipeline(const Device& device, VkCommandBuffer commands, VkPipeline pipeline) {
  device.vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
}

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
    return pipelines.mesh(draws.layout, pushed, draws.fading, lamps, view);
  return pipelines.object(pushed, draws.textures != kPlainMaterial, draws.fading, lamps, view);
}

// Draws the runs of the list, each with the pipeline pipeline_of(run).
template <class PipelineOf>
void draw_meshes(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands,
                 const ScenePass& pass, const PipelineOf& pipeline_of) {
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
  }
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
  begin_pass(device, commands, targets, culling->two_passes() ? Part::kFirst : Part::kWhole);
  bind_set(device, pipelines, slot);
  draw_culled(device, pipelines, commands, pass, 0);
  if (!culling->two_passes()) return;
  device.vk.vkCmdEndRendering(commands);
  culling->record_second(device, commands, index, targets.depth);
  begin_pass(device, commands, targets, Part::kSecond);
  draw_culled(device, pipelines, commands, pass, 1);
}

void draw_shadows(const Device& device, const Pipelines& pipelines, const FrameSlot& slot,
                  const ScenePass& pass) {
  const VkCommandBuffer commands = slot.commands();
  pipelines.shadows().record(device, commands, [&](std::uint32_t cascade) {
    bind_set(device, pipelines, slot);
    device.vk.vkCmdPushConstants(commands, pipelines.layout(), VK_SHADER_STAGE_VERTEX_BIT,
                                 sizeof(shaders::DrawData), sizeof(cascade), &cascade);
    draw_meshes(device, pipelines, commands, pass, [&](const DrawRun& run) {
      if (run.layout != core::VertexLayout::kObject)
        return pipelines.mesh_shadow(run.layout, run.pushed, run.fading);
      return pipelines.object_shadow(run.pushed, run.textures != kPlainMaterial, run.fading);
    });
  });
}

void draw_water_and_sky(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands,
                        bool water, bool lamps) {
  if (water) {
    bind_pipeline(device, commands, pipelines.water(lamps));
    device.vk.vkCmdDraw(commands, PSYGEN_WATER_RINGS * PSYGEN_WATER_STRIP, 1, 0, 0);
  }
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

void draw_lines_and_text(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands,
                         std::uint32_t glyph_vertex_count, std::uint32_t line_vertex_count) {
  if (line_vertex_count > 0) {
    bind_pipeline(device, commands, pipelines.lines());
    device.vk.vkCmdDraw(commands, line_vertex_count, 1, glyph_vertex_count, 0);
  }
  if (glyph_vertex_count == 0) return;
  bind_pipeline(device, commands, pipelines.overlay());
  device.vk.vkCmdDraw(commands, glyph_vertex_count, 1, 0, 0);
}

void draw_gui(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands,
              std::span<const GuiRun> runs) {
  if (runs.empty()) return;
  bind_pipeline(device, commands, pipelines.overlay());
  for (const GuiRun& run : runs) {
    const VkRect2D clip{{static_cast<std::int32_t>(run.x), static_cast<std::int32_t>(run.y)},
                        {run.width, run.height}};
    device.vk.vkCmdSetScissor(commands, 0, 1, &clip);
    device.vk.vkCmdDraw(commands, run.vertex_count, 1, run.first_vertex, 0);
  }
}

void to_copy_source(const Device& device, VkCommandBuffer commands, Targets& targets) {
  if (targets.colour_layout == VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL) return;
  VkImageMemoryBarrier2 barrier = barrier_of(targets.colour.image.get(), VK_IMAGE_ASPECT_COLOR_BIT);
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT;
  barrier.oldLayout = targets.colour_layout;
  barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  image_barrier(device, commands, barrier);
  targets.colour_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
}

constexpr VkImageSubresourceLayers kColourLayer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

// The depth pyramid reads depth, if the device supports it.
VkImageUsageFlags depth_usage(const Device& device, VkSampleCountFlagBits samples) {
  const bool readable = (device.sampled_depth_counts & samples) != 0;
  VkImageUsageFlags usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  if (readable) usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
  return usage;
}

}  // namespace

Result<Targets> make_targets(const Device& device, VkFormat format, core::Extent extent,
                             VkSampleCountFlagBits samples) {
  Targets targets;
  targets.extent = extent;
  Result<Image> colour = make_image(
      device, extent, format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
      VK_IMAGE_ASPECT_COLOR_BIT);
  if (!colour) return tl::unexpected(colour.error());
  targets.colour = std::move(*colour);
  Result<Image> depth = make_image(device, extent, kDepthFormat, depth_usage(device, samples),
                                   VK_IMAGE_ASPECT_DEPTH_BIT, {.samples = samples});
  if (!depth) return tl::unexpected(depth.error());
  targets.depth = std::move(*depth);
  if (samples == VK_SAMPLE_COUNT_1_BIT) return targets;
  Result<Image> drawn = make_image(device, extent, format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                   VK_IMAGE_ASPECT_COLOR_BIT, {.samples = samples});
  if (!drawn) return tl::unexpected(drawn.error());
  targets.samples = std::move(*drawn);
  return targets;
}

void record_text(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                 Targets& targets, std::uint32_t glyph_vertex_count) {
  begin_pass(device, slot.commands(), targets);
  bind_set(device, pipelines, slot);
  draw_lines_and_text(device, pipelines, slot.commands(), glyph_vertex_count, 0);
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
    begin_pass(device, commands, targets);
    bind_set(device, pipelines, slot);
    draw_meshes(device, pipelines, commands, pass, [&](const DrawRun& run) {
      return picture_pipeline(pipelines, run, run.pushed, run.lamps, pass.view);
    });
  }
  draw_water_and_sky(device, pipelines, commands, pass.water, pass.lamps);
  draw_particles(device, pipelines, slot, pass);
  draw_lines_and_text(device, pipelines, commands, pass.glyph_vertex_count, pass.line_vertex_count);
  draw_gui(device, pipelines, commands, pass.gui);
  device.vk.vkCmdEndRendering(commands);
  slot.timer().mark(device, commands, GpuTimer::Mark::kEnd);
  if (pass.culled.culling != nullptr) {
    pass.culled.culling->record_counts(device, slot.commands(), pass.culled.slot);
  }
}

void record_warm_up(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                    Targets& targets, VkBuffer blank, int step, bool lamps) {
  const VkCommandBuffer commands = slot.commands();
  begin_pass(device, commands, targets);
  bind_set(device, pipelines, slot);
  const VkDeviceSize zero = 0;
  device.vk.vkCmdBindVertexBuffers(commands, 0, 1, &blank, &zero);
  device.vk.vkCmdBindIndexBuffer(commands, blank, 0, VK_INDEX_TYPE_UINT16);
  const shaders::DrawData data{};
  device.vk.vkCmdPushConstants(commands, pipelines.layout(), VK_SHADER_STAGE_VERTEX_BIT, 0,
                               sizeof(data), &data);
  const auto draw_twice = [&](core::VertexLayout layout, bool fading) {
    for (const bool pushed : {false, true}) {
      bind_pipeline(device, commands, pipelines.mesh(layout, pushed, fading, lamps, View::kNormal));
      device.vk.vkCmdDrawIndexed(commands, 3, 1, 0, 0, 0);
    }
  };
  if (step == 0) {
    draw_twice(core::VertexLayout::kTerrain, false);
    draw_twice(core::VertexLayout::kTerrain, true);
  }
  if (step == 1) draw_twice(core::VertexLayout::kModel, false);
  if (step == 2) draw_twice(core::VertexLayout::kModel, true);
  if (step == 3) draw_water_and_sky(device, pipelines, commands, true, lamps);
  if (step == 4) draw_lines_and_text(device, pipelines, commands, 3, 0);
  device.vk.vkCmdEndRendering(commands);
}

void record_object_warm_up(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                           Targets& targets, VkBuffer blank, VkDescriptorSet textures, int step,
                           bool lamps) {
  const VkCommandBuffer commands = slot.commands();
  begin_pass(device, commands, targets);
  bind_set(device, pipelines, slot);
  device.vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.layout(),
                                    1, 1, &textures, 0, nullptr);
  const VkDeviceSize zero = 0;
  device.vk.vkCmdBindVertexBuffers(commands, 0, 1, &blank, &zero);
  device.vk.vkCmdBindIndexBuffer(commands, blank, 0, VK_INDEX_TYPE_UINT16);
  const shaders::DrawData data{};
  device.vk.vkCmdPushConstants(commands, pipelines.layout(), VK_SHADER_STAGE_VERTEX_BIT, 0,
                               sizeof(data), &data);
  for (const bool pushed : {false, true}) {
    for (const bool fading : {false, true}) {
      bind_pipeline(device, commands,
                    pipelines.object(pushed, step == 1, fading, lamps, View::kNormal));
      device.vk.vkCmdDrawIndexed(commands, 3, 1, 0, 0, 0);
    }
  }
  device.vk.vkCmdEndRendering(commands);
}

void record_particle_warm_up(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                             Targets& targets, VkDescriptorSet textures, int step) {
  const VkCommandBuffer commands = slot.commands();
  begin_pass(device, commands, targets);
  bind_set(device, pipelines, slot);
  device.vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.layout(),
                                    1, 1, &textures, 0, nullptr);
  bind_pipeline(device, commands, pipelines.particles(step == 1));
  device.vk.vkCmdDraw(commands, PSYGEN_PARTICLE_VERTICES, 1, 0, 0);
  device.vk.vkCmdEndRendering(commands);
}

void record_copy_to_window(const Device& device, VkCommandBuffer commands, Targets& targets,
                           VkImage window, core::Extent window_extent) {
  to_copy_source(device, commands, targets);
  VkImageMemoryBarrier2 barrier = barrier_of(window, VK_IMAGE_ASPECT_COLOR_BIT);
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;  // the stage that waits for the image
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
  barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  image_barrier(device, commands, barrier);
  VkImageCopy copy{};
  copy.srcSubresource = kColourLayer;
  copy.dstSubresource = kColourLayer;
  copy.extent = {std::min(targets.extent.width, window_extent.width),
                 std::min(targets.extent.height, window_extent.height), 1};
  device.vk.vkCmdCopyImage(commands, targets.colour.image.get(),
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, window,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
  barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_NONE;
  barrier.dstAccessMask = VK_ACCESS_2_NONE;
  barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  barrier.newLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  image_barrier(device, commands, barrier);
}

void record_copy_to_buffer(const Device& device, VkCommandBuffer commands, Targets& targets,
                           VkBuffer buffer) {
  to_copy_source(device, commands, targets);
  VkBufferImageCopy copy{};
  copy.imageSubresource = kColourLayer;
  copy.imageExtent = {targets.extent.width, targets.extent.height, 1};
  device.vk.vkCmdCopyImageToBuffer(commands, targets.colour.image.get(),
                                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &copy);
  memory_barrier(device, commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                 VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
}

}  // namespace psygen::render
