#include "engine/render/renderer_impl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/core/headroom.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/render/device/software_tuning.hpp"
#include "engine/render/frame/frame_data.hpp"

namespace psygen::render {

using core::ErrorCode;
using core::Result;

namespace {

double ms_since(double start_seconds) {
  return (core::monotonic_seconds() - start_seconds) * 1e3;
}

Wait ended(const Wait& wait) {
  return {wait.start_s, ms_since(wait.start_s)};
}

// Fails for a camera that cannot be drawn. Its owner keeps the last valid one.
Result<void> check_camera(const FrameInput& input) {
  const core::Projection& p = input.projection;
  const auto is_length = [](float value) { return value > 1e-6F && value < 1e6F; };
  const bool drawable = p.vertical_fov > 0.001F && p.vertical_fov < 3.13F && is_length(p.aspect) &&
                        is_length(p.near_m);
  if (drawable && core::is_valid(input.pose)) return {};
  return core::fail(ErrorCode::kInvalidArgument,
                    drawable ? "the pose of a frame is not finite, or is beyond all worlds"
                             : "the projection of a frame is not one that can be drawn");
}

}  // namespace

RendererImpl::RendererImpl(const RendererOptions& options) : options_(options) {}

RendererImpl::~RendererImpl() {
  if (!device_) return;
  if (!device_->vk.hangs) {
    wait_idle();
    return;
  }
  // Handles of the device leave it what it may still use (DeviceHandle).
  (void)new auto(std::move(presenting_));
  (void)new auto(std::move(surface_));
  (void)device_.release();
  (void)instance_.release();
}

Result<void> RendererImpl::wait_for(FrameSlot& slot) {
  const VkSemaphore timeline = timeline_.get();
  if (auto ok = device_->wait(timeline, slot.submitted_value, "waiting for a frame"); !ok)
    return ok;
  // Reports only the frame that was waited for, although the device may be further. The set of free
  // ranges must not depend on the device's speed.
  pool_->frames_finished(slot.submitted_value);
  return {};
}

Result<void> RendererImpl::submit(FrameSlot& slot, bool windowed) {
  std::vector<VkSemaphoreSubmitInfo> waits;
  if (windowed) {
    waits.push_back(semaphore_info(slot.acquired(), 0, VK_PIPELINE_STAGE_2_COPY_BIT));
  }
  if (staged_) {
    waits.push_back(semaphore_info(staged_->timeline(), staged_->value(),
                                   VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT));
  }
  std::vector<VkSemaphoreSubmitInfo> signals{
      semaphore_info(timeline_.get(), frame_value_ + 1, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT)};
  if (windowed) {
    signals.push_back(
        semaphore_info(swapchain_.finished(), 0, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT));
  }
  const double now_s = core::monotonic_seconds();
  if (auto ok =
          device_->submit(device_->queue, slot.commands(), waits, signals, "submitting a frame");
      !ok)
    return ok;
  slot.submitted_value = ++frame_value_;
  slot.timer().submitted(frame_value_, now_s);
  pool_->frame_submitted(frame_value_);
  return {};
}

Result<void> RendererImpl::record(FrameSlot& slot, bool windowed) {
  if (Result<void> begun = slot.begin(*device_); !begun) return begun;
  if (staged_) {
    const Result<void> copied = staged_->flush(*device_, pool_blocks_, slot.commands());
    if (!copied) return copied;
  }
  Targets& targets = targets_of(slot);
  targets.drawn = drawn_;
  // Frames without a barrier need no parts: their pixels are filled beside the triangles of the
  // next.
  targets.in_parts =
      targets.keeps_order && (options_.surface != nullptr || targets.is_low_resolution());
  targets.reflects = std::get<Water>(looks_.passes).visible() && targets.reflection.exists();
  Recording to = recording(slot, targets);
  to.culling = culling_.get();
  to.view = view_;
  to.lamps = frame_.lamp_count.x > 0;
  record_frame(looks_.passes, to);
  if (windowed) {
    record_copy_to_window(*device_, slot.commands(), targets, swapchain_.image(),
                          swapchain_.extent());
  }
  return slot.end(*device_);
}

// Makes the features that this frame is the first to have.
Result<void> RendererImpl::prepare_for(const FrameInput& input) {
  Result<void> made;
  if (!input.objects.empty()) made = prepare(Feature::kObjects);
  if (made && !input.point_lights.empty()) made = prepare(Feature::kPointLights);
  if (!made) return made;
  return try_each_pass(looks_.passes, [&]<class P>(const P&) -> Result<void> {
    if constexpr (NeedsFeature<P>)
      if (P::needs_feature(input)) return prepare(P::kFeature);
    return {};
  });
}

Result<void> RendererImpl::set_model_pictures(std::span<const core::ImpostorTexture> pictures) {
  if (lost_) return core::fail(ErrorCode::kDeviceLost, "the device was lost before");
  if (pictures.size() > core::kMaxImpostors ||
      materials_.texture_bytes() + pictures.size() * core::impostor_bytes() >
          options_.texture_budget_bytes) {
    return core::fail(
        ErrorCode::kOverBudget,
        fmt::format("{} pictures of models do not fit: at most {}, and {} bytes of all "
                    "textures",
                    pictures.size(), core::kMaxImpostors, options_.texture_budget_bytes));
  }
  const auto whole = [](const core::ImpostorTexture& p) {
    return p.size() == core::impostor_bytes();
  };
  if (!std::ranges::all_of(pictures, whole))
    return core::fail(ErrorCode::kInvalidArgument, "a picture of a model is of another size");
  wait_idle();
  Result<void> made = noted(pictures_.create(*device_, pictures));
  if (!made) return made;
  materials_.set_budget(options_.texture_budget_bytes - pictures_.bytes());
  use_sets();
  return {};
}

Result<void> RendererImpl::set_model_picture(std::size_t number,
                                             const core::ImpostorTexture& picture) {
  if (lost_) return core::fail(ErrorCode::kDeviceLost, "the device was lost before");
  if (number >= pictures_.count() || picture.size() != core::impostor_bytes())
    return core::fail(ErrorCode::kInvalidArgument, "a picture of a model that does not exist");
  wait_idle();
  return noted(pictures_.set(*device_, number, picture));
}

Result<FrameResult> RendererImpl::render(const FrameInput& input) {
  if (lost_) return core::fail(ErrorCode::kDeviceLost, "the device was lost before");
  if (const Result<void> ok = check_camera(input); !ok) return tl::unexpected(ok.error());
  const bool presents = presenting_.valid();
  const Wait present{core::monotonic_seconds(), 0};
  if (const Result<bool> ok = noted(settle_present()); !ok) return tl::unexpected(ok.error());
  const Wait settled = ended(present);
  if (options_.surface != nullptr) {
    const Result<bool> shown = noted(prepare_window());
    if (!shown) return tl::unexpected(shown.error());
    if (!*shown) {
      FrameResult nothing;
      nothing.apart = Apart::kNotDrawn;
      return nothing;
    }
  }
  if (targets_.empty()) {
    return core::fail(ErrorCode::kOutOfMemory, "there was no memory for a picture of this size");
  }
  if (Result<void> made = prepare_for(input); !made) return tl::unexpected(made.error());
  Result<FrameResult> drawn = noted(draw_frame(input, slot_of(frame_value_ + 1)));
  if (drawn && presents) drawn->present = settled;
  return drawn;
}

// Makes the list of draws: all draws, or candidates for the device.
void RendererImpl::list_draws(const FrameInput& input) {
  const std::size_t lamps = std::min(input.point_lights.size(), kMaxPointLights);
  ListFacts facts{.shared = shared_.lists(),
                  .materials = materials_.kinds(),
                  .lights = input.point_lights.first(lamps),
                  .pushed_from = pushed_from_,
                  .coloured = colours_draws(input.view)};
  if (culling_) {
    culling_->set_frame(input, frame_, drawn_, facts);
    // Cascades are drawn from a list of the CPU, with pushed data.
    if (frame_.shadow.y <= 0) return list_.build({}, {}, {});
    facts.pushed_from = 0;
  }
  list_.build(facts, input.terrain, input.models, input.objects);
}

void RendererImpl::list_frame(const FrameInput& input) {
  const FrameFacts facts{frame_, materials_.kinds(), overlay_, size()};
  for_each_pass(looks_.passes, [&]<class P>(P& pass) {
    if constexpr (Lists<P>) pass.list(input, facts);
  });
}

Result<void> RendererImpl::write_frame(FrameSlot& slot) {
  const std::size_t number = slot.number();
  Result<void> written = slot.write(*device_, looks_.sets, frame_, list_.data()).and_then([&] {
    slot.write_shade(shade_.words());
    return try_each_pass(looks_.passes, [&]<class P>(P& pass) -> Result<void> {
      if constexpr (Writes<P>) return pass.write(*device_, number);
      return {};
    });
  });
  if (!written || !culling_) return written;
  return culling_->write(*device_, number).map([&] {
    looks_.sets.write_draws(*device_, number, culling_->draw_data(number));
  });
}

// The difference of the next frame from others, as far as it is known before drawing.
Apart RendererImpl::apart_now() {
  if (std::exchange(resized_, false)) return Apart::kResized;
  return frame_value_ - idle_value_ < kFramesInFlight ? Apart::kAfterIdle : Apart::kNo;
}

Result<FrameResult> RendererImpl::draw_frame(const FrameInput& input, FrameSlot& slot) {
  const bool windowed = options_.surface != nullptr;
  FrameResult out;
  out.apart = apart_now();
  const Wait device{core::monotonic_seconds(), 0};
  if (Result<void> waited = wait_for(slot); !waited) return tl::unexpected(waited.error());
  out.device = ended(device);
  if (const auto gpu = slot.timer().read(*device_); gpu && gpu->frame > warm_up_value_) gpu_ = gpu;

  const double build_start = core::monotonic_seconds();
  view_ = input.view;
  frame_ = frame_data(input, size(), looks_.traits);
  const glm::dvec3& at = input.pose.position.local;
  shade_.build(input.spots, {at.x, at.z});
  drawn_ = landscape_size(input.resolution);
  frame_.shade = {shade_.corner(), static_cast<float>(drawn_.width),
                  static_cast<float>(drawn_.height)};
  out.resolution = static_cast<double>(drawn_.height) / size().height;
  const GpuCulling::Counts counted =
      culling_ && has_list_ ? culling_->read_counts(slot.number()) : GpuCulling::Counts{};
  list_draws(input);
  list_frame(input);
  if (Result<void> written = write_frame(slot); !written) return tl::unexpected(written.error());
  out.cpu_ms = ms_since(build_start);

  if (windowed) {
    const Wait acquire{core::monotonic_seconds(), 0};
    const Result<WindowState> acquired = acquire_window(slot);
    if (!acquired) return tl::unexpected(acquired.error());
    out.acquire = ended(acquire);
    if (*acquired == WindowState::kNotNow) {
      out.apart = Apart::kNotDrawn;
      return out;
    }
  }
  const double record_start = core::monotonic_seconds();
  if (Result<void> recorded = record(slot, windowed); !recorded) {
    return tl::unexpected(recorded.error());
  }
  if (Result<void> submitted = submit(slot, windowed); !submitted) {
    return tl::unexpected(submitted.error());
  }
  out.cpu_ms += ms_since(record_start);
  out.frame = frame_value_;
  out.handed_over_s = core::monotonic_seconds();
  out.memory_bytes = device_->vk.memory_bytes;
  has_picture_ = has_list_ = true;
  out.presented = true;
  if (windowed) {
    const Wait present{core::monotonic_seconds(), 0};
    const Result<bool> presented = this->present();
    if (!presented) return tl::unexpected(presented.error());
    out.present = ended(present);
    out.presented = *presented;
    out.handed_over_s = out.presented ? present.start_s : 0;
  }
  const Water& water = std::get<Water>(looks_.passes);
  out.draws = water.surface_count() +
              (culling_ ? counted.draws : static_cast<std::uint32_t>(list_.draws().size()));
  out.triangles =
      water.surface_triangles() + (culling_ ? counted.triangles : list_.triangle_count());
  out.gpu = gpu_;
  return out;
}

Result<void> RendererImpl::resize(core::Extent size) {
  if (options_.surface != nullptr) {
    swapchain_stale_ = true;
    return {};
  }
  if (this->size() == size) return {};
  return noted(create_targets(size));
}

void RendererImpl::wait_idle() {
  if (presenting_.valid()) presenting_.wait();
  if (lost_ || device_->wait_idle() != VK_SUCCESS) return;
  idle_value_ = frame_value_;
  if (pool_) pool_->frames_finished(frame_value_);
}

}  // namespace psygen::render
