// One frame test of a run, flown as often as its file asks for: runs, and further attempts. The
// caller flies several tests in turn, so that a spell of load does not meet all runs of one. Main
// thread only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/frametest/base.hpp"
#include "engine/frametest/cause_report.hpp"
#include "engine/frametest/failure.hpp"
#include "engine/frametest/judge.hpp"
#include "engine/frametest/run.hpp"
#include "engine/frametest/usual_load.hpp"

namespace psygen::frametest {

// A file of a run, and the base of its test if there is one.
struct PreparedTest {
  TestFile file;
  std::optional<Base> base = {};
};

// Reads the base of a test: from options.base, else from its file. A test whose limits are not
// relative does without a base that does not exist. Fails like load_base() and set_limits().
core::Result<std::optional<Base>> base_for(FrameTest& test, const RunOptions& options);

class TestFlights {
 public:
  // All references outlive the object.
  TestFlights(const PreparedTest& prepared, const RunOptions& options, const Hooks& hooks,
              const UsualLoadFile& usual);

  // False after the last flight, and after an error.
  bool wants_more() const { return !over_; }
  // Flies once. Judges at the end of an attempt.
  void fly();
  // The result, after the last flight. Repeats the flight of a missed budget to show its worst
  // frames.
  TestResult finish();
  // The runs for the machine's record: processor time only if all budgets hold. A run without both
  // figures is left out.
  std::vector<UsualLoadFile::Run> record() const;

 private:
  core::Result<void> fly_once();
  core::Result<void> use_conditions(const telemetry::Summary& summary);
  void judge_attempt();
  void clear_folder() const;
  bool flies_often() const { return test_.runs > 1 || test_.retries > 0; }
  std::string folder_name(std::size_t run) const;
  void show_failure();
  void keep_profile();
  CauseReport causes_of(std::span<const WorstFrame> frames);

  FrameTest test_;
  const std::optional<Base>& base_;
  const RunOptions& options_;
  const Hooks& hooks_;
  const UsualLoadFile& usual_file_;
  UsualLoad usual_ = {};
  std::string machine_ = {};
  std::vector<RunFields> runs_ = {};
  std::vector<std::vector<WorstFrame>> worst_ = {};  // of each run
  TestResult result_ = {};
  bool over_ = false;
};

}  // namespace psygen::frametest
