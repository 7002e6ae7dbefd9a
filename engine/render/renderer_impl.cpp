#include "engine/render/renderer_impl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/core/headroom.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/render/emitter_data.hpp"
#include "engine/render/frame_data.hpp"
#include "engine/render/software_tuning.hpp"

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

bool is_empty(core::Extent extent) {
  return extent.width == 0 || extent.height == 0;
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

// Memory that a software driver allocates from here to the first frame, besides pictures. Without
// it, the driver ends the program in many ways, so it is checked first. Address space includes that
// of the driver's libraries.
constexpr std::uint64_t kStartBytes = std::uint64_t{96} << 20;
constexpr std::uint64_t kStartAddressBytes = std::uint64_t{512} << 20;
// Memory that geometry leaves free for everything else: the scene, the modelers, pictures of
// models, what a software driver compiles, and its bins, which grow with the picture (measured: 80
// MiB at 1280 x 720, 190 MiB at 3840 x 2160).
std::uint64_t headroom_bytes(core::Extent size) {
  const std::uint64_t bins = std::uint64_t{size.width} * size.height * 80;
  return (std::uint64_t{64} << 20) + std::min(bins, std::uint64_t{192} << 20);
}

// On lavapipe a pushed draw costs about 800 ns more than a draw of a multi-draw. A multi-draw costs
// about 20 ns per triangle more (psygen_bench_render). They are equal at about 40 triangles.
constexpr std::uint32_t kWorthPushingIndices = 48 * 3;

std::uint32_t first_pushed_index_count(Submission wish, const Device& device) {
  if (wish == Submission::kPushed || device.max_multi_draw == 0) return 0;
  const bool by_size = wish == Submission::kAuto && device.info.software;
  return by_size ? kWorthPushingIndices : UINT32_MAX;
}

}  // namespace

RendererImpl::RendererImpl(const RendererOptions& options) : options_(options) {}

RendererImpl::~RendererImpl() {
  if (device_) wait_idle();
}

bool RendererImpl::hangs() const {
  return device_ && device_->vk.hangs;
}

Result<void> RendererImpl::create_device() {
  Result<std::unique_ptr<Instance>> instance =
      Instance::create(options_.application_name, options_.validation, options_.surface);
  if (!instance) return tl::unexpected(instance.error());
  instance_ = std::move(*instance);
  if (options_.surface != nullptr) {
    Result<UniqueSurface> surface = make_surface(*instance_, *options_.surface);
    if (!surface) return tl::unexpected(surface.error());
    surface_ = std::move(*surface);
  }
  Result<DeviceCandidate> chosen =
      choose_device(find_devices(*instance_, surface_.get()), options_.device_name);
  if (!chosen) return tl::unexpected(chosen.error());
  Result<std::unique_ptr<Device>> device = Device::create(
      *chosen, options_.surface != nullptr, options_.timestamps, options_.device_timeout_seconds);
  if (!device) return tl::unexpected(device.error());
  device_ = std::move(*device);
  if (options_.surface != nullptr) {
    const Result<VkFormat> format = colour_format_for(*device_, surface_);
    if (!format) return tl::unexpected(format.error());
    colour_format_ = *format;
  }
  pushed_from_ = first_pushed_index_count(options_.submission, *device_);
  scales_up_ = can_scale_up(*device_, colour_format_);
  return {};
}

