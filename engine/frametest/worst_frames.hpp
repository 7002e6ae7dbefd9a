// Which frames of a flight missed a budget most: the budget's figure says which column of the log
// is looked at. Knows nothing of pictures (failure.hpp). Pure.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/frametest/run.hpp"
#include "engine/telemetry/frame_log.hpp"

namespace psygen::frametest {

struct WorstFrame {
  std::uint64_t index = 0;  // FrameRecord::index
  double time_s = 0;        // on the flight's clock
  std::string why;          // "frame_ms.p99: 5.63 ms"
};

// At most `count` frames after the warm-up, in the order of time: the worst of each missed budget,
// then each one's next. Frames less than half a second from one that was chosen are left out, since
// they show the same. Budgets whose figure no single frame has (hash.world, memory) have none.
std::vector<WorstFrame> worst_frames(std::span<const BudgetResult> budgets,
                                     const telemetry::FrameLog& log, double warmup_s,
                                     std::size_t count);

}  // namespace psygen::frametest
