// Edits of tables with headers. Edits of single values are in text_edit.cpp.
#include <fmt/format.h>

#include <vector>

#include "engine/world/files/document.hpp"
#include "engine/world/files/text_change.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/text_layout.hpp"

namespace psygen::world {
namespace {

// The parts of the text that belong to a table and the tables in it, with the comments above their
// headers and the blank lines after them. Usually there is one part.
std::vector<TextSpan> parts_of(const TextLayout& layout, const TextPath& table) {
  std::vector<TextSpan> parts;
  for (std::size_t i = layout.next_header(nullptr); i < layout.places.size();) {
    const TextPlace& header = layout.places[i];
    const std::size_t next = layout.next_header(&header);
    const std::size_t end =
        next < layout.places.size() ? layout.start_of(layout.places[next]) : layout.text.size();
    if (header.path.starts_with(table)) {
      const std::size_t begin = layout.start_of(header);
      if (!parts.empty() && parts.back().end == begin)
        parts.back().end = end;
      else
        parts.push_back({begin, end});
    }
    i = next;
  }
  return parts;
}

// The table without blank lines at its end, and with one line break there.
std::string trimmed_table(std::string_view text, std::string_view line_break) {
  const std::size_t last = text.find_last_not_of(" \t\r\n");
  return last == std::string_view::npos ? std::string()
                                        : std::string(text.substr(0, last + 1)).append(line_break);
}

std::string joined(const TextLayout& layout, const std::vector<TextSpan>& parts) {
  std::string out;
  for (const TextSpan part : parts)
    out += layout.text.substr(part.begin, part.end - part.begin);
  return trimmed_table(out, layout.line_break());
}

std::string without_parts(std::string_view text, const std::vector<TextSpan>& parts) {
  std::string out;
  std::size_t from = 0;
  for (const TextSpan part : parts) {
    out += text.substr(from, part.begin - from);
    from = part.end;
  }
  out += text.substr(from);
  return out;
}

// True if the text is one whole table with headers of this array.
bool has_headers_of(const TextLayout& table, const TextPath& array) {
  if (table.places.empty() || !table.places.front().is_header()) return false;
  const TextPath keys = array.keys();
  std::size_t items = 0;
  for (const TextPlace& place : table.places) {
    const TextPath of_place = place.path.keys();
    if (!of_place.starts_with(keys)) return false;
    if (place.is_header() && of_place.size() == keys.size()) ++items;
  }
  return items == 1;
}

core::Result<void> require_item(const TextLayout& layout, const TextPath& path) {
  const TextPlace* at = path.empty() ? nullptr : layout.find(path);
  if (at != nullptr && at->kind == TextPlace::Kind::kItem) return {};
  return refuse_edit(path, "there is no such table with a header in the text");
}

// The offset for a new item with this index: before the item that has the index, or after the last.
std::size_t place_of_item(const TextLayout& layout, const TextPath& array, std::size_t index) {
  if (const TextPlace* at = layout.find(array.with(index))) return layout.start_of(*at);
  if (index > 0) {
    const std::vector<TextSpan> parts = parts_of(layout, array.with(index - 1));
    if (!parts.empty()) return parts.back().end;
  }
  return place_of_new_table(layout, array);
}

}  // namespace

core::Result<std::string> with_table_appended(std::string_view text, const TextPath& array,
                                              std::string_view table) {
  if (array.empty() || array.back().is_index)
    return refuse_edit(array, "tables can be added to an array only");
  const auto layout = lay_out_edited(text);
  if (!layout) return tl::unexpected(layout.error());
  const auto added = lay_out(table, "the table");
  if (!added) return tl::unexpected(added.error());
  const bool whole = has_headers_of(*added, array);
  if (!whole && added->next_header(nullptr) < added->places.size())
    return refuse_edit(array, "the table to add must be one table of this array");
  const std::size_t count = layout->item_count(array);
  const TextPlace* there = layout->find(array);
  if (count == 0 && there != nullptr && there->is_header())
    return refuse_edit(array, "this is a table, not an array of tables");
  const std::string item =
      (whole ? "" : header_line(*layout, array, true)) + with_breaks(*layout, table);
  auto changed = checked_edit(with_table_at(*layout, place_of_item(*layout, array, count),
                                            trimmed_table(item, layout->line_break())),
                              array);
  if (changed && item_count(*changed, array) != count + 1)
    return refuse_edit(array, "no table can be added here");
  return changed;
}

core::Result<std::string> without_table(std::string_view text, const TextPath& path) {
  const auto layout = lay_out_edited(text);
  if (!layout) return tl::unexpected(layout.error());
  if (path.empty()) return refuse_edit(path, "the whole text cannot be removed");
  if (const TextPlace* at = layout->find(path); at != nullptr && !at->is_header())
    return without_value(text, path);
  const std::vector<TextSpan> parts = parts_of(*layout, path);
  if (parts.empty()) return std::string(text);
  const std::string rest = without_parts(text, parts);
  const bool was_last = parts.back().end == text.size();
  return checked_edit(was_last ? trimmed_table(rest, layout->line_break()) : rest, path);
}

core::Result<std::string> with_table_duplicated(std::string_view text, const TextPath& item) {
  const auto layout = lay_out_edited(text);
  if (!layout) return tl::unexpected(layout.error());
  if (auto there = require_item(*layout, item); !there)
    return tl::unexpected(std::move(there.error()));
  const std::vector<TextSpan> parts = parts_of(*layout, item);
  return checked_edit(with_table_at(*layout, parts.back().end, joined(*layout, parts)), item);
}

core::Result<std::string> with_table_moved(std::string_view text, const TextPath& item,
                                           std::size_t to) {
  const auto layout = lay_out_edited(text);
  if (!layout) return tl::unexpected(layout.error());
  if (auto there = require_item(*layout, item); !there)
    return tl::unexpected(std::move(there.error()));
  const TextPath array = item.parent();
  if (to >= layout->item_count(array))
    return refuse_edit(item, fmt::format("there are only {} items", layout->item_count(array)));
  if (to == item.back().index) return std::string(text);
  const std::vector<TextSpan> parts = parts_of(*layout, item);
  const std::string table = joined(*layout, parts);
  const std::string rest = without_parts(text, parts);
  const auto others = lay_out_edited(rest);
  if (!others) return tl::unexpected(others.error());
  return checked_edit(with_table_at(*others, place_of_item(*others, array, to), table), item);
}

std::optional<std::string> table_text(std::string_view text, const TextPath& path) {
  const auto layout = lay_out_edited(text);
  if (!layout) return {};
  const TextPlace* at = path.empty() ? nullptr : layout->find(path);
  if (at == nullptr || !at->is_header()) return {};
  return joined(*layout, parts_of(*layout, path));
}

}  // namespace psygen::world
