// The figures of psygen amplify and psygen merge as text and as JSON, with the same names. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/amplify/amplify.hpp"

namespace psygen::cli {

// What is shown. What is not there is left out.
struct AmplifyFigures {
  amplify::Totals totals;
  bool complete = false;  // else there is no hash
  struct Times {
    double seconds = 0, cpu_seconds = 0;
    unsigned threads = 0;
  };
  std::optional<Times> times;
  struct Files {
    std::uint64_t written = 0, skipped = 0;
  };
  std::optional<Files> files;
  std::string part;            // "shard 3 of 8"; empty: all of it
  std::uint64_t parts = 0;     // ledgers that were joined; 0: not joined
  unsigned ranks = 0;          // processes of a cluster; 0: this one alone
  std::uint64_t messages = 0;  // between ranks
};

std::string text_of(const AmplifyFigures& figures);
std::string json_of(const AmplifyFigures& figures);

}  // namespace psygen::cli
