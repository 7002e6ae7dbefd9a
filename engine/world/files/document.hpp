// A TOML document as a plain tree with line numbers. Only this file's source includes the parser;
// world and path files are read from these nodes. It validates nothing: table_reader.hpp does that.
// Safe for hostile texts. Plain values, any thread. docs/world-files.md.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::world {

struct Member;

// A value. Only the member for its kind is set.
struct Node {
  // kTime: any date or time; its value is not kept.
  enum class Kind : std::uint8_t { kInteger, kReal, kText, kBoolean, kTime, kArray, kTable };
  Kind kind = Kind::kTable;
  int line = 1;  // first line, counted from 1
  std::int64_t integer = 0;
  double real = 0;  // set for integers too
  bool boolean = false;
  std::string text;
  std::vector<Node> items;      // of an array
  std::vector<Member> members;  // of a table, sorted by key

  // The member of a table with this key, or null.
  const Member* find(std::string_view key) const;
  // The line of that member's value, or of the table if it has no such member.
  int line_of(std::string_view key) const;
};

// A key of a table with its line and its value.
struct Member {
  std::string key;
  int line = 1;
  Node value;
};

// Maximum depth of nested values and tables.
inline constexpr int kMaxNesting = 16;

// Parses a text and returns its root table. Fails with kParse, naming file and line, for anything
// that is not TOML 1.0 in UTF-8, for nesting and dotted keys deeper than kMaxNesting, and for
// strings over several lines. `file_name` is for messages only.
core::Result<Node> parse_document(std::string_view text, std::string_view file_name);

// A kind for messages: "an integer", "a table", …
std::string_view kind_name(Node::Kind kind);

// Screens the text of a file before the TOML parser reads it. Rejects texts that the parser cannot
// handle or describe well: bytes that are not UTF-8, non-ASCII characters outside strings and
// comments, strings over several lines, and dotted keys with too many parts. Not a parser: it knows
// only strings, comments and lines. Pure, any thread, linear in the text.
// Fails with kParse at the first violation, naming file, line and column (from 1, in characters). A
// byte order mark at the start is allowed. A dotted key may have at most `max_parts` parts.
core::Result<void> screen_text(std::string_view text, std::string_view file, int max_parts);

}  // namespace psygen::world
