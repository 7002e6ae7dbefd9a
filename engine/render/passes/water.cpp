#include "engine/render/passes/water.hpp"

namespace psygen::render {

using core::Result;

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
  const bool lit = setup.traits.pixel_light;
  PipelineShape shape{.vert = lit ? Shader::kWaterPixelLightVert : Shader::kWaterVert,
                      .frag = !lit                ? Shader::kWaterColourFrag
                              : setup.reflections ? Shader::kWaterMirrorFrag
                                                  : Shader::kWaterFrag,
                      .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP,
                      .blend = Blend::kPremultiplied,
                      .depth = DepthUse::kWrite};
  const VkPipelineLayout layout = set_.exists() ? set_.layout() : setup.sets.layout();
  for (const bool lamps : {false, true}) {
    UniquePipeline& pipeline = lamps ? lamplit_ : plain_;
    if (pipeline.exists() || (lamps && !setup.features.has(Feature::kPointLights))) continue;
    shape.constants = {on(setup.traits.waves), VK_FALSE, on(lamps)};
    if (Result<void> made = setup.pipelines.make(layout, shape, pipeline); !made) return made;
  }
  return {};
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

void Water::draw(const Recording& to, bool lamps) const {
  to.bind_pipeline(lamps ? lamplit_.get() : plain_.get());
  if (set_.exists()) set_.bind(to.device, to.commands(), to.slot.number());
  to.draw(PSYGEN_WATER_COLUMNS * PSYGEN_WATER_STRIP);
}

}  // namespace psygen::render
