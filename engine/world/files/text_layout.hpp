// Where the tables and values of a TOML text are, in bytes: what an edit needs to change one of
// them and leave all else alone. Not a parser: it requires a text that parse_document() takes.
// Internal to world. Plain values, any thread; linear in the text, as finding a path is.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/world/files/text_path.hpp"

namespace psygen::world {

// Bytes [begin, end) of a text.
struct TextSpan {
  std::size_t begin = 0, end = 0;
};

// A table or a value in the text.
struct TextPlace {
  enum class Kind {
    kValue,  // key = value, or a value within another (`nested`)
    kTable,  // [header]
    kItem,   // [[header]]
  };
  Kind kind = Kind::kValue;
  TextPath path;
  TextSpan value;  // the value; of a header: from "[" to "]"
  // Whole lines of the statement or header, with the line break. Of a nested value: from its key
  // to its end.
  TextSpan lines;
  bool nested = false;        // in an inline table or an array
  std::size_t key_parts = 1;  // of the key of a statement: 2 in "a.b = 1"
  bool is_header() const { return kind != Kind::kValue; }
};

// A text and its places, in the order of the text.
struct TextLayout {
  std::string_view text;
  std::vector<TextPlace> places;

  std::size_t begin() const;  // behind a byte order mark
  // The index of the place with this path, or -1.
  int find(const TextPath& path) const;
  // Where what belongs to a header begins: at the comment lines directly above it, unless they
  // begin the file.
  std::size_t start_of(const TextPlace& header) const;
  // The index of the first header behind place `i` (-1: of all), or places.size().
  std::size_t next_header(int i) const;
  // How many items an array has, of tables or inline; 0 if there is no such array.
  std::size_t item_count(const TextPath& array) const;
  // The line break of the text: "\r\n" if its first line ends like that.
  std::string_view line_break() const;
};

// The layout of a text, which must outlive it. Fails like parse_document(); messages call the text
// `name`.
core::Result<TextLayout> lay_out(std::string_view text, std::string_view name);

}  // namespace psygen::world
