// The tables of docs/limits.md.
#pragma once

#include <string>
#include <vector>

namespace psygen::limits {

// A row of the page.
struct Row {
  std::string input;     // the thing that has the limit
  double most = 0;       // the limit, in the unit of the page, with MiB as 2^20
  std::string constant;  // the name of the constant …
  std::string file;      // … and its file below engine/ or game/
  std::string
      refusal;  // the message of one more, with "…" for what varies; empty in the second table
  std::string test;  // of the second table: the test that holds the limit
};

// The rows whose limits Limits.HoldAsThePageSays tries, and those that other tests hold.
struct Page {
  std::vector<Row> tried, held_elsewhere;
};

Page read_page();

// True if a message has all parts of a refusal in this order.
bool matches(const std::string& message, const std::string& refusal);

}  // namespace psygen::limits
