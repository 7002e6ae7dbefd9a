// A TOML document as a plain tree that remembers lines. The only place that knows the parser, so
// that world and path files are read from values of our own. Not a validator: table_reader.hpp
// says what is allowed. Hostile texts are refused, whatever they contain.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::world {

struct Member;

struct Node {
  enum class Kind : std::uint8_t { kInteger, kReal, kText, kBoolean, kTime, kArray, kTable };
  Kind kind = Kind::kTable;
  int line = 1;  // where it begins, from 1
  std::int64_t integer = 0;
  double real = 0;  // of integers too
  bool boolean = false;
  std::string text;
  std::vector<Node> items;      // of an array
  std::vector<Member> members;  // of a table, sorted by key
};

struct Member {
  std::string key;
  int line = 1;
  Node value;
};

// Values and tables may be nested this deep.
inline constexpr int kMaxNesting = 16;

// The root table. Fails with kParse, naming file and line, for anything that is not TOML 1.0 in
// UTF-8, for nesting and dotted keys deeper than kMaxNesting, and for strings over several lines.
core::Result<Node> parse_document(std::string_view text, std::string_view file_name);

// "an integer", "a table", …
std::string_view kind_name(Node::Kind kind);

}  // namespace psygen::world
