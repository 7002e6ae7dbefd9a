// Runs frame tests and judges them by their budgets. A game runs its own code in them through
// hooks. One test after the other; main thread only.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/app/session.hpp"
#include "engine/frametest/frame_test.hpp"
#include "engine/telemetry/summary.hpp"

namespace psygen::frametest {

// What a game adds to each test; each may be empty. Called for every flight: after a missed budget
// a test flies again for its pictures (failure.hpp).
struct Hooks {
  // Before the session is made: plugins, for example. World, size and the like are the file's.
  std::function<core::Result<void>(app::SessionOptions&)> prepare = {};
  // Once the session is there, before the cache is filled.
  std::function<core::Result<void>(app::Session&)> start = {};
  // The camera of each frame, with the seconds since the last one, in place of the file's path: for
  // games that play themselves.
  std::function<core::CameraPose(app::Session&, double)> camera = {};
};

inline constexpr int kMaxWorstFrames = 100;

struct RunOptions {
  std::vector<std::filesystem::path> files;
  std::filesystem::path out;                // a folder in it for each test; empty: nothing is kept
  std::filesystem::path junit;              // file; empty: none
  std::string device;                       // part of a name; empty: the best
  int worst_frames = 3;                     // pictures of a failed test; they need `out`
  const std::atomic<bool>* stop = nullptr;  // set from anywhere to end early
};

// A budget after the run.
struct BudgetResult {
  Budget budget;
  std::string value;  // the figure, or why there is none
  bool holds = false;
};

// What became of a file.
struct TestResult {
  std::filesystem::path file;
  std::string name;
  std::vector<BudgetResult> budgets;
  std::optional<core::Error> error;  // it could not be run; kNoDevice: nothing can be
  double seconds = 0;                // that it took
  std::filesystem::path page;        // failed.html, of a failed test; empty: there is none

  bool holds() const;  // it could be run, and each budget holds
};

// Exit codes of a run of tests. 77 is what CTest and Automake take for skipped.
enum ExitCode : int { kHeld = 0, kFailed = 1, kUsage = 2, kMissed = 3, kSkipped = 77 };
int exit_code_of(std::span<const TestResult> results);

// Judges a summary: one result for each budget. A figure that was not measured is a miss.
std::vector<BudgetResult> judge(std::span<const Budget> budgets, const telemetry::Summary& summary);

// How a limit is written: "<=" and "25".
std::string_view sign_of(Relation relation);
std::string limit_of(const Budget& budget);

// Runs one file.
TestResult run_frame_test(const std::filesystem::path& file, const RunOptions& options,
                          const Hooks& hooks = {});
// Lines for people: one for each budget.
std::string to_text(const TestResult& result);
// The results as JUnit XML: a suite for each file, a case for each budget.
std::string to_junit(std::span<const TestResult> results);

// Runs all files, prints their lines to stdout and what could not be run to stderr, and writes the
// JUnit file. Returns the exit code.
int run_frame_tests(const RunOptions& options, const Hooks& hooks = {});
// The whole main() of a game's frame tests:
// FILE... [--junit FILE] [--out DIR] [--device NAME] [--worst N].
int frame_test_main(int argc, char** argv, const Hooks& hooks);

}  // namespace psygen::frametest