Result<void> RendererImpl::create(const Progress& progress) {
  const std::uint64_t largest = std::uint64_t{1} << 40;
  if (options_.surface == nullptr && is_empty(options_.size)) {
    return core::fail(ErrorCode::kInvalidArgument, "a picture needs at least one pixel");
  }
  if (options_.geometry_budget_bytes == 0 || options_.geometry_budget_bytes > largest) {
    return core::fail(ErrorCode::kInvalidArgument,
                      "the geometry budget must be between 1 byte and 1 TiB");
  }
  if (!core::memory_left(kStartBytes) || !core::addresses_left(kStartAddressBytes)) {
    return core::fail(ErrorCode::kOutOfMemory, core::out_of_memory("starting the renderer"));
  }
  if (Result<void> made = create_device(); !made) return made;
  if (Result<void> made = create_geometry(); !made) return made;
  Result<UniqueSemaphore> timeline = make_timeline(*device_);
  if (!timeline) return tl::unexpected(timeline.error());
  timeline_ = std::move(*timeline);
  if (Result<void> made = shared_.create(*device_); !made) return made;
  if (Result<void> made = materials_.create(*device_, options_.texture_budget_bytes); !made)
    return made;
  if (Result<void> made = pictures_.create(*device_, {}); !made) return made;
  for (FrameSlot& slot : slots_) {
    if (Result<void> made = slot.create(*device_); !made) return made;
  }
  const Preset preset =
      options_.preset.value_or(device_->info.software ? Preset::kLow : Preset::kHigh);
  if (Result<void> made = create_looks(preset, progress); !made) return made;
  idle_value_ = warm_up_value_ = frame_value_;
  if (options_.surface == nullptr) resized_ = false;
  return pool_->make_first_block();
}

Result<void> RendererImpl::create_geometry() {
  pool_ =
      std::make_unique<GeometryPool>(options_.geometry_budget_bytes,
                                     [this](std::uint64_t bytes) { return add_pool_block(bytes); });
  // A heap below twice the budget is taken for the small mapped window of a device.
  const bool writable =
      device_->info.software || device_->writable_bytes() / 2 >= options_.geometry_budget_bytes;
  if (options_.upload == Upload::kStaged || (options_.upload == Upload::kAuto && !writable)) {
    staged_ = std::make_unique<StagedGeometry>(*pool_);
    return staged_->create(*device_);
  }
  return {};
}

Result<void> RendererImpl::create_culling() {
  const DeviceInfo& info = device_->info;
  if (options_.path == RenderPath::kGpu && !info.gpu_path) {
    return core::fail(
        ErrorCode::kNoDevice,
        fmt::format("'{}' has no indirect draws with a count, which the GPU path needs",
                    info.name));
  }
  const bool suits = info.gpu_path && !info.software;
  if (options_.path == RenderPath::kCpu || (options_.path == RenderPath::kAuto && !suits))
    return {};
  culling_ = std::make_unique<GpuCulling>();
  const VkSampleCountFlagBits samples = pipelines_.samples();
  const bool readable = (device_->sampled_depth_counts & samples) != 0;
  return culling_->create(*device_, options_.occlusion && readable, samples, kFramesInFlight);
}

Result<std::byte*> RendererImpl::add_pool_block(std::uint64_t bytes) {
  // Does not exhaust memory that belongs to the whole process.
  if ((staged_ || device_->info.software) &&
      !core::memory_left(bytes + headroom_bytes(options_.size))) {
    return core::fail(ErrorCode::kOutOfMemory,
                      core::out_of_memory(fmt::format(
                          "{} MiB of geometry and what it takes to draw it", bytes >> 20)));
  }
  const VkBufferUsageFlags copied = staged_ ? VK_BUFFER_USAGE_TRANSFER_DST_BIT : 0;
  Result<Buffer> block =
      make_buffer(*device_, bytes,
                  VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT | copied,
                  staged_ ? MemoryUse::kDevice : MemoryUse::kWrite);
  if (!block) return core::fail(ErrorCode::kOutOfMemory, block.error().message);
  Result<std::byte*> written = block->mapped;
  if (staged_) written = staged_->add_block(bytes);
  if (!written) return written;
  pool_blocks_.push_back(std::move(*block));
  prefer_huge_pages({*written, bytes});
  return written;
}

