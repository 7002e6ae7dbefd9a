// The renderer's objects for one preset: pipelines, culling, targets. They are created at the start
// and again for another preset. Also the text picture that is shown meanwhile.
#include <utility>

#include "engine/render/device/pipeline_build.hpp"
#include "engine/render/frame/frame_data.hpp"
#include "engine/render/passes/warm_up.hpp"
#include "engine/render/renderer_impl.hpp"

namespace psygen::render {

using core::Result;

namespace {

// Share of creating the pipelines in the time until everything has been drawn once.
constexpr double kPipelinesShare = 0.3;

Progress part_of(const Progress& whole, double from, double to) {
  if (!whole) return {};
  return [&whole, from, to](double fraction) { return whole(from + (to - from) * fraction); };
}

}  // namespace

Result<void> RendererImpl::create_looks(Preset preset, const Progress& progress) {
  preset_ = preset;
  return pipelines_
      .create(*device_, colour_format_, traits_of(preset), overlay_,
              static_cast<std::uint32_t>(kFramesInFlight), materials_, pictures_, options_.ground)
      .and_then([&] {
        use_pipelines();
        return create_culling();
      })
      .and_then([&]() -> Result<void> {
        if (options_.surface == nullptr) return create_targets(options_.size);
        return swapchain_.exists() ? create_targets(swapchain_.extent()) : Result<void>{};
      })
      .and_then([&] { return go_on(progress, 0); })
      .and_then(
          [&] { return pipelines_.create_others(*device_, part_of(progress, 0, kPipelinesShare)); })
      .and_then([&] { return warm_up(part_of(progress, kPipelinesShare, 1)); });
}

void RendererImpl::use_pipelines() {
  for (FrameSlot& slot : slots_)
    slot.use(*device_, pipelines_.bindings(), index_of(slot));
  use_targets();
}

// Binds what shaders read of the targets to the sets of the slots, after either has changed.
void RendererImpl::use_targets() {
  if (targets_.empty()) return;
  for (const FrameSlot& slot : slots_)
    pipelines_.bindings().write_targets(*device_, slot.set(), targets_of(slot));
}

Result<void> RendererImpl::set_preset(Preset preset, const Progress& progress) {
  if (lost_) return core::fail(core::ErrorCode::kDeviceLost, "the device was lost before");
  if (preset == preset_) return {};
  wait_idle();
  if (!targets_.empty()) options_.size = size();
  Preset other_preset = preset_;
  Pipelines other_pipelines;
  std::unique_ptr<GpuCulling> other_culling;
  std::vector<Targets> other_targets;
  const auto exchange = [&] {
    std::swap(other_preset, preset_);
    std::swap(other_pipelines, pipelines_);
    std::swap(other_culling, culling_);
    std::swap(other_targets, targets_);
  };
  exchange();  // keeps the old ones until the new ones exist
  Result<void> made = noted(create_looks(preset, progress));
  if (made && other_pipelines.has_objects()) made = noted(pipelines_.create_objects(*device_));
  if (made && other_pipelines.has_lamps()) made = noted(pipelines_.create_lamps(*device_));
  if (made && other_pipelines.has_particles()) made = noted(pipelines_.create_particles(*device_));
  wait_idle();
  has_list_ = has_picture_ = false;
  gpu_.reset();
  idle_value_ = warm_up_value_ = frame_value_;
  if (!made) {
    exchange();
    use_pipelines();
    swapchain_stale_ = true;  // the window may have changed meanwhile
    return made;
  }
  return {};
}

// Targets for draws before the first frame, which are bound until use_targets().
Result<Targets> RendererImpl::make_small_targets() {
  wait_idle();
  Result<Targets> small =
      make_targets(*device_, colour_format_, {16, 16}, pipelines_.samples(), pipelines_.mirrors());
  if (!small) return small;
  if (scales_up_) {
    if (Result<void> added = add_coarse(*device_, colour_format_, *small); !added)
      return tl::unexpected(added.error());
  }
  for (const FrameSlot& slot : slots_)
    pipelines_.bindings().write_targets(*device_, slot.set(), *small);
  return small;
}

Result<void> RendererImpl::warm_up(const Progress& progress) {
  Result<Targets> small = make_small_targets();
  if (!small) return tl::unexpected(small.error());
  FrameSlot& slot = slots_[0];
  const FrameInput nothing;
  for (int step = 0; step < kWarmUpSteps; ++step) {
    const Result<void> drawn =
        slot.write(*device_, pipelines_.bindings(), frame_data(nothing, small->extent),
                   std::vector<shaders::DrawData>(1), std::vector<shaders::OverlayVertex>(3))
            .and_then([&] { return slot.begin(*device_); })
            .and_then([&] {
              const bool coarse = scales_up_ && step == kWarmUpSteps - 1;
              small->drawn = coarse ? core::Extent{8, 8} : small->extent;
              record_warm_up(*device_, pipelines_, slot, *small, shared_.buffer(), step);
              return slot.end(*device_);
            })
            .and_then([&] { return submit(slot, false); })
            .and_then([&] { return wait_for(slot); })
            .and_then([&] { return go_on(progress, (step + 1.0) / kWarmUpSteps); });
    if (!drawn) return drawn;
  }
  use_targets();
  small->drawn = small->extent;
  return culling_ ? warm_up_culling(slot, *small) : Result<void>{};
}

Result<void> RendererImpl::prepare_objects() {
  if (lost_) return core::fail(core::ErrorCode::kDeviceLost, "the device was lost before");
  if (pipelines_.has_objects()) return {};
  return noted(pipelines_.create_objects(*device_)
                   .and_then([&] { return warm_up_objects(false); })
                   .and_then([&] {
                     return pipelines_.has_lamps() ? warm_up_objects(true) : Result<void>{};
                   }));
}

Result<void> RendererImpl::prepare_lights() {
  if (lost_) return core::fail(core::ErrorCode::kDeviceLost, "the device was lost before");
  if (pipelines_.has_lamps()) return {};
  return noted(
      pipelines_.create_lamps(*device_)
          .and_then([&] {
            return warm_up_later(
                kLampWarmUpSteps, [&](FrameSlot& slot, Targets& small, VkDescriptorSet, int step) {
                  record_warm_up(*device_, pipelines_, slot, small, shared_.buffer(), step, true);
                });
          })
          .and_then(
              [&] { return pipelines_.has_objects() ? warm_up_objects(true) : Result<void>{}; }));
}

Result<void> RendererImpl::prepare_particles() {
  if (lost_) return core::fail(core::ErrorCode::kDeviceLost, "the device was lost before");
  if (pipelines_.has_particles()) return {};
  return noted(pipelines_.create_particles(*device_).and_then([&] {
    return warm_up_later(kParticleWarmUpSteps, [&](FrameSlot& slot, Targets& small,
                                                   VkDescriptorSet textures, int step) {
      record_particle_warm_up(*device_, pipelines_, slot, small, textures, step);
    });
  }));
}

Result<void> RendererImpl::warm_up_objects(bool lamps) {
  return warm_up_later(kObjectWarmUpSteps,
                       [&](FrameSlot& slot, Targets& small, VkDescriptorSet textures, int step) {
                         record_object_warm_up(*device_, pipelines_, slot, small, shared_.buffer(),
                                               textures, step, lamps);
                       });
}

// Draws with pipelines that were made after the first frames. An even number of submissions: the
// last picture stays that of the slot of the last frame.
Result<void> RendererImpl::warm_up_later(int steps, const RecordStep& record) {
  static_assert(kObjectWarmUpSteps % kFramesInFlight == 0);
  static_assert(kLampWarmUpSteps % kFramesInFlight == 0);
  static_assert(kParticleWarmUpSteps % kFramesInFlight == 0);
  Result<Targets> small = make_small_targets();
  if (!small) return tl::unexpected(small.error());
  const Result<VkDescriptorSet> textures = materials_.blank_set(*device_);
  if (!textures) return tl::unexpected(textures.error());
  const std::vector<shaders::EmitterData> emitters(1);
  Result<void> drawn;
  for (int step = 0; drawn && step < steps; ++step) {
    FrameSlot& slot = slot_of(frame_value_ + 1);
    drawn = slot.write(*device_, pipelines_.bindings(), frame_data({}, small->extent),
                       std::vector<shaders::DrawData>(1), {}, emitters)
                .and_then([&] { return slot.begin(*device_); })
                .and_then([&] {
                  record(slot, *small, *textures, step);
                  return slot.end(*device_);
                })
                .and_then([&] { return submit(slot, false); })
                .and_then([&] { return wait_for(slot); });
  }
  use_targets();
  idle_value_ = warm_up_value_ = frame_value_;
  return drawn;
}

// Draws an empty frame with every dispatch.
Result<void> RendererImpl::warm_up_culling(FrameSlot& slot, Targets& small) {
  return culling_->resize(*device_, small.extent, small.depth)
      .and_then([&] {
        culling_->set_frame({}, {}, {}, small.extent, {});
        return write_frame(slot);
      })
      .and_then([&] { return slot.begin(*device_); })
      .and_then([&] {
        record_scene(*device_, pipelines_, slot, small,
                     {.list = list_, .buffers = {}, .culled = {culling_.get(), index_of(slot)}});
        return slot.end(*device_);
      })
      .and_then([&] { return submit(slot, false); })
      .and_then([&] { return wait_for(slot); })
      .and_then([&]() -> Result<void> {
        if (targets_.empty()) return {};
        return culling_->resize(*device_, size(), targets_[0].depth);
      });
}

Result<void> RendererImpl::show(std::span<const TextPanel> panels, float text_scale,
                                const HudDrawing& hud) {
  if (lost_) return core::fail(core::ErrorCode::kDeviceLost, "the device was lost before");
  const bool windowed = options_.surface != nullptr;
  if (const Result<bool> ok = noted(settle_present()); !ok) return tl::unexpected(ok.error());
  if (windowed) {
    const Result<bool> shown = noted(prepare_window());
    if (!shown) return tl::unexpected(shown.error());
    if (!*shown) return {};
  }
  if (targets_.empty()) {
    return core::fail(core::ErrorCode::kOutOfMemory,
                      "there was no memory for a picture of this size");
  }
  FrameSlot& slot = slot_of(frame_value_ + 1);
  if (Result<void> waited = noted(wait_for(slot)); !waited) return waited;
  FrameInput only_text;
  only_text.hud = &hud;
  only_text.panels = panels;
  only_text.text_scale = text_scale;
  lay_out_overlay(only_text);
  overlay_.put_ground_under(size(), glyphs_);
  has_list_ = false;
  if (windowed) {
    const Result<WindowState> acquired = noted(acquire_window(slot));
    if (!acquired) return tl::unexpected(acquired.error());
    if (*acquired == WindowState::kNotNow) return {};
  }
  const Result<void> drawn =
      noted(slot.write(*device_, pipelines_.bindings(), frame_data({}, size()), {}, glyphs_)
                .and_then([&] { return slot.begin(*device_); })
                .and_then([&] {
                  targets_of(slot).drawn = size();
                  record_text(*device_, pipelines_, slot, targets_of(slot),
                              static_cast<std::uint32_t>(glyphs_.size()));
                  if (windowed) {
                    record_copy_to_window(*device_, slot.commands(), targets_of(slot),
                                          swapchain_.image(), swapchain_.extent());
                  }
                  return slot.end(*device_);
                })
                .and_then([&] { return submit(slot, windowed); }));
  if (!drawn) return drawn;
  has_picture_ = true;
  if (windowed) {
    if (const Result<bool> presented = noted(present()); !presented)
      return tl::unexpected(presented.error());
  }
  const Result<void> waited = noted(wait_for(slot));
  idle_value_ = warm_up_value_ = frame_value_;
  return waited;
}

}  // namespace psygen::render
