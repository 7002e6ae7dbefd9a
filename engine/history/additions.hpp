// New entries of a history: reads folders of runs, summaries, captures of other tools and counts of
// callgrind, and joins the runs of one job to their median. Any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/history/entry.hpp"

namespace psygen::history {

struct AddOptions {
  std::string test = {};      // name of the test; empty: the name of the folder
  std::string revision = {};  // empty: that of the run's build
  std::string machine = {};   // of captures and counts, which carry no fingerprint; empty: unknown
  std::int64_t time = 0;      // of adding, Unix seconds
  std::vector<std::string> figures = {};  // fields of summary.json besides the usual ones
};

// One run, with the figures of one test.
struct RunFigures {
  std::vector<Entry> entries;  // of one test, revision and job
};

struct Additions {
  std::vector<Entry> entries;      // each job has its order, from 1
  std::vector<std::string> notes;  // sentences about what was left out
  std::size_t runs = 0;
};

// Reads runs. A path is a folder with summary.json at any depth, a summary, a capture, a folder of
// captures, or an output of callgrind. Runs of one test, revision and fingerprint become one entry
// per figure, the median of those that have it. Fails with kIo and kParse, naming the file; with
// kInvalidArgument for runs without a revision, captures without a test, and unknown `figures`.
core::Result<Additions> read_additions(std::span<const std::filesystem::path> paths,
                                       const AddOptions& options);

// The figures of one run from the text of summary.json. `file` is for messages; `test` and `report`
// are those of the entries.
core::Result<RunFigures> parse_summary(std::string_view summary_json, const std::string& file,
                                       const AddOptions& options);

// "CPU: X; cores: 2": a fingerprint's text. And the parts that differ: "different CPU: X and Y".
std::string fingerprint_difference(const std::string& one, const std::string& two);

}  // namespace psygen::history
