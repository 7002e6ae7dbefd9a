// The base of a frame test: former runs of the same test, as `psygen test --out` leaves them.
// Limits may be relative to it, and it tells the usual times of the machine.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/compare/recorded_run.hpp"
#include "engine/core/error.hpp"
#include "engine/frametest/frame_test.hpp"
#include "engine/frametest/judge.hpp"

namespace psygen::frametest {

struct Base {
  std::filesystem::path folder;
  std::vector<RunFields> runs;      // at least one
  compare::RecordedRun conditions;  // of the first run

  // The lower quartile of the reference load, and the median of processor time.
  UsualLoad usual() const;
};

// Reads the runs in DIR/NAME, or in DIR itself if it has a summary.json. Fails with kIo if there
// are none, and the message says how to make them; like compare::read_runs() for damaged ones; and
// with kInvalidArgument if the runs were made under different conditions.
core::Result<Base> load_base(const std::filesystem::path& dir, const FrameTest& test);

// Sets the limits that are relative to the base: factor x median of the base's runs. Fails with
// kInvalidArgument, naming the field, if the base has no such number.
core::Result<void> set_limits(FrameTest& test, const Base& base);

// Fails with kInvalidArgument, naming the differences, if a run's figures cannot be compared with
// the base's, by the rule of `psygen compare`.
core::Result<void> check_conditions(const Base& base, std::string_view summary_json,
                                    bool virtual_clock);

}  // namespace psygen::frametest
