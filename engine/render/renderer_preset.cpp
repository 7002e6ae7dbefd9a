// The renderer's objects for one preset: pipelines, culling, targets. They are created at the start
// and again for another preset. Also the text picture that is shown meanwhile.
#include <algorithm>
#include <utility>

#include "engine/render/device/pipeline_build.hpp"
#include "engine/render/frame/frame_data.hpp"
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
  looks_.preset = preset;
  looks_.traits = traits_of(preset);
  looks_.samples = device_->samples_for(looks_.traits.samples);
  looks_.reflections = looks_.traits.waves && looks_.samples != VK_SAMPLE_COUNT_1_BIT;
  return looks_.sets
      .create(*device_, kFramesInFlight,
              {.traits = looks_.traits,
               .materials = materials_,
               .pictures = pictures_,
               .ground = options_.ground})
      .and_then([&] { return create_overlay(); })
      .and_then([&] {
        use_sets();
        return create_culling();
      })
      .and_then([&]() -> Result<void> {
        if (options_.surface == nullptr) return create_targets(options_.size);
        return swapchain_.exists() ? create_targets(swapchain_.extent()) : Result<void>{};
      })
      .and_then([&] { return go_on(progress, 0); })
      .and_then([&] {
        Features first;
        first.add(Feature::kLandscape);
        return create_passes(first, part_of(progress, 0, kPipelinesShare));
      })
      .and_then([&] { return warm_up(part_of(progress, kPipelinesShare, 1)); });
}

// Creates the pass of show(), which `progress` may call while all others are created.
Result<void> RendererImpl::create_overlay() {
  PipelineMaker pipelines(*device_, {colour_format_, looks_.samples});
  return std::get<Overlay>(looks_.passes).create(pass_setup(pipelines, {}));
}

PassSetup RendererImpl::pass_setup(PipelineMaker& pipelines, Features features) const {
  return {.device = *device_,
          .traits = looks_.traits,
          .sets = looks_.sets,
          .pipelines = pipelines,
          .overlay = overlay_,
          .reflections = looks_.reflections,
          .features = features};
}

// Creates what the vertex layouts and passes lack for these features.
Result<void> RendererImpl::create_passes(Features features, const Progress& progress) {
  PipelineMaker pipelines(*device_, {colour_format_, looks_.samples}, progress);
  const PassSetup setup = pass_setup(pipelines, features);
  return looks_.meshes.create(setup)
      .and_then([&] {
        return try_each_pass(looks_.passes, [&]<class P>(P& pass) -> Result<void> {
          if constexpr (Creates<P>) return pass.create(setup);
          return {};
        });
      })
      .map([&] { looks_.features = features; });
}

void RendererImpl::use_sets() {
  for (FrameSlot& slot : slots_)
    slot.use(*device_, looks_.sets);
  use_targets();
}

// Tells the passes the targets of all slots, after either has changed.
void RendererImpl::use_targets() {
  if (targets_.empty()) return;
  for (const FrameSlot& slot : slots_)
    use_targets(slot, targets_of(slot));
}

void RendererImpl::use_targets(const FrameSlot& slot, const Targets& targets) {
  for_each_pass(looks_.passes, [&]<class P>(P& pass) {
    if constexpr (UsesTargets<P>) pass.use(*device_, slot, targets);
  });
}

Result<void> RendererImpl::set_preset(Preset preset, const Progress& progress) {
  if (lost_) return core::fail(core::ErrorCode::kDeviceLost, "the device was lost before");
  if (preset == looks_.preset) return {};
  wait_idle();
  if (!targets_.empty()) options_.size = size();
  Looks other_looks;
  std::unique_ptr<GpuCulling> other_culling;
  std::vector<Targets> other_targets;
  const auto exchange = [&] {
    std::swap(other_looks, looks_);
    std::swap(other_culling, culling_);
    std::swap(other_targets, targets_);
  };
  exchange();  // keeps the old ones until the new ones exist
  Result<void> made = noted(create_looks(preset, progress));
  if (made) made = noted(create_passes(other_looks.features, {}));
  wait_idle();
  has_list_ = has_picture_ = false;
  gpu_.reset();
  idle_value_ = warm_up_value_ = frame_value_;
  if (!made) {
    exchange();
    use_sets();
    swapchain_stale_ = true;  // the window may have changed meanwhile
    return made;
  }
  return {};
}

// Targets for draws before the first frame, which are bound until use_targets().
Result<Targets> RendererImpl::make_small_targets() {
  wait_idle();
  Result<Targets> small =
      make_targets(*device_, colour_format_, {16, 16}, looks_.samples, looks_.reflections);
  if (!small) return small;
  if (scales_up_) {
    if (Result<void> added = add_low_resolution(*device_, colour_format_, *small); !added)
      return tl::unexpected(added.error());
  }
  for (const FrameSlot& slot : slots_)
    use_targets(slot, *small);
  return small;
}

