// Reads back from frames: pictures, the meshes drawn, and the time of drawing them again. All
// functions wait for the device.
#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "engine/core/assert.hpp"
#include "engine/core/clock.hpp"
#include "engine/render/renderer_impl.hpp"

namespace psygen::render {

using core::ErrorCode;
using core::Result;

Result<Picture> RendererImpl::capture() {
  if (!has_picture_ || lost_) {
    return core::fail(ErrorCode::kInvalidArgument,
                      "there is no picture before the first frame of this size");
  }
  Picture picture;
  Targets& drawn = targets_of(slot_of(frame_value_));
  picture.width = drawn.extent.width;
  picture.height = drawn.extent.height;
  picture.rgba.resize(std::size_t{picture.width} * picture.height * 4);
  Result<Buffer> buffer = make_buffer(*device_, picture.rgba.size(),
                                      VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::kRead);
  if (!buffer) return tl::unexpected(buffer.error());
  const Result<void> copied = noted(run_once(*device_, [&](VkCommandBuffer commands) {
    record_copy_to_buffer(*device_, commands, drawn, buffer->buffer.get());
  }));
  if (!copied) return tl::unexpected(copied.error());
  idle_value_ = frame_value_;  // the copy ran after all frames
  std::memcpy(picture.rgba.data(), buffer->mapped, picture.rgba.size());
  if (colour_format_ == VK_FORMAT_B8G8R8A8_UNORM) {
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
      std::swap(picture.rgba[i], picture.rgba[i + 2]);
  }
  return picture;
}

Result<double> RendererImpl::replay_floor_ms(int repeats) {
  PSYGEN_CHECK(repeats >= 1, "the floor needs at least one repeat");
  if (!has_picture_ || !has_list_ || lost_) {
    return core::fail(ErrorCode::kInvalidArgument, "there is no frame to draw again");
  }
  wait_idle();
  // After both slots are filled once, every interval is one frame, with the next one in flight.
  const int lead = static_cast<int>(kFramesInFlight);
  std::vector<double> intervals;
  double last = core::monotonic_seconds();
  for (int i = 0; i < repeats + lead; ++i) {
    FrameSlot& slot = slot_of(frame_value_ + 1);
    const Result<void> drawn = noted(wait_for(slot)
                                         .and_then([&] { return write_frame(slot); })
                                         .and_then([&] { return record(slot, false); })
                                         .and_then([&] { return submit(slot, false); }));
    if (!drawn) return tl::unexpected(drawn.error());
    const double now = core::monotonic_seconds();
    if (i >= lead) intervals.push_back((now - last) * 1e3);
    last = now;
  }
  wait_idle();
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

Result<std::vector<DrawnMesh>> RendererImpl::drawn_meshes() {
  if (!has_list_ || lost_) {
    return core::fail(ErrorCode::kInvalidArgument, "there is no frame whose meshes could be named");
  }
  if (culling_) {
    idle_value_ = frame_value_;
    return noted(culling_->read_drawn(*device_, frame_value_ % kFramesInFlight));
  }
  std::vector<DrawnMesh> drawn;
  for (const DrawRun& run : list_.runs()) {
    for (std::uint32_t i = run.first; i < run.first + run.count; ++i) {
      const IndexedDraw& draw = list_.draws()[i];
      drawn.push_back({run.layout, run.pool_block, run.shared, draw.first_index, draw.index_count,
                       draw.vertex_offset, glm::vec3(list_.data()[i].origin)});
    }
  }
  return drawn;
}

}  // namespace psygen::render
