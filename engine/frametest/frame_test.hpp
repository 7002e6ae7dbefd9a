// A frame test: a flight and the budgets for its measurements, as a TOML file
// (docs/frame-tests.md). Reads a test; run.hpp runs it. Plain values; any thread.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/app/options.hpp"
#include "engine/core/error.hpp"

namespace psygen::frametest {

inline constexpr int kFrameTestFormat = 1;
inline constexpr int kMaxRuns = 99, kMaxRetries = 9;

// Relation of a value to its limit. Also the name of the file's table.
enum class Relation : std::uint8_t { kAtMost, kAtLeast, kEqual };
std::string_view name_of(Relation relation);  // "at_most", "at_least", "equal"

// A limit of a field of summary.json.
struct Budget {
  std::string field;
  Relation relation = Relation::kAtMost;
  std::variant<double, std::string> limit;  // a text only for kEqual
  int line = 0;                             // of the file
  // The limit is this factor times the value of the base; `limit` is set when the base is read.
  std::optional<double> of_base = {};
  // Unless the machine is known to have been calm, processor time must have risen too before the
  // budget is missed.
  bool needs_witness = true;
};

struct FrameTest {
  std::string name;   // also that of a folder: no path, at most 64 bytes
  int name_line = 1;  // of the file
  // Headless; world and path are unresolved names until load_frame_test().
  app::FlightOptions flight;
  std::vector<Budget> budgets;  // in the order of the file, at least one
  int runs = 1;                 // flights of an attempt, whose medians count
  int retries = 0;              // further attempts if a budget that depends on load does not hold
  std::filesystem::path base;   // folder of former runs; empty: none
};

// Parses a text. Fails with kParse, naming file, line and field, for text that is not TOML, another
// format, unknown keys and fields, and values out of range. `file_name` is for messages; its stem
// is the test's name unless the text has one.
core::Result<FrameTest> parse_frame_test(std::string_view text,
                                         const std::filesystem::path& file_name);

// Reads a file and resolves its world and path: first in the folder of the test, then among the
// shipped files. Also fails with kIo, and with kOverBudget for files over 1 MiB.
core::Result<FrameTest> load_frame_test(const std::filesystem::path& file);

// One file of a run, and its test or the reason why there is none.
struct TestFile {
  std::filesystem::path file;
  core::Result<FrameTest> test;
};
// Reads all files of a run. Fails with kParse if two tests have one name; the message has both
// files and lines.
core::Result<std::vector<TestFile>> load_frame_tests(std::span<const std::filesystem::path> files);

}  // namespace psygen::frametest
