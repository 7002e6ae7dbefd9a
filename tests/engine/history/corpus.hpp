// Histories with known answers: series.csv has 25 synthetic series, answers.csv the right answer of
// each, real.csv 220 runs of identical bytes under four loads.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "engine/history/exchange.hpp"
#include "tests/source_file.hpp"

namespace psygen::history::testing {

inline std::string text_of(const std::string& name) {
  std::ifstream file(source_file("tests/engine/history/" + name));
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// All entries of series.csv.
inline std::vector<Entry> corpus() {
  auto read = parse_entries(text_of("series.csv"), "series.csv");
  EXPECT_TRUE(read);
  return read ? read->entries : std::vector<Entry>();
}

// A column of real.csv by load, with its values in the order of the runs.
inline std::map<std::string, std::map<std::string, std::vector<double>>> real_runs() {
  std::map<std::string, std::map<std::string, std::vector<double>>> runs;
  std::istringstream lines(text_of("real.csv"));
  std::string line, cell;
  std::vector<std::string> names;
  std::getline(lines, line);
  for (std::istringstream header(line); std::getline(header, cell, ',');)
    names.push_back(cell);
  while (std::getline(lines, line)) {
    std::istringstream row(line);
    std::string load;
    std::getline(row, load, ',');
    for (std::size_t i = 1; i < names.size() && std::getline(row, cell, ','); ++i)
      runs[load][names[i]].push_back(cell.empty() ? 0 : std::stod(cell));
  }
  return runs;
}

// Entries of one figure; the first `before` are of revision "old", the others of "new".
inline std::vector<Entry> series(const std::vector<double>& values, const std::string& figure,
                                 const std::string& unit, std::size_t before) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < values.size(); ++i) {
    Entry entry;
    entry.order = static_cast<std::int64_t>(i) + 1;
    entry.test = "walk";
    entry.figure = figure;
    entry.unit = unit;
    entry.value = values[i];
    entry.revision = i < before ? "old" : "new";
    entry.fingerprint = "CPU: X; cores: 2";
    entry.time = 1'700'000'000 + static_cast<std::int64_t>(i);
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace psygen::history::testing
