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

// Helpers of text_edit.cpp:

// The name of the text in messages.
inline constexpr std::string_view kEditedText = "the text";

// The layout of the text to edit.
core::Result<TextLayout> lay_out_edited(std::string_view text);
// kInvalidArgument: "scatter[2].branches: SENTENCE".
tl::unexpected<core::Error> refuse_edit(const TextPath& path, std::string_view sentence);
// The text if it parses, else kInternal.
core::Result<std::string> checked_edit(std::string text, const TextPath& path);
// The offset for a new table with this path: before the first header of a later section, or at the
// end of its parent table.
std::size_t place_of_new_table(const TextLayout& layout, const TextPath& path);
// The text with a table at `at`, the start of a line, and a blank line before and after it.
std::string with_table_at(const TextLayout& layout, std::size_t at, std::string table);
// The blanks at the start of a line.
std::string_view indent_at(std::string_view text, std::size_t line_begin);
// "[a.b]" or "[[a.b]]", with the indentation of its siblings.
std::string header_line(const TextLayout& layout, const TextPath& path, bool is_item);
// The text with each "\n" as the line break of the layout.
std::string with_breaks(const TextLayout& layout, std::string_view text);

}  // namespace psygen::world
