// Report of a failed frame test about its worst frames: the image as drawn, the same image with all
// meshes ready, and their difference. The judged flight writes no images, because they would
// disturb its times: the test repeats the flight up to each of these frames. On the virtual clock
// the images are bit-identical; on the wall clock the position is the same, but missing meshes
// differ from flight to flight. Main thread only.
#pragma once

#include <filesystem>
#include <span>

#include "engine/frametest/worst_frames.hpp"

namespace psygen::frametest {

// Removes the failure report of an earlier run from a test's folder.
void remove_failure(const std::filesystem::path& folder);

// Writes worst_NNNNN_seen.png, _expected.png and _difference.png of each frame (NNNNN is its
// number), and failed.html with the missed budgets and the images, into options.out / test.name.
// Returns the page. The "expected" image has the screen-space error and the memory budget of the
// test. If an image cannot be made, the page shows the reason instead. Fails with kIo if the page
// cannot be written.
core::Result<std::filesystem::path> write_failure(const FrameTest& test, const TestResult& result,
                                                  std::span<const WorstFrame> frames,
                                                  const RunOptions& options, const Hooks& hooks);

}  // namespace psygen::frametest
