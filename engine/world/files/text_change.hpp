// Helpers of text_edit.cpp and text_tables.cpp: checks of their inputs and outputs, and positions
// for new tables. Internal to world. Pure, any thread.
#pragma once

#include <string>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/world/files/text_layout.hpp"

namespace psygen::world {

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
