// Report of a failed frame test about its worst frames: the image as drawn, the same image with all
// meshes ready, and their difference. The judged flight writes no images, because they would
// disturb its times: the test repeats the flight up to each of these frames. On the virtual clock
// the images are bit-identical; on the wall clock the position is the same, but missing meshes
// differ from flight to flight. Main thread only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/frametest/run.hpp"
#include "engine/telemetry/frame_log.hpp"

namespace psygen::frametest {

struct CauseReport;  // cause_report.hpp

struct WorstFrame {
  std::uint64_t index = 0;  // FrameRecord::index
  double time_s = 0;        // on the flight's clock
  std::string why;          // "frame_ms.p99: 5.63 ms"
};

// Returns at most `count` frames after the warm-up, in the order of time: the worst of each missed
// budget, then each budget's next. Skips frames less than half a second from a chosen one, because
// they show the same view. Budgets of a section have frames of that section alone. Budgets without
// a value per frame (hash.world, memory) contribute none.
std::vector<WorstFrame> worst_frames(std::span<const BudgetResult> budgets,
                                     const telemetry::FrameLog& log, double warmup_s,
                                     std::size_t count,
                                     std::span<const telemetry::SectionRange> sections = {});

// Removes the failure report of an earlier run from a test's folder.
void remove_failure(const std::filesystem::path& folder);

// Writes worst_NNNNN_seen.png, _expected.png and _difference.png of each frame (NNNNN is its
// number), and failed.html with the missed budgets, the causes (of the same frames) and the images,
// into options.out / test.name. Returns the page. The "expected" image has the screen-space error
// and the memory budget of the test. If an image cannot be made, the page shows the reason instead.
// Fails with kIo if the page cannot be written.
core::Result<std::filesystem::path> write_failure(const FrameTest& test, const TestResult& result,
                                                  std::span<const WorstFrame> frames,
                                                  const CauseReport& causes,
                                                  const RunOptions& options, const Hooks& hooks);

}  // namespace psygen::frametest
