// Creates the renderer's objects that outlive a preset: the device, memory for geometry, culling,
// and the images of a picture. Those of a preset are in renderer_preset.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/core/headroom.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/render/device/device_choice.hpp"
#include "engine/render/device/software_tuning.hpp"
#include "engine/render/renderer_impl.hpp"

namespace psygen::render {

using core::ErrorCode;
using core::Result;

namespace {

bool is_empty(core::Extent extent) {
  return extent.width == 0 || extent.height == 0;
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
  const bool by_size = wish == Submission::kAuto && device.info.software();
  return by_size ? kWorthPushingIndices : UINT32_MAX;
}

}  // namespace

Result<void> RendererImpl::create_device() {
  const bool windowed = options_.surface != nullptr;
  return Instance::create(options_.application_name, options_.validation, options_.surface)
      .map(into(instance_))
      .and_then([&]() -> Result<void> {
        if (!windowed) return {};
        return make_surface(*instance_, *options_.surface).map(into(surface_));
      })
      .and_then([&] {
        const std::vector<DeviceCandidate> found = find_devices(*instance_, surface_.get());
        return choose_device(infos_of(found), options_.device_name).map([&](std::size_t i) {
          return found[i];
        });
      })
      .and_then([&](const DeviceCandidate& chosen) {
        return Device::create(chosen, {.windowed = windowed,
                                       .timestamps = options_.timestamps,
                                       .pass_times = options_.pass_times,
                                       .timeout_seconds = options_.device_timeout_seconds});
      })
      .map(into(device_))
      .and_then([&]() -> Result<void> {
        if (!windowed) return {};
        return colour_format_for(*device_, surface_).map(into(colour_format_));
      })
      .map([&] {
        pushed_from_ = first_pushed_index_count(options_.submission, *device_);
        scales_up_ = can_scale_up(*device_, colour_format_);
      });
}

Result<void> RendererImpl::create_all(const Progress& progress) {
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
  Result<void> made =
      create_device()
          .and_then([&] { return create_geometry(); })
          .and_then([&] { return make_timeline(*device_); })
          .map(into(timeline_))
          .and_then([&] { return shared_.create(*device_); })
          .and_then([&] { return materials_.create(*device_, options_.texture_budget_bytes); })
          .and_then([&] { return pictures_.create(*device_, {}); });
  for (std::size_t i = 0; made && i < slots_.size(); ++i)
    made = slots_[i].create(*device_, i);
  if (!made) return made;
  const Preset preset = options_.preset.value_or(default_preset(device_->info));
  if (made = create_looks(preset, progress); !made) return made;
  idle_value_ = warm_up_value_ = frame_value_;
  if (options_.surface == nullptr) resized_ = false;
  return pool_->make_first_block();
}

Result<void> RendererImpl::create_geometry() {
  const auto add_block = [this](std::uint64_t bytes) { return add_pool_block(bytes); };
  const std::uint64_t budget = options_.geometry_budget_bytes;
  // A heap below twice the budget is taken for the small mapped window of a device.
  const bool writable = device_->info.software() || device_->writable_bytes() / 2 >= budget;
  if (options_.upload == Upload::kDirect || (options_.upload == Upload::kAuto && writable)) {
    pool_ = std::make_unique<GeometryPool>(budget, add_block);
    return {};
  }
  auto staged = std::make_unique<StagedGeometry>(budget, add_block);
  staged_ = staged.get();
  pool_ = std::move(staged);
  return staged_->create(*device_);
}

Result<void> RendererImpl::create_culling() {
  const DeviceInfo& info = device_->info;
  if (options_.path == RenderPath::kGpu && !info.gpu_path) {
    return core::fail(
        ErrorCode::kNoDevice,
        fmt::format("'{}' lacks indirect draws with a count and a number, which the GPU path needs",
                    info.name));
  }
  const RenderPath path = options_.path == RenderPath::kAuto ? default_path(info) : options_.path;
  if (path == RenderPath::kCpu) return {};
  culling_ = std::make_unique<GpuCulling>();
  const VkSampleCountFlagBits samples = looks_.samples;
  const bool readable = (device_->sampled_depth_counts & samples) != 0;
  return culling_->create(*device_, options_.occlusion && readable, samples, kFramesInFlight);
}

Result<std::byte*> RendererImpl::add_pool_block(std::uint64_t bytes) {
  // Does not exhaust memory that belongs to the whole process.
  if ((staged_ || device_->info.software()) &&
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
  const std::uint32_t side = device_->info.max_image_side;
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
    Result<Targets> made =
        make_targets(*device_, colour_format_, extent, looks_.samples, looks_.reflections);
    if (!made) return tl::unexpected(made.error());
    made->host_ordered = !culling_;
    made->keeps_order = !culling_ && device_->info.software() && !made->has_samples();
    targets.push_back(std::move(*made));
  }
  if (culling_) {
    const Result<void> fits = culling_->resize(*device_, extent, targets[0].depth);
    if (!fits) return fits;
  }
  targets_ = std::move(targets);
  use_targets();
  return {};
}

// Makes the images that fewer pixels need, when they are needed first.
core::Extent RendererImpl::landscape_size(float resolution) {
  const core::Extent whole = size();
  if (!(resolution < 1) || !scales_up_) return whole;
  if (!targets_.back().low_resolution.image.exists()) {
    wait_idle();
    for (Targets& targets : targets_)
      scales_up_ = scales_up_ && add_low_resolution(*device_, colour_format_, targets).has_value();
    use_targets();
    if (!scales_up_) return whole;
  }
  const auto side = [share = std::max(resolution, kMinResolution)](std::uint32_t pixels) {
    return std::max(1U,
                    static_cast<std::uint32_t>(std::lround(share * static_cast<float>(pixels))));
  };
  return {side(whole.width), side(whole.height)};
}

Result<std::unique_ptr<Renderer>> Renderer::create(const RendererOptions& options) {
  auto renderer = std::make_unique<RendererImpl>(options);
  Progress progress;
  if (options.progress)
    progress = [&](double fraction) { return options.progress(*renderer, fraction); };
  return renderer->create_all(progress).map(
      [&]() -> std::unique_ptr<Renderer> { return std::move(renderer); });
}

Result<std::vector<DeviceInfo>> list_devices() {
  Result<std::unique_ptr<Instance>> instance = Instance::create("psygen", false, nullptr);
  if (!instance) return tl::unexpected(instance.error());
  return infos_of(find_devices(**instance, VK_NULL_HANDLE));
}

}  // namespace psygen::render
