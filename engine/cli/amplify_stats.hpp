// Results of psygen amplify and psygen merge as text and as JSON, with the same names. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/amplify/amplify.hpp"

namespace psygen::cli {

// The results to print. Empty members are omitted.
struct AmplifyStats {
  amplify::Report report;  // without a hash unless complete; without times if it has no threads
  struct Files {
    std::uint64_t written = 0, skipped = 0;
  };
  std::optional<Files> files;
  std::string part;            // "shard 3 of 8"; empty: the whole region
  std::uint64_t parts = 0;     // number of merged ledgers; 0: not merged
  unsigned ranks = 0;          // processes of a cluster; 0: a single process
  std::uint64_t messages = 0;  // between ranks
};

// Formats the results for the terminal, and as JSON.
std::string text_of(const AmplifyStats& figures);
std::string json_of(const AmplifyStats& figures);

}  // namespace psygen::cli
