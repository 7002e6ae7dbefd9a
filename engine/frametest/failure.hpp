// What a failed frame test shows of its worst frames: the picture as it was, the same picture with
// everything ready, and where they differ. The flight that was judged writes no pictures, because
// they would disturb its times: the test flies again up to each of these frames. On the virtual
// clock that is the same picture to the bit; on the wall clock it is the same place, but what is
// missing there differs from flight to flight. Main thread only.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "engine/frametest/worst_frames.hpp"

namespace psygen::frametest {

// Removes what an earlier run has left of a failure in a test's folder.
void remove_failure(const std::filesystem::path& folder);

// Writes worst_NNNNN_seen.png, _expected.png and _difference.png of each frame (NNNNN is its
// number), and failed.html with the missed budgets and the pictures, into options.out / test.name.
// Returns the page. "Expected" has the error of levels of detail that the test asks for, and the
// test's own budget of bytes. A picture that could not be made is missing on the page, with the
// reason. Fails with kIo where the page cannot be written.
core::Result<std::filesystem::path> write_failure(const FrameTest& test, const TestResult& result,
                                                  std::span<const WorstFrame> frames,
                                                  const RunOptions& options, const Hooks& hooks);

}  // namespace psygen::frametest
