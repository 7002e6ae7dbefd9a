#include "engine/render/warm_up.hpp"

namespace psygen::render {
namespace {

// Begins a pass. `draw` draws in it.
template <class Draw>
void warm_up_pass(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                  Targets& targets, const Draw& draw) {
  begin_pass(device, slot.commands(), targets);
  bind_set(device, pipelines, slot);
  draw(slot.commands());
  device.vk.vkCmdEndRendering(slot.commands());
}

// For draws of triangles that cover nothing: all their vertices are the same.
void bind_blank(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands,
                VkBuffer blank) {
  const VkDeviceSize zero = 0;
  device.vk.vkCmdBindVertexBuffers(commands, 0, 1, &blank, &zero);
  device.vk.vkCmdBindIndexBuffer(commands, blank, 0, VK_INDEX_TYPE_UINT16);
  const shaders::DrawData data{};
  device.vk.vkCmdPushConstants(commands, pipelines.layout(), VK_SHADER_STAGE_VERTEX_BIT, 0,
                               sizeof(data), &data);
}

void bind_textures(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands,
                   VkDescriptorSet textures) {
  device.vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.layout(),
                                    1, 1, &textures, 0, nullptr);
}

}  // namespace

void record_warm_up(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                    Targets& targets, VkBuffer blank, int step, bool lamps) {
  targets.mirrors = step == 3 && targets.mirror.exists();
  warm_up_pass(device, pipelines, slot, targets, [&](VkCommandBuffer commands) {
    bind_blank(device, pipelines, commands, blank);
    const auto draw_twice = [&](core::VertexLayout layout, Coverage coverage) {
      for (const bool pushed : {false, true}) {
        bind_pipeline(device, commands,
                      pipelines.mesh(layout, pushed, coverage, lamps, View::kNormal));
        device.vk.vkCmdDrawIndexed(commands, 3, 1, 0, 0, 0);
      }
    };
    if (step == 0) {
      draw_twice(core::VertexLayout::kTerrain, Coverage::kWhole);
      draw_twice(core::VertexLayout::kTerrain, Coverage::kPart);
    }
    if (step == 1) {
      draw_twice(core::VertexLayout::kModel, Coverage::kWhole);
      draw_twice(core::VertexLayout::kModel, Coverage::kNear);
    }
    if (step == 2) {
      draw_twice(core::VertexLayout::kModel, Coverage::kPart);
      draw_twice(core::VertexLayout::kModel, Coverage::kPictured);
    }
    if (step == 3) {
      draw_sky(device, pipelines, commands);
      if (targets.mirrors) {
        device.vk.vkCmdEndRendering(commands);
        begin_pass(device, commands, targets, PassPart::kWater);
      }
      draw_water(device, pipelines, commands, lamps);
    }
    if (step == 4) draw_text(device, pipelines.overlay(false), commands, 3);
  });
  if (step == 4 && targets.is_coarse()) {
    draw_scaled_up(device, pipelines, slot, targets);
    draw_text(device, pipelines.overlay(true), slot.commands(), 3);
    device.vk.vkCmdEndRendering(slot.commands());
  }
}

void record_object_warm_up(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                           Targets& targets, VkBuffer blank, VkDescriptorSet textures, int step,
                           bool lamps) {
  warm_up_pass(device, pipelines, slot, targets, [&](VkCommandBuffer commands) {
    bind_textures(device, pipelines, commands, textures);
    bind_blank(device, pipelines, commands, blank);
    for (const bool pushed : {false, true}) {
      for (const bool fading : {false, true}) {
        bind_pipeline(device, commands,
                      pipelines.object(pushed, step == 1, fading, lamps, View::kNormal));
        device.vk.vkCmdDrawIndexed(commands, 3, 1, 0, 0, 0);
      }
    }
  });
}

void record_particle_warm_up(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                             Targets& targets, VkDescriptorSet textures, int step) {
  warm_up_pass(device, pipelines, slot, targets, [&](VkCommandBuffer commands) {
    bind_textures(device, pipelines, commands, textures);
    bind_pipeline(device, commands, pipelines.particles(step == 1));
    device.vk.vkCmdDraw(commands, PSYGEN_PARTICLE_VERTICES, 1, 0, 0);
  });
}

}  // namespace psygen::render
