#include "engine/render/frame/frame_slot.hpp"

#include <cstring>

namespace psygen::render {

using core::Result;

namespace {

constexpr std::uint64_t kFirstDraws = 4096;

Result<Buffer> storage_buffer(const Device& device, std::uint64_t bytes) {
  return make_buffer(device, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::kWrite);
}

}  // namespace

Result<void> FrameSlot::create(const Device& device, std::size_t number) {
  number_ = number;
  constexpr std::size_t kShadeBytes = std::size_t{PSYGEN_SHADE_SIDE} * PSYGEN_SHADE_SIDE * 2;
  return commands_.create(device, device.queue_family)
      .and_then([&] { return make_semaphore(device); })
      .map(into(acquired_))
      .and_then([&] { return timer_.create(device); })
      .and_then([&] {
        return make_buffer(device, sizeof(shaders::FrameData), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                           MemoryUse::kWrite);
      })
      .map(into(frame_))
      .and_then([&] { return storage_buffer(device, kFirstDraws * sizeof(shaders::DrawData)); })
      .map(into(draws_))
      .and_then([&] { return storage_buffer(device, kShadeBytes); })
      .map(into(shade_))
      .map([&] { std::memset(shade_.mapped, 0, kShadeBytes); });
}

void FrameSlot::use(const Device& device, const FrameSets& sets) {
  sets.write(device, number_, {frame_, draws_, shade_});
}

Result<void> FrameSlot::write(const Device& device, const FrameSets& sets,
                              const shaders::FrameData& frame,
                              std::span<const shaders::DrawData> draws) {
  return grow(device, draws_, draws.size_bytes(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
              MemoryUse::kWrite)
      .map([&](bool replaced) {
        if (replaced) use(device, sets);
        std::memcpy(frame_.mapped, &frame, sizeof(frame));
        if (!draws.empty()) std::memcpy(draws_.mapped, draws.data(), draws.size_bytes());
      });
}

void FrameSlot::write_shade(std::span<const std::uint32_t> words) {
  std::memcpy(shade_.mapped, words.data(), words.size_bytes());
}

Result<void> FrameSlot::begin(const Device& device) {
  return commands_.begin(device).map([&] { timer_.begin(device, commands_.get()); });
}

Result<void> FrameSlot::end(const Device& device) {
  return commands_.end(device);
}

}  // namespace psygen::render
