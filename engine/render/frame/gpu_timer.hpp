// The device's own time for the frames of one slot, from timestamps around its passes. Nothing
// waits for them: the slot's next frame copies the timestamps of its last one, and the CPU reads
// the copy when that frame has finished, two frames of the slot later. Reading the queries from the
// driver instead would make lavapipe finish all its work first. It measures no CPU time. Main
// thread. Private to engine/render.
#pragma once

#include <optional>

#include "engine/render/memory/memory.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

// The timestamps of one slot. Does nothing until create().
class GpuTimer {
 public:
  // Places of timestamps in a frame.
  enum class Mark : std::uint32_t { kBegin, kEnd, kShadows };  // kShadows: after their pass

  // Creates the queries. If the queue has no timestamps, the timer does nothing.
  core::Result<void> create(const Device& device);

  // Call it at the start of a frame's commands. The slot's last frame must have finished.
  void begin(const Device& device, VkCommandBuffer commands);
  // Records a timestamp, outside of a rendering. kShadows may be left out. A frame without kEnd
  // is not timed.
  void mark(const Device& device, VkCommandBuffer commands, Mark mark);
  // Records the end of pass 0, 1 … of kPassNames, also inside of a rendering. Does nothing without
  // DeviceInfo::pass_times. A frame has all passes or none.
  void mark_pass(const Device& device, VkCommandBuffer commands, std::uint32_t pass);
  // Call it when the frame has been submitted. `frame` is its number, `now_s` the time.
  void submitted(std::uint64_t frame, double now_s);

  // The times of the frame before the last one, or nothing. The last submitted frame must have
  // finished.
  std::optional<GpuTime> read(const Device& device) const;

 private:
  struct Frame {
    std::uint64_t number = 0;
    double submitted_s = 0;
    bool timed = false, shadows = false, passes = false;
  };

  void write(const Device& device, VkCommandBuffer commands, std::uint32_t query) const;

  UniqueQueryPool queries_;
  Buffer ticks_;
  Frame recorded_, copied_;  // frames whose ticks are in the queries, and in `ticks_`
};

}  // namespace psygen::render
