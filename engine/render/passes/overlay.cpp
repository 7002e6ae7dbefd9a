#include "engine/render/passes/overlay.hpp"

namespace psygen::render {

using core::Result;

Result<void> Overlay::create(const PassSetup& setup) {
  if (full_size_.exists()) return {};
  const Device& device = setup.device;
  const std::array bindings{
      SetBinding{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT,
                 setup.sets.smooth_sampler()},
      SetBinding{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_VERTEX_BIT}};
  static_assert(PSYGEN_OVERLAY_FONT == 0 && PSYGEN_OVERLAY_VERTICES == 1);
  PipelineShape shape{.vert = Shader::kOverlayVert,
                      .frag = Shader::kOverlayFrag,
                      .blend = Blend::kAlpha,
                      .depth = DepthUse::kNone};
  return make_texture(device, setup.overlay.atlas_size(), VK_FORMAT_R8_UNORM, setup.overlay.atlas())
      .map(into(font_))
      .and_then([&] { return set_.create(setup, bindings, setup.sets.shared()); })
      .and_then([&] {
        return vertices_.create(device, setup.sets.slots(),
                                OverlayLayout::kMaxQuads * 6 * sizeof(shaders::OverlayVertex),
                                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
      })
      .and_then([&] {
        for (std::size_t slot = 0; slot < setup.sets.slots(); ++slot)
          set_.write(device, slot, PSYGEN_OVERLAY_FONT,
                     {VK_NULL_HANDLE, font_.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
        set_.write(device, PSYGEN_OVERLAY_VERTICES, vertices_);
        return setup.pipelines.make(set_.layout(), shape, landscape_);
      })
      .and_then([&] {
        shape.target = DrawTarget::kPicture;
        return setup.pipelines.make(set_.layout(), shape, full_size_);
      });
}

void Overlay::list(const FrameInput& input, const FrameFacts& facts) {
  glyphs_.clear();
  gui_runs_.clear();
  if (input.hud != nullptr) facts.overlay.lay_out(*input.hud, facts.size, glyphs_);
  facts.overlay.lay_out(input.panels, facts.size, input.text_scale, glyphs_);
  text_count_ = static_cast<std::uint32_t>(glyphs_.size());
  if (input.gui != nullptr) facts.overlay.lay_out(*input.gui, facts.size, glyphs_, gui_runs_);
}

Result<void> Overlay::write(const Device& device, std::size_t slot) {
  return set_.fill(device, slot, PSYGEN_OVERLAY_VERTICES, vertices_,
                   std::as_bytes(std::span(glyphs_)));
}

void Overlay::bind(const Recording& to) const {
  to.bind_pipeline(to.targets.is_low_resolution() ? full_size_.get() : landscape_.get());
  set_.bind(to.device, to.commands(), to.slot.number());
}

void Overlay::record(const Recording& to) const {
  if (glyphs_.empty()) return;
  bind(to);
  if (text_count_ > 0) to.draw(text_count_);
  for (const GuiRun& run : gui_runs_) {
    const VkRect2D clip{{static_cast<std::int32_t>(run.x), static_cast<std::int32_t>(run.y)},
                        {run.width, run.height}};
    to.device.vk.vkCmdSetScissor(to.commands(), 0, 1, &clip);
    to.draw(run.vertex_count, run.first_vertex);
  }
}

void Overlay::warm_up(const Recording& to, const WarmUpStep&) const {
  bind(to);
  to.draw(3);
}

}  // namespace psygen::render
