// Finds the frames of a flight that missed a budget most: the budget's field selects a column of
// the log. Writes no images (failure.hpp does). Pure.
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

// Returns at most `count` frames after the warm-up, in the order of time: the worst of each missed
// budget, then each budget's next. Skips frames less than half a second from a chosen one, because
// they show the same view. Budgets without a value per frame (hash.world, memory) contribute none.
std::vector<WorstFrame> worst_frames(std::span<const BudgetResult> budgets,
                                     const telemetry::FrameLog& log, double warmup_s,
                                     std::size_t count);

}  // namespace psygen::frametest
