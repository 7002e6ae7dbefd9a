#include "engine/render/passes/water.hpp"

#include "engine/render/meshes/layouts.hpp"

namespace psygen::render {

using core::Result;

static_assert(PSYGEN_WATER_DEPTH_M == core::kWaterVertexDepthM &&
              PSYGEN_WATER_SPEED == core::kWaterVertexSpeed);

Result<void> Water::create(const PassSetup& setup) {
  if (setup.reflections && !set_.exists()) {
    constexpr VkDescriptorType kTexture = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const std::array bindings{
        SetBinding{kTexture, VK_SHADER_STAGE_FRAGMENT_BIT, setup.sets.smooth_sampler()},
        SetBinding{kTexture, VK_SHADER_STAGE_FRAGMENT_BIT, setup.sets.nearest_sampler()}};
    static_assert(PSYGEN_REFLECTION_COLOUR == 0 && PSYGEN_REFLECTION_DEPTH == 1);
    any_image_ = setup.sets.any_image();
    if (Result<void> made = set_.create(setup, bindings, setup.sets.shared()); !made) return made;
  }
  const bool lit = setup.traits.pixel_light, mirror = lit && setup.reflections;
  const auto shape_of = [](Shader vert, Shader frag) {
    return PipelineShape{
        .vert = vert, .frag = frag, .blend = Blend::kPremultiplied, .depth = DepthUse::kWrite};
  };
  PipelineShape plane = shape_of(lit ? Shader::kWaterPixelLightVert : Shader::kWaterVert,
                                 mirror ? Shader::kWaterMirrorFrag
                                 : lit  ? Shader::kWaterFrag
                                        : Shader::kWaterColourFrag);
  plane.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  PipelineShape surface =
      shape_of(lit ? Shader::kWaterSurfacePixelLightVert : Shader::kWaterSurfaceVert,
               mirror ? Shader::kWaterFlowMirrorFrag
               : lit  ? Shader::kWaterFlowFrag
                      : Shader::kWaterColourFrag);
  surface.vertices = core::VertexLayout::kModel;
  return create(setup, plane, plane_pipelines_).and_then([&] {
    return create(setup, surface, surface_pipelines_);
  });
}

Result<void> Water::create(const PassSetup& setup, PipelineShape shape, Pipelines& pipelines) {
  const VkPipelineLayout layout = set_.exists() ? set_.layout() : setup.sets.layout();
  for (const bool lamps : {false, true}) {
    UniquePipeline& pipeline = lamps ? pipelines.lamplit : pipelines.plain;
    if (pipeline.exists() || (lamps && !setup.features.has(Feature::kPointLights))) continue;
    shape.constants = {on(setup.traits.waves), VK_FALSE, on(lamps)};
    if (Result<void> made = setup.pipelines.make(layout, shape, pipeline); !made) return made;
  }
  return {};
}

void Water::list(const FrameInput& input, const FrameFacts&) {
  plane_ = input.water.has_value();
  surfaces_.clear();
  for (const MeshDraw& draw : input.water_surfaces)
    surfaces_.push_back({draw.range, {data_of(draw)}});
}

std::uint64_t Water::surface_triangles() const {
  std::uint64_t triangles = 0;
  for (const Surface& surface : surfaces_)
    triangles += surface.range.index_count / 3;
  return triangles;
}

void Water::use(const Device& device, const FrameSlot& slot, const Targets& targets) {
  if (!set_.exists()) return;
  const auto image = [&](const Image& read) -> VkDescriptorImageInfo {
    if (read.view.get() == VK_NULL_HANDLE) return any_image_;
    return {VK_NULL_HANDLE, read.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  };
  set_.write(device, slot.number(), PSYGEN_REFLECTION_COLOUR, image(targets.reflection.colour));
  set_.write(device, slot.number(), PSYGEN_REFLECTION_DEPTH, image(targets.reflection.depth));
}

void Water::bind(const Recording& to, VkPipeline pipeline) const {
  to.bind_pipeline(pipeline);
  if (set_.exists()) set_.bind(to.device, to.commands(), to.slot.number());
}

void Water::record(const Recording& to) const {
  if (plane_) {
    bind(to, plane_pipelines_.of(to.lamps));
    to.draw(PSYGEN_WATER_COLUMNS * PSYGEN_WATER_STRIP);
  }
  if (surfaces_.empty()) return;
  bind(to, surface_pipelines_.of(to.lamps));
  const VkPipelineLayout layout = set_.exists() ? set_.layout() : to.sets.layout();
  VkBuffer bound = VK_NULL_HANDLE;
  for (const Surface& surface : surfaces_) {
    const VkBuffer buffer = to.buffers.pool_blocks[surface.range.pool_block].buffer.get();
    if (buffer != bound) {
      const VkDeviceSize zero = 0;
      to.device.vk.vkCmdBindVertexBuffers(to.commands(), 0, 1, &buffer, &zero);
      to.device.vk.vkCmdBindIndexBuffer(to.commands(), buffer, 0, VK_INDEX_TYPE_UINT16);
      bound = buffer;
    }
    to.device.vk.vkCmdPushConstants(to.commands(), layout, VK_SHADER_STAGE_VERTEX_BIT, 0,
                                    sizeof surface.pushed, &surface.pushed);
    to.device.vk.vkCmdDrawIndexed(to.commands(), surface.range.index_count, 1,
                                  surface.range.first_index,
                                  static_cast<std::int32_t>(surface.range.first_vertex), 0);
  }
}

void Water::warm_up(const Recording& to, const WarmUpStep& step) const {
  bind(to, plane_pipelines_.of(step.lamps));
  to.draw(PSYGEN_WATER_COLUMNS * PSYGEN_WATER_STRIP);
  bind(to, surface_pipelines_.of(step.lamps));
  to.device.vk.vkCmdDrawIndexed(to.commands(), 3, 1, 0, 0, 0);
}

}  // namespace psygen::render
