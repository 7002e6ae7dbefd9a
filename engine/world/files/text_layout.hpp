// The positions of tables and values in a TOML text, in bytes, so that an edit can change one of
// them and keep the rest. Not a parser: the text must pass parse_document(). Internal to world.
// Plain values, any thread; layout and find() are linear in the text.
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
  TextSpan value;  // the value; for a header from "[" to "]"
  // Whole lines of the statement or header, with the line break. For a nested value, from its key
  // to its end.
  TextSpan lines;
  bool nested = false;        // in an inline table or an array
  std::size_t key_parts = 1;  // parts of a statement's key: 2 in "a.b = 1"
  bool is_header() const { return kind != Kind::kValue; }
};

// A text and its places, in the order of the text.
struct TextLayout {
  std::string_view text;
  std::vector<TextPlace> places;

  std::size_t begin() const;  // after a byte order mark
  // The place with this path, or null; and the text of a place's value.
  const TextPlace* find(const TextPath& path) const;
  std::string_view value_of(const TextPlace& place) const {
    return text.substr(place.value.begin, place.value.end - place.value.begin);
  }
  // The start of a header with the comment lines directly above it, unless these begin the file.
  std::size_t start_of(const TextPlace& header) const;
  // The index of the first header after a place (null: of all headers), or places.size().
  std::size_t next_header(const TextPlace* place) const;
  // The number of items of an array, of tables or inline; 0 if there is no such array.
  std::size_t item_count(const TextPath& array) const;
  // The line break of the text: "\r\n" if its first line ends with it.
  std::string_view line_break() const;
};

// The layout of a text, which must outlive it. Fails like parse_document(); messages call the text
// `name`.
core::Result<TextLayout> lay_out(std::string_view text, std::string_view name);

}  // namespace psygen::world
