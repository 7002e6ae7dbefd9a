// The objects of one frame in flight: a command buffer, the buffers that the CPU writes,
// timestamps. The CPU uses a slot only after the device has finished the slot's last frame. It
// decides nothing about the frame's content. Main thread. Private to engine/render.
#pragma once

#include <span>

#include "engine/render/frame/frame_sets.hpp"
#include "engine/render/frame/gpu_timer.hpp"
#include "engine/render/memory/memory.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// Empty until create(). The device must outlive it.
class FrameSlot {
 public:
  // Creates all objects, once. `number` is that of the slot, from 0.
  core::Result<void> create(const Device& device, std::size_t number);
  std::size_t number() const { return number_; }
  // Names the slot's buffers in its set. Call it for new sets.
  void use(const Device& device, const FrameSets& sets);

  // Copies a frame's data into the slot's buffers. They grow if needed, which can fail with
  // kOutOfMemory.
  core::Result<void> write(const Device& device, const FrameSets& sets,
                           const shaders::FrameData& frame,
                           std::span<const shaders::DrawData> draws);
  // Copies the map of contact shadows (ContactShadowMap::words()).
  void write_shade(std::span<const std::uint32_t> words);
  const Buffer& frame_data() const { return frame_; }  // shaders::FrameData

  // begin() resets the command buffer and starts recording; end() makes it ready to submit.
  core::Result<void> begin(const Device& device);
  core::Result<void> end(const Device& device);
  VkCommandBuffer commands() const { return commands_.get(); }
  // The semaphore for the acquired image of the window.
  VkSemaphore acquired() const { return acquired_.get(); }
  GpuTimer& timer() { return timer_; }  // the device's time for frames of this slot

  std::uint64_t submitted_value = 0;  // timeline value of the last frame; 0: none

 private:
  Commands commands_;
  Buffer frame_, draws_, shade_;
  std::size_t number_ = 0;
  UniqueSemaphore acquired_;
  GpuTimer timer_;
};

}  // namespace psygen::render
