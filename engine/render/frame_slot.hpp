// What one frame in flight owns: commands, the buffers that the CPU writes for it, timestamps.
// Touched by the CPU only after the device has passed the slot's last value. Private to
// engine/render.
#pragma once

#include <span>

#include "engine/render/draw_list.hpp"
#include "engine/render/gpu_timer.hpp"
#include "engine/render/memory.hpp"
#include "engine/render/pipelines.hpp"
#include "shaders/shared.h"

namespace psygen::render {

class FrameSlot {
 public:
  core::Result<void> create(const Device& device);
  // Frames are recorded with these pipelines from now on; `number` of the slot, from 0.
  void use(const Device& device, const Pipelines& pipelines, std::size_t number);

  // Copies a frame's data into the slot's buffers; they grow where needed (kOutOfMemory).
  core::Result<void> write(const Device& device, const Pipelines& pipelines,
                           const shaders::FrameData& frame,
                           std::span<const shaders::DrawData> draws,
                           std::span<const shaders::OverlayVertex> glyphs);

  // Starts recording from nothing; end() makes the commands ready to submit.
  core::Result<void> begin(const Device& device);
  core::Result<void> end(const Device& device);
  VkCommandBuffer commands() const { return commands_; }
  VkDescriptorSet set() const { return set_; }
  // Binds the data of draws that the device writes itself instead of the slot's own.
  void read_draws_from(const Device& device, const Pipelines& pipelines,
                       const Buffer& draws) const {
    pipelines.write_set(device, set_, frame_, draws, glyphs_);
  }
  VkSemaphore acquired() const { return acquired_.get(); }

  GpuTimer& timer() { return timer_; }

  std::uint64_t submitted_value = 0;  // of the timeline; 0: never

 private:
  UniqueCommandPool pool_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  Buffer frame_, draws_, glyphs_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  UniqueSemaphore acquired_;
  GpuTimer timer_;
};

}  // namespace psygen::render
