#include "engine/render/passes/gpu_culling.hpp"
#include "engine/render/passes/passes.hpp"

namespace psygen::render {

namespace {

template <Stage kStage>
void record_stage(const Passes& passes, const Recording& to) {
  std::uint32_t number = 0;
  for_each_pass(passes, [&](const auto& pass) {
    if constexpr (std::remove_cvref_t<decltype(pass)>::kStage == kStage) {
      pass.record(to);
      to.slot.timer().mark_pass(to.device, to.commands(), number);
    }
    ++number;
  });
}

void end_rendering(const Recording& to) {
  to.device.vk.vkCmdEndRendering(to.commands());
}

// Binds what the draws of a warm-up read. All vertices of the bound buffers are the same, so their
// triangles cover nothing; passes without vertex buffers draw what they make themselves.
void bind_blank(const Recording& to, VkDescriptorSet textures) {
  const VkDeviceSize zero = 0;
  const VkBuffer blank = to.buffers.shared_indices;
  to.sets.bind(to.device, to.commands(), to.slot.number());
  if (textures != VK_NULL_HANDLE) to.sets.bind_textures(to.device, to.commands(), textures);
  to.device.vk.vkCmdBindVertexBuffers(to.commands(), 0, 1, &blank, &zero);
  to.device.vk.vkCmdBindIndexBuffer(to.commands(), blank, 0, VK_INDEX_TYPE_UINT16);
}

// Records a step of a pass in each kind of rendering in which its stage may be drawn.
template <class P>
void record_step(const P& pass, const Recording& to, const WarmUpStep& step) {
  constexpr Stage kStage = P::kStage;
  const bool has_low_resolution = to.targets.low_resolution.view.get() != VK_NULL_HANDLE;
  to.targets.drawn = to.targets.extent;
  to.targets.reflects = kStage == Stage::kSurface && to.targets.reflection.exists();
  begin_rendering(to.device, to.commands(), to.targets);
  if (to.targets.reflects) {
    end_rendering(to);
    begin_rendering(to.device, to.commands(), to.targets, RenderingPart::kWater);
  }
  pass.warm_up(to, step);
  end_rendering(to);
  if (kStage != Stage::kPicture || !has_low_resolution) return;
  to.targets.drawn = {to.targets.extent.width / 2, to.targets.extent.height / 2};
  begin_rendering(to.device, to.commands(), to.targets);
  end_rendering(to);
  begin_upscale_rendering(to.device, to.commands(), to.targets);
  pass.warm_up(to, step);
  end_rendering(to);
  to.targets.drawn = to.targets.extent;
}

}  // namespace

void record_frame(const Passes& passes, const Recording& to) {
  GpuTimer& timer = to.slot.timer();
  timer.mark(to.device, to.commands(), GpuTimer::Mark::kBegin);
  to.sets.bind(to.device, to.commands(), to.slot.number());
  record_stage<Stage::kBefore>(passes, to);
  record_stage<Stage::kLandscape>(passes, to);  // its first pass begins the rendering
  if (to.targets.reflects) {
    end_rendering(to);
    begin_rendering(to.device, to.commands(), to.targets, RenderingPart::kWater);
  }
  record_stage<Stage::kSurface>(passes, to);
  if (to.targets.is_low_resolution()) {
    end_rendering(to);
    begin_upscale_rendering(to.device, to.commands(), to.targets);
  }
  record_stage<Stage::kPicture>(passes, to);
  end_rendering(to);
  timer.mark(to.device, to.commands(), GpuTimer::Mark::kEnd);
  if (to.culling != nullptr) to.culling->record_counts(to.device, to.commands(), to.slot.number());
}

void record_text(const Passes& passes, const Recording& to) {
  begin_rendering(to.device, to.commands(), to.targets);
  to.sets.bind(to.device, to.commands(), to.slot.number());
  std::get<Overlay>(passes).record(to);
  end_rendering(to);
}

int warm_up_steps(const Passes& passes, Feature feature) {
  int steps = 0;
  for_each_pass(passes, [&]<class P>(const P&) {
    if constexpr (WarmsUp<P>) steps += P::warm_up_steps(feature);
  });
  return steps;
}

void record_warm_up(const Passes& passes, const Recording& to, WarmUpStep step,
                    VkDescriptorSet textures) {
  bind_blank(to, textures);
  for_each_pass(passes, [&]<class P>(const P& pass) {
    if constexpr (WarmsUp<P>) {
      const int steps = P::warm_up_steps(step.feature);
      if (step.number >= 0 && step.number < steps) record_step(pass, to, step);
      step.number -= steps;
    }
  });
}

}  // namespace psygen::render