Result<void> RendererImpl::create_targets(core::Extent extent) {
  const std::uint32_t side = device_->max_image_side;
  if (is_empty(extent) || extent.width > side || extent.height > side) {
    return core::fail(ErrorCode::kInvalidArgument,
                      fmt::format("a picture has 1 to {} pixels a side on this device, not {} x {}",
                                  side, extent.width, extent.height));
  }
  wait_idle();
  resized_ = true;
  targets_.clear();
  has_picture_ = false;
  std::vector<Targets> targets;
  for (std::size_t i = 0; i < (culling_ ? 1 : kFramesInFlight); ++i) {
    Result<Targets> made = make_targets(*device_, colour_format_, extent, pipelines_.samples());
    if (!made) return tl::unexpected(made.error());
    made->host_ordered = !culling_;
    targets.push_back(std::move(*made));
  }
  if (culling_) {
    const Result<void> fits = culling_->resize(*device_, extent, targets[0].depth);
    if (!fits) return fits;
  }
  targets_ = std::move(targets);
  return {};
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
  const VkResult result = device_->vk.vkQueueSubmit2(device_->queue, 1, &info, VK_NULL_HANDLE);
  if (result != VK_SUCCESS) return vulkan_failure(result, "submitting a frame");
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
  if (pictures.size() > core::kMostPictures ||
      materials_.texture_bytes() + pictures.size() * core::picture_bytes() >
          options_.texture_budget_bytes) {
    return core::fail(
        ErrorCode::kOverBudget,
        fmt::format("{} pictures of models do not fit: at most {}, and {} bytes of all "
                    "textures",
                    pictures.size(), core::kMostPictures, options_.texture_budget_bytes));
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
  return noted(draw_frame(input, slot_of(frame_value_ + 1)));
}

// Makes the list of draws: all draws, or candidates for the device.
void RendererImpl::list_draws(const FrameInput& input) {
  const bool coloured = colours_draws(input.view);
  std::uint32_t pushed_from = pushed_from_;
  const std::size_t lamps = std::min(input.point_lights.size(), kMostPointLights);
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
  for (std::size_t i = last - std::min<std::size_t>(last, kMostEmitters); i < last; ++i) {
    const ParticleDraw& draw = input.particles[i];
    const MaterialId material = draw.kind.material;
    const bool textured = kind_of(materials_.kinds(), material).textured;
    emitters_.push_back(data_of(draw));
    emitter_runs_.push_back(
        {std::min(draw.count, kMostParticlesPerEmitter), textured ? material : kPlainMaterial});
  }
}

Result<void> RendererImpl::write_frame(FrameSlot& slot) {
  Result<void> written = slot.write(*device_, pipelines_, frame_, list_.data(), glyphs_, emitters_);
  if (written) slot.write_shade(shade_.words());
  if (!written || !culling_) return written;
  written = culling_->write(*device_, index_of(slot));
  if (written) slot.read_draws_from(*device_, pipelines_, culling_->draw_data(index_of(slot)));
  return written;
}

// How the frame that begins differs from others, as far as it is known before drawing.
Apart RendererImpl::apart_now() {
  if (std::exchange(resized_, false)) return Apart::kResized;
  return frame_value_ - idle_value_ < kFramesInFlight ? Apart::kAfterIdle : Apart::kNo;
}

// Makes the images that fewer pixels need, when they are needed first.
core::Extent RendererImpl::landscape_size(float resolution) {
  const core::Extent whole = size();
  if (!(resolution < 1) || !scales_up_) return whole;
  for (Targets& targets : targets_) {
    if (targets.coarse.image.get() != VK_NULL_HANDLE) continue;
    scales_up_ = add_coarse(*device_, colour_format_, targets).has_value();
    if (!scales_up_) return whole;
  }
  const auto side = [share = std::max(resolution, kLeastResolution)](std::uint32_t pixels) {
    return std::max(1U,
                    static_cast<std::uint32_t>(std::lround(share * static_cast<float>(pixels))));
  };
  return {side(whole.width), side(whole.height)};
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
  frame_.shade = {shade_.corner(), 0.0F, 0.0F};
  drawn_ = landscape_size(input.resolution);
  frame_.morph.z = static_cast<float>(drawn_.height);
  out.resolution = static_cast<float>(drawn_.height) / static_cast<float>(size().height);
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
  if (lost_ || device_->vk.vkDeviceWaitIdle(device_->handle) != VK_SUCCESS) return;
  idle_value_ = frame_value_;
  if (pool_) pool_->frames_finished(frame_value_);
}

}  // namespace psygen::render
