// An entry of a history: one figure of one test at one revision on one machine. Plain values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace psygen::history {

struct Entry {
  std::int64_t order =
      0;  // of adding, from 1; figures of one job have the same. It counts, not `time`
  std::string test = {}, figure = {};
  std::string unit = {};                 // empty: a count
  std::optional<double> value = {};      // none: not measured, or not a number
  std::optional<double> reference = {};  // seconds of the reference load beside it
  std::string revision = {};             // of the program
  std::string fingerprint = {};          // conditions that comparable entries share
  std::int64_t time = 0;                 // of adding, Unix seconds
  std::optional<double> work = {};       // models made
  std::string report = {};               // path of the run or of its report; may be empty
  friend bool operator==(const Entry&, const Entry&) = default;
};

}  // namespace psygen::history
