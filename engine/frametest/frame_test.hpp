// A frame test: a flight and the budgets that its figures must keep, as a TOML file
// (docs/frame-tests.md). Knows how to read one; running is run.hpp's. Plain values; any thread.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/app/options.hpp"
#include "engine/core/error.hpp"

namespace psygen::frametest {

inline constexpr int kFrameTestFormat = 1;

// How a figure must stand to its limit. Also the name of the file's table.
enum class Relation : std::uint8_t { kAtMost, kAtLeast, kEqual };
std::string_view name_of(Relation relation);  // "at_most", "at_least", "equal"

// A limit of a field of summary.json.
struct Budget {
  std::string field;
  Relation relation = Relation::kAtMost;
  std::variant<double, std::string> limit;  // a text only for kEqual
  int line = 0;                             // of the file
};

struct FrameTest {
  std::string name;
  app::FlightOptions flight;    // headless; world and path as they are written until resolved
  std::vector<Budget> budgets;  // in the order of the file, at least one
};

// Reads a text. Fails with kParse, naming file, line and field: for text that is not TOML, another
// format, unknown keys and fields, and values out of range. `file_name` is for messages, and its
// stem is the test's name unless the text has one.
core::Result<FrameTest> parse_frame_test(std::string_view text,
                                         const std::filesystem::path& file_name);

// Reads a file and finds its world and path: in the folder of the test, else among what comes with
// psygen. Fails also with kIo, and with kOverBudget for files over 1 MiB.
core::Result<FrameTest> load_frame_test(const std::filesystem::path& file);

}  // namespace psygen::frametest
