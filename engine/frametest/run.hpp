// Runs frame tests and compares their measurements with the budgets. Games run their code in the
// tests through hooks. Runs one test after the other; main thread only.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/app/session.hpp"
#include "engine/frametest/frame_test.hpp"
#include "engine/telemetry/remarks.hpp"
#include "engine/telemetry/summary.hpp"

namespace CLI {
class App;
}

namespace psygen::app {
class Flight;
}

namespace psygen::frametest {

// Hooks of a game, each optional. Called for every flight: after a missed budget the test flies
// again to capture images (failure.hpp).
struct Hooks {
  // Before the session is created, for example to add plugins. The file defines world, size and the
  // like.
  std::function<core::Result<void>(app::SessionOptions&)> prepare = {};
  // After the session is created, before the cache is filled.
  std::function<core::Result<void>(app::Session&)> start = {};
  // Returns the camera of each frame instead of the file's path, given the seconds since the last
  // frame. For games that play themselves.
  std::function<core::CameraPose(app::Session&, double)> camera = {};
};

inline constexpr int kMaxWorstFrames = 100;

struct RunOptions {
  std::vector<std::filesystem::path> files;
  std::filesystem::path out;    // has one subfolder per test; empty: outputs are not kept
  std::filesystem::path base;   // folder of former runs; empty: that of a test's file
  std::filesystem::path usual;  // file with the last runs of machines (usual_load.hpp); empty: none
  std::filesystem::path junit;  // file; empty: none
  telemetry::PullRequestWords words;
  std::string device;    // index, UUID or part of the name; empty: the best device
  int worst_frames = 3;  // number of frames captured of a failed test; requires `out`
  bool profile = false;  // writes profile.json of tests that hold too; requires `out`
  const std::atomic<bool>* stop = nullptr;  // set by any thread to end early
};

// Result of one budget.
struct BudgetResult {
  Budget budget;
  std::string
      value;  // the measured value, or the reason why there is none; of several runs the median
  bool holds = false;
  bool judged = true;  // false: it does not hold, but the machine was too busy to say so
  std::vector<std::string> runs = {};   // the values of several runs, in the order of the flights
  std::vector<std::string> notes = {};  // sentences

  // The budget was judged, and does not hold.
  bool misses() const { return judged && !holds; }
};

// Result of one test file.
struct TestResult {
  std::filesystem::path file;
  std::string name;
  std::vector<BudgetResult> budgets;
  std::optional<core::Error> error;      // the test did not run; kNoDevice: no test can run
  double seconds = 0;                    // duration of the test
  std::filesystem::path page;            // failed.html of a failed test; empty: none
  std::vector<std::string> causes = {};  // of its bad frames, each in one line

  bool holds() const;   // the test ran, and every budget holds
  bool misses() const;  // the test ran, and a budget is missed
};

// Exit codes of a run of tests. CTest and Automake interpret 77 as skipped.
enum ExitCode : int {
  kHeld = 0,
  kFailed = 1,
  kUsage = 2,
  kMissed = 3,
  kNotJudged = 5,  // nothing is missed, but the machine was too busy to judge all budgets
  kSkipped = 77
};
int exit_code_of(std::span<const TestResult> results);

// Text of a limit: "<=" and "25".
std::string_view sign_of(Relation relation);
std::string limit_of(const Budget& budget);
// Escapes a text for HTML and XML. No control characters remain, which XML cannot represent.
std::string escaped(std::string_view text);

// Creates the flight of a test: adds device, stop flag and hooks to `flight`. `last` (may be empty)
// follows the game's plugins. Fails like app::Flight::create() and the hooks.
core::Result<std::unique_ptr<app::Flight>> start_flight(app::FlightOptions flight,
                                                        const RunOptions& options,
                                                        const Hooks& hooks, app::Plugin last = {});

// Runs one file, whose limits are not relative to a base.
TestResult run_frame_test(const TestFile& file, const RunOptions& options, const Hooks& hooks = {});
// Text with one line for each budget.
std::string to_text(const TestResult& result);
// Formats the results as JUnit XML: a suite for each file, a case for each budget. The cases of a
// file have a class of their own, and share the file's time.
std::string to_junit(std::span<const TestResult> results);
// Markdown for a pull request: a table of the tests, and one of the budgets of each test that does
// not hold.
std::string to_markdown(std::span<const TestResult> results);
// A remark for each missed budget, at its line, and for each test that could not run.
std::vector<telemetry::Remark> remarks_of(std::span<const TestResult> results);

// Declares --markdown and --annotations; `words` outlives the command line.
void add_words(CLI::App& cli, telemetry::PullRequestWords& words);
// Declares the options of a command line; `options` outlives it. Limits --worst to 0 …
// kMaxWorstFrames.
void add_options(CLI::App& cli, RunOptions& options);
// Reads all files, flies them in turn, prints results to stdout and errors to stderr, and writes
// the files of the results. Runs nothing if two tests have one name. Returns the exit code.
int run_frame_tests(const RunOptions& options, const Hooks& hooks = {});
// Complete main() of a game's frame tests, with add_options().
int frame_test_main(int argc, char** argv, const Hooks& hooks);

}  // namespace psygen::frametest
