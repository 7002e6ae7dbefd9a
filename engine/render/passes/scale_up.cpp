#include "engine/render/passes/scale_up.hpp"

namespace psygen::render {

using core::Result;

Result<void> ScaleUp::create(const PassSetup& setup) {
  if (pipeline_.exists()) return {};
  any_image_ = setup.sets.any_image();
  const std::array bindings{
      SetBinding{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_SHADER_STAGE_VERTEX_BIT},
      SetBinding{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT,
                 setup.sets.smooth_sampler()}};
  static_assert(PSYGEN_BINDING_FRAME == 0 && PSYGEN_SCALE_UP_LANDSCAPE == 1);
  return set_.create(setup, bindings, {}).and_then([&] {
    const PipelineShape shape{.vert = Shader::kScaleUpVert,
                              .frag = Shader::kScaleUpFrag,
                              .depth = DepthUse::kNone,
                              .target = DrawTarget::kPicture};
    return setup.pipelines.make(set_.layout(), shape, pipeline_);
  });
}

void ScaleUp::use(const Device& device, const FrameSlot& slot, const Targets& targets) {
  if (!set_.exists()) return;
  const VkImageView landscape = targets.low_resolution.view.get();
  set_.write(device, slot.number(), PSYGEN_BINDING_FRAME, slot.frame_data());
  set_.write(device, slot.number(), PSYGEN_SCALE_UP_LANDSCAPE,
             landscape == VK_NULL_HANDLE
                 ? any_image_
                 : VkDescriptorImageInfo{VK_NULL_HANDLE, landscape, kLowResolutionLayout});
}

void ScaleUp::record(const Recording& to) const {
  if (!to.targets.is_low_resolution()) return;
  to.bind_pipeline(pipeline_.get());
  set_.bind(to.device, to.commands(), to.slot.number());
  to.draw(6);
  to.sets.bind(to.device, to.commands(), to.slot.number());  // for the passes that follow
}

}  // namespace psygen::render
