// The device's own time for the frames of one slot, by timestamps around its passes. Nothing ever
// waits for them: the slot's next frame copies what its last one wrote, and the CPU reads the copy
// when that frame has finished, two frames of the slot later. Asking the driver for the queries
// instead would stop lavapipe until it has finished everything. Private to engine/render.
#pragma once

#include <optional>

#include "engine/render/memory.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

class GpuTimer {
 public:
  enum class Mark : std::uint32_t { kBegin, kEnd, kShadows };  // kShadows: behind their pass

  // Does nothing, and knows nothing, where the queue has no timestamps.
  core::Result<void> create(const Device& device);

  // At the start of a frame's commands. Requires that the slot's last frame has finished.
  void begin(const Device& device, VkCommandBuffer commands);
  // Outside of rendering. Shadows may be left out; a frame without the end is not timed.
  void mark(const Device& device, VkCommandBuffer commands, Mark mark);
  // The frame that begin() and the marks belong to has been submitted.
  void submitted(std::uint64_t frame, double now_s);

  // Requires that the last frame submitted has finished: the times of the one before it.
  std::optional<GpuTime> read(const Device& device) const;

 private:
  struct Frame {
    std::uint64_t number = 0;
    double submitted_s = 0;
    bool timed = false, shadows = false;
  };

  UniqueQueryPool queries_;
  Buffer ticks_;
  Frame recorded_, copied_;  // whose ticks are in the queries, and in `ticks_`
};

}  // namespace psygen::render
