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
#include "engine/render/passes/particles.hpp"

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

VkSemaphoreSubmitInfo semaphore_info(VkSemaphore semaphore, std::uint64_t value,
                                     VkPipelineStageFlags2 stage) {
  VkSemaphoreSubmitInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
  info.semaphore = semaphore;
  info.value = value;
  info.stageMask = stage;
  return info;
}

}  // namespace

RendererImpl::RendererImpl(const RendererOptions& options) : options_(options) {}

RendererImpl::~RendererImpl() {
  if (device_) wait_idle();
}

bool RendererImpl::hangs() const {
  return device_ && device_->vk.hangs;
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
  VkCommandBufferSubmitInfo commands{};
  commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
  commands.commandBuffer = slot.commands();
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
  VkSubmitInfo2 info{};
  info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
  info.waitSemaphoreInfoCount = static_cast<std::uint32_t>(waits.size());
  info.pWaitSemaphoreInfos = waits.data();
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &commands;
  info.signalSemaphoreInfoCount = static_cast<std::uint32_t>(signals.size());
  info.pSignalSemaphoreInfos = signals.data();
  const double now_s = core::monotonic_seconds();
  if (auto ok = device_->submit(device_->queue, info, "submitting a frame"); !ok) return ok;
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
  const ScenePass pass{.list = list_,
                       .materials = &materials_,
                       .buffers = {pool_blocks_, shared_.buffer()},
                       .culled = {culling_.get(), index_of(slot)},
                       .glyph_vertex_count = text_vertices_,
                       .line_vertex_count = line_vertices_,
                       .gui = gui_runs_,
                       .view = view_,
                       .water = water_,
                       .lamps = frame_.lamp_count.x > 0,
                       .emitters = emitter_runs_,
                       .shadows = frame_.shadow.y > 0};
  Targets& targets = targets_of(slot);
  targets.drawn = drawn_;
  // Frames without a barrier need no parts: their pixels are filled beside the triangles of the
  // next.
  targets.in_parts = targets.keeps_order && (options_.surface != nullptr || targets.is_coarse());
  targets.mirrors = water_ && targets.mirror.exists();
  record_scene(*device_, pipelines_, slot, targets, pass);
  if (windowed) {
    record_copy_to_window(*device_, slot.commands(), targets, swapchain_.image(),
                          swapchain_.extent());
  }
  return slot.end(*device_);
}

// Makes what only few programs need and this frame is the first to have.
Result<void> RendererImpl::prepare(const FrameInput& input) {
  if (!input.objects.empty()) {
    if (Result<void> made = prepare_objects(); !made) return made;
  }
  if (!input.point_lights.empty()) {
    if (Result<void> made = prepare_lights(); !made) return made;
  }
  return input.particles.empty() ? Result<void>{} : prepare_particles();
}

Result<void> RendererImpl::set_pictures(std::span<const core::ModelPicture> pictures) {
  if (lost_) return core::fail(ErrorCode::kDeviceLost, "the device was lost before");
  if (pictures.size() > core::kMaxPictures ||
      materials_.texture_bytes() + pictures.size() * core::picture_bytes() >
          options_.texture_budget_bytes) {
    return core::fail(
        ErrorCode::kOverBudget,
        fmt::format("{} pictures of models do not fit: at most {}, and {} bytes of all "
                    "textures",
                    pictures.size(), core::kMaxPictures, options_.texture_budget_bytes));
  }
  const auto whole = [](const core::ModelPicture& p) { return p.size() == core::picture_bytes(); };
  if (!std::ranges::all_of(pictures, whole))
    return core::fail(ErrorCode::kInvalidArgument, "a picture of a model is of another size");
  wait_idle();
  Result<void> made = noted(pictures_.create(*device_, pictures));
  if (!made) return made;
  materials_.set_budget(options_.texture_budget_bytes - pictures_.bytes());
  use_pipelines();
  return {};
}

Result<void> RendererImpl::set_picture(std::size_t number, const core::ModelPicture& picture) {
  if (lost_) return core::fail(ErrorCode::kDeviceLost, "the device was lost before");
  if (number >= pictures_.count() || picture.size() != core::picture_bytes())
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
  if (Result<void> made = prepare(input); !made) return tl::unexpected(made.error());
  Result<FrameResult> drawn = noted(draw_frame(input, slot_of(frame_value_ + 1)));
  if (drawn && presents) drawn->present = settled;
  return drawn;
}