Result<void> RendererImpl::draw_step(FrameSlot& slot, Targets& small, const WarmUpStep& step,
                                     VkDescriptorSet textures) {
  return slot
      .write(*device_, looks_.sets, frame_data({}, small.extent), std::vector<shaders::DrawData>(1))
      .and_then([&] { return slot.begin(*device_); })
      .and_then([&] {
        record_warm_up(looks_.passes, recording(slot, small), step, textures);
        return slot.end(*device_);
      })
      .and_then([&] { return submit(slot, false); })
      .and_then([&] { return wait_for(slot); });
}

Result<void> RendererImpl::warm_up(const Progress& progress) {
  Result<Targets> small = make_small_targets();
  if (!small) return tl::unexpected(small.error());
  const int steps = warm_up_steps(looks_.passes, Feature::kLandscape);
  for (int i = 0; i < steps; ++i) {
    const WarmUpStep step{.feature = Feature::kLandscape, .number = i};
    const Result<void> drawn = draw_step(slots_[0], *small, step, VK_NULL_HANDLE).and_then([&] {
      return go_on(progress, (i + 1.0) / steps);
    });
    if (!drawn) return drawn;
  }
  use_targets();
  return culling_ ? warm_up_culling(slots_[0], *small) : Result<void>{};
}

Result<void> RendererImpl::prepare(Feature feature) {
  if (lost_) return core::fail(core::ErrorCode::kDeviceLost, "the device was lost before");
  if (looks_.features.has(feature)) return {};
  Features features = looks_.features;
  features.add(feature);
  // Objects and point lights together have pipelines of their own.
  const bool both = features.has(Feature::kObjects) && features.has(Feature::kPointLights) &&
                    (feature == Feature::kObjects || feature == Feature::kPointLights);
  return noted(
      create_passes(features, {})
          .and_then([&] { return warm_up_later(feature, feature == Feature::kPointLights); })
          .and_then(
              [&] { return both ? warm_up_later(Feature::kObjects, true) : Result<void>{}; }));
}

// Draws with pipelines that were made after the first frames. An even number of submissions: the
// last picture stays that of the slot of the last frame.
Result<void> RendererImpl::warm_up_later(Feature feature, bool lamps) {
  static_assert(kFramesInFlight == 2);
  Result<Targets> small = make_small_targets();
  if (!small) return tl::unexpected(small.error());
  const Result<VkDescriptorSet> textures = materials_.blank_set(*device_);
  if (!textures) return tl::unexpected(textures.error());
  const int steps = warm_up_steps(looks_.passes, feature), submissions = steps + steps % 2;
  Result<void> drawn;
  for (int i = 0; drawn && i < submissions; ++i) {
    const WarmUpStep step{.feature = feature, .lamps = lamps, .number = std::min(i, steps - 1)};
    drawn = draw_step(slot_of(frame_value_ + 1), *small, step, *textures);
  }
  use_targets();
  idle_value_ = warm_up_value_ = frame_value_;
  return drawn;
}

// Draws an empty frame with every dispatch.
Result<void> RendererImpl::warm_up_culling(FrameSlot& slot, Targets& small) {
  return culling_->resize(*device_, small.extent, small.depth)
      .and_then([&] {
        drawn_ = small.extent;
        frame_ = frame_data({}, small.extent);
        list_draws({});
        list_frame({});  // not the text that show() drew last
        return write_frame(slot);
      })
      .and_then([&] { return slot.begin(*device_); })
      .and_then([&] {
        Recording to = recording(slot, small);
        to.culling = culling_.get();
        record_frame(looks_.passes, to);
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
  const shaders::FrameData frame = frame_data({}, size());
  const FrameFacts facts{frame, materials_.kinds(), overlay_, size()};
  Overlay& text = std::get<Overlay>(looks_.passes);
  text.list(only_text, facts);
  text.put_background(facts);
  has_list_ = false;
  if (windowed) {
    const Result<WindowState> acquired = noted(acquire_window(slot));
    if (!acquired) return tl::unexpected(acquired.error());
    if (*acquired == WindowState::kNotNow) return {};
  }
  const Result<void> drawn =
      noted(slot.write(*device_, looks_.sets, frame, {})
                .and_then([&] { return text.write(*device_, slot.number()); })
                .and_then([&] { return slot.begin(*device_); })
                .and_then([&] {
                  targets_of(slot).drawn = size();
                  record_text(looks_.passes, recording(slot, targets_of(slot)));
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
