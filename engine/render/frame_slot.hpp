// The objects of one frame in flight: a command buffer, the buffers that the CPU writes,
// timestamps. The CPU uses a slot only after the device has finished the slot's last frame. It
// decides nothing about the frame's content. Main thread. Private to engine/render.
#pragma once

#include <span>

#include "engine/render/bindings.hpp"
#include "engine/render/draw_list.hpp"
#include "engine/render/gpu_timer.hpp"
#include "engine/render/memory.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// Empty until create(). The device must outlive it.
class FrameSlot {
 public:
  // Creates all objects, once.
  core::Result<void> create(const Device& device);
  // Records frames with a set of these bindings from now on. `number` is that of the slot, from 0.
  void use(const Device& device, const Bindings& bindings, std::size_t number);

  // Copies a frame's data into the slot's buffers. They grow if needed, which can fail with
  // kOutOfMemory. At most kMaxEmitters emitters.
  core::Result<void> write(const Device& device, const Bindings& bindings,
                           const shaders::FrameData& frame,
                           std::span<const shaders::DrawData> draws,
                           std::span<const shaders::OverlayVertex> glyphs,
                           std::span<const shaders::EmitterData> emitters = {});

  // The same for the map of dark spots (GroundShade::words()).
  void write_shade(std::span<const std::uint32_t> words);

  // begin() resets the command buffer and starts recording; end() makes it ready to submit.
  core::Result<void> begin(const Device& device);
  core::Result<void> end(const Device& device);
  // The command buffer, and the descriptor set of the frame.
  VkCommandBuffer commands() const { return commands_; }
  VkDescriptorSet set() const { return set_; }
  // Binds `draws`, which the device writes, instead of the slot's own data of draws.
  void read_draws_from(const Device& device, const Bindings& bindings, const Buffer& draws) const {
    bindings.write(device, set_, {frame_, draws, glyphs_, emitters_, shade_});
  }
  // The semaphore for the acquired image of the window, and the frame's timestamps.
  VkSemaphore acquired() const { return acquired_.get(); }

  GpuTimer& timer() { return timer_; }  // the device's time for frames of this slot

  std::uint64_t submitted_value = 0;  // timeline value of the last frame; 0: none

 private:
  UniqueCommandPool pool_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  Buffer frame_, draws_, glyphs_, emitters_, shade_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  UniqueSemaphore acquired_;
  GpuTimer timer_;
};

}  // namespace psygen::render