// Makes the list of draws: all draws, or candidates for the device.
void RendererImpl::list_draws(const FrameInput& input) {
  const bool coloured = colours_draws(input.view);
  std::uint32_t pushed_from = pushed_from_;
  const std::size_t lamps = std::min(input.point_lights.size(), kMaxPointLights);
  if (culling_) {
    culling_->set_frame(view_volume(frame_.clip_from_camera), frame_, input, drawn_,
                        shared_.lists(), materials_.kinds());
    // Cascades are drawn from a list of the CPU, with pushed data.
    if (frame_.shadow.y <= 0) return list_.build({}, {}, {});
    pushed_from = 0;
  }
  list_.build(input.terrain, input.models, shared_.lists(), pushed_from, coloured, input.objects,
              materials_.kinds(), input.point_lights.first(lamps));
}

// Views for debugging show no particles.
void RendererImpl::list_particles(const FrameInput& input) {
  emitters_.clear();
  emitter_runs_.clear();
  if (colours_draws(input.view) || input.view == View::kWireframe) return;
  const std::size_t last = input.particles.size();
  for (std::size_t i = last - std::min<std::size_t>(last, kMaxEmitters); i < last; ++i) {
    const ParticleDraw& draw = input.particles[i];
    const MaterialId material = draw.kind.material;
    const bool textured = kind_of(materials_.kinds(), material).textured;
    emitters_.push_back(data_of(draw));
    emitter_runs_.push_back(
        {std::min(draw.count, kMaxParticlesPerEmitter), textured ? material : kPlainMaterial});
  }
}

Result<void> RendererImpl::write_frame(FrameSlot& slot) {
  Result<void> written =
      slot.write(*device_, pipelines_.bindings(), frame_, list_.data(), glyphs_, emitters_);
  if (written) slot.write_shade(shade_.words());
  if (!written || !culling_) return written;
  written = culling_->write(*device_, index_of(slot));
  if (written)
    slot.read_draws_from(*device_, pipelines_.bindings(), culling_->draw_data(index_of(slot)));
  return written;
}

// How the frame that begins differs from others, as far as it is known before drawing.
Apart RendererImpl::apart_now() {
  if (std::exchange(resized_, false)) return Apart::kResized;
  return frame_value_ - idle_value_ < kFramesInFlight ? Apart::kAfterIdle : Apart::kNo;
}

void RendererImpl::lay_out_overlay(const FrameInput& input) {
  glyphs_.clear();
  if (input.hud != nullptr) overlay_.lay_out(*input.hud, size(), glyphs_);
  overlay_.lay_out(input.panels, size(), input.text_scale, glyphs_);
  text_vertices_ = static_cast<std::uint32_t>(glyphs_.size());
  add_lines(input.lines);
  gui_runs_.clear();
  if (input.gui != nullptr) overlay_.lay_out(*input.gui, size(), glyphs_, gui_runs_);
}

void RendererImpl::add_lines(std::span<const Line> lines) {
  line_vertices_ = static_cast<std::uint32_t>(2 * std::min(lines.size(), kMaxLines));
  for (const Line& line : lines.first(line_vertices_ / 2)) {
    glyphs_.push_back({{line.from, 1.0F}, {line.colour, 1.0F}, {}});
    glyphs_.push_back({{line.to, 1.0F}, {line.colour, 1.0F}, {}});
  }
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
  lay_out_overlay(input);
  view_ = input.view;
  water_ = input.water.has_value();
  frame_ = frame_data(input, size(), pipelines_.traits());
  const glm::dvec3& at = input.pose.position.local;
  shade_.build(input.spots, {at.x, at.z});
  drawn_ = landscape_size(input.resolution);
  frame_.shade = {shade_.corner(), static_cast<float>(drawn_.width),
                  static_cast<float>(drawn_.height)};
  out.resolution = static_cast<double>(drawn_.height) / size().height;
  const GpuCulling::Counts counted =
      culling_ && has_list_ ? culling_->read_counts(index_of(slot)) : GpuCulling::Counts{};
  list_draws(input);
  list_particles(input);
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
  has_picture_ = has_list_ = true;
  out.presented = true;
  if (windowed) {
    const Wait present{core::monotonic_seconds(), 0};
    const Result<bool> presented = this->present();
    if (!presented) return tl::unexpected(presented.error());
    out.present = ended(present);
    out.presented = *presented;
  }
  out.draws = culling_ ? counted.draws : static_cast<std::uint32_t>(list_.draws().size());
  out.triangles = culling_ ? counted.triangles : list_.triangle_count();
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
