#include "engine/world/files/text_edit.hpp"

#include <fmt/format.h>

#include <vector>

#include "engine/world/files/document.hpp"
#include "engine/world/files/text_layout.hpp"

namespace psygen::world {
namespace {

// Fails if this text is not exactly one value.
core::Result<void> check_value(const TextPath& path, std::string_view value) {
  const std::string line = fmt::format("v = {}", value);
  const auto layout = lay_out(line, "value");
  if (layout && layout->places.front().path == TextPath{"v"} &&
      layout->places.front().value.begin + value.size() == layout->places.front().value.end)
    return {};
  return refuse_edit(path, layout ? "the new value must be a single value, without blanks or "
                                    "comments around it"
                                  : layout.error().message);
}

std::string with_span(std::string_view text, TextSpan span, std::string_view content) {
  std::string out(text.substr(0, span.begin));
  out += content;
  out += text.substr(span.end);
  return out;
}

// The text with "key = value" in an inline table, which starts at "{".
std::string with_member(const TextLayout& layout, const TextPlace& table, std::string_view member) {
  const std::string_view text = layout.text;
  std::size_t at = table.value.end - 1;
  while (text[at - 1] == ' ' || text[at - 1] == '\t')
    --at;
  const bool empty = text[at - 1] == '{';
  return with_span(text, {at, at},
                   fmt::format("{}{}{}", empty ? " " : ", ", member,
                               at + 1 == table.value.end && empty ? " " : ""));
}

// The text with one more item in an array, except an array of tables with headers.
std::string with_item(const TextLayout& layout, const TextPlace& array, std::string_view value) {
  std::size_t at = array.value.begin + 1;
  for (const TextPlace& place : layout.places) {
    if (place.path.size() == array.path.size() + 1 && place.path.starts_with(array.path))
      at = place.value.end;
  }
  const bool empty = at == array.value.begin + 1;
  return with_span(layout.text, {at, at}, fmt::format("{}{}", empty ? "" : ", ", value));
}

// The text with a new line after `lines`, indented like them.
std::string with_line_behind(const TextLayout& layout, TextSpan lines, std::string_view line) {
  const std::string_view end = layout.line_break();
  const bool cut = lines.end > 0 && layout.text[lines.end - 1] != '\n';
  return with_span(
      layout.text, {lines.end, lines.end},
      fmt::format("{}{}{}{}", cut ? end : "", indent_at(layout.text, lines.begin), line, end));
}

// Adds a key to an existing table: one with a header, or the root (null).
std::string with_statement(const TextLayout& layout, const TextPlace* header,
                           std::string_view line) {
  for (std::size_t i = layout.next_header(header); i-- > 0 && &layout.places[i] != header;) {
    if (!layout.places[i].nested) return with_line_behind(layout, layout.places[i].lines, line);
  }
  if (header != nullptr) return with_line_behind(layout, header->lines, line);
  return with_span(layout.text, {layout.begin(), layout.begin()},
                   fmt::format("{}{}", line, layout.line_break()));
}

// Adds a key to a table that exists only by dotted keys ("a.b = 1"). Returns nothing if it has
// none.
std::optional<std::string> with_dotted_key(const TextLayout& layout, const TextPath& path,
                                           std::string_view value) {
  const TextPath table = path.parent();
  for (std::size_t i = layout.places.size(); i-- > 0;) {
    const TextPlace& place = layout.places[i];
    const std::size_t base = place.path.size() - place.key_parts;
    if (place.is_header() || place.key_parts < 2 || !place.path.starts_with(table) ||
        base >= table.size())
      continue;
    std::string key;
    for (std::size_t k = base; k < path.size(); ++k)
      key += (k == base ? "" : ".") + toml_key(path.steps[k].key);
    const std::string member = fmt::format("{} = {}", key, value);
    if (!place.nested) return with_line_behind(layout, place.lines, member);
    return with_span(layout.text, {place.lines.end, place.lines.end}, ", " + member);
  }
  return {};
}

core::Result<std::string> with_new_value(const TextLayout& layout, const TextPath& path,
                                         std::string_view value) {
  const TextPath parent = path.parent();
  const TextPlace* at = layout.find(parent);
  if (path.back().is_index) {
    if (at == nullptr || layout.text[at->value.begin] != '[' || at->is_header() ||
        path.back().index != layout.item_count(parent))
      return refuse_edit(path, fmt::format("there are only {} items", layout.item_count(parent)));
    return with_item(layout, *at, value);
  }
  const std::string member = fmt::format("{} = {}", toml_key(path.back().key), value);
  if (parent.empty()) return with_statement(layout, nullptr, member);
  if (at != nullptr) {
    if (at->is_header()) return with_statement(layout, at, member);
    if (layout.text[at->value.begin] == '{') return with_member(layout, *at, member);
    return refuse_edit(parent, "this is not a table");
  }
  if (auto dotted = with_dotted_key(layout, path, value)) return *std::move(dotted);
  if (parent.back().is_index)
    return refuse_edit(parent,
                       fmt::format("there are only {} items", layout.item_count(parent.parent())));
  // A missing table becomes an inline table inside an inline table, else it gets a header.
  if (parent.size() > 1) {
    const TextPlace* within = layout.find(parent.parent());
    if (within != nullptr && !within->is_header())
      return with_new_value(layout, parent, fmt::format("{{ {} }}", member));
  }
  if (layout.item_count(parent) > 0) return refuse_edit(parent, "this is an array");
  const std::string header = header_line(layout, parent, false);
  const std::string_view indent = indent_at(header, 0);
  return with_table_at(layout, place_of_new_table(layout, parent),
                       fmt::format("{}{}{}{}", header, indent, member, layout.line_break()));
}

// The text without a member of an inline table or an item of an array, and without one comma next
// to it.
std::string without_nested(std::string_view text, TextSpan span) {
  const auto is_blank = [&](std::size_t i) { return text[i] == ' ' || text[i] == '\t'; };
  std::size_t behind = span.end;
  while (is_blank(behind))
    ++behind;
  std::size_t before = span.begin;
  while (is_blank(before - 1))
    --before;
  if (text[behind] == ',') {
    ++behind;
    while (is_blank(behind))
      ++behind;
    return with_span(text, {span.begin, behind}, "");
  }
  if (text[before - 1] == ',') return with_span(text, {before - 1, span.end}, "");
  return with_span(text, span, "");
}

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

core::Result<std::string> with_value(std::string_view text, const TextPath& path,
                                     std::string_view toml_value) {
  if (path.empty()) return refuse_edit(path, "a value needs a key");
  if (auto checked = check_value(path, toml_value); !checked)
    return tl::unexpected(std::move(checked.error()));
  const auto layout = lay_out_edited(text);
  if (!layout) return tl::unexpected(layout.error());
  core::Result<std::string> changed;
  if (const TextPlace* at = layout->find(path)) {
    if (at->is_header()) return refuse_edit(path, "this is a table with a header, not a value");
    changed = with_span(text, at->value, toml_value);
  } else {
    changed = with_new_value(*layout, path, toml_value);
  }
  if (!changed) return changed;
  const auto after = lay_out_edited(*changed);
  if (!after) return checked_edit(*std::move(changed), path);
  const TextPlace* at = after->find(path);
  if (at == nullptr || after->value_of(*at) != toml_value)
    return refuse_edit(path, "no value can be written here");
  return changed;
}

core::Result<std::string> with_each_value(std::string_view text,
                                          const std::function<bool(const TextPath&)>& which,
                                          std::string_view toml_value) {
  if (auto checked = check_value({}, toml_value); !checked)
    return tl::unexpected(std::move(checked.error()));
  const auto layout = lay_out_edited(text);
  if (!layout) return tl::unexpected(layout.error());
  std::string out;
  std::size_t copied = 0;
  TextPath last;
  for (const TextPlace& place : layout->places) {
    if (place.is_header() || place.value.begin < copied || !which(place.path)) continue;
    out += text.substr(copied, place.value.begin - copied);
    out += toml_value;
    copied = place.value.end;
    last = place.path;
  }
  out += text.substr(copied);
  return checked_edit(std::move(out), last);
}

core::Result<std::string> without_value(std::string_view text, const TextPath& path) {
  const auto layout = lay_out_edited(text);
  if (!layout) return tl::unexpected(layout.error());
  const TextPlace* at = layout->find(path);
  if (at == nullptr) return std::string(text);
  if (at->is_header()) return refuse_edit(path, "this is a table with a header, not a value");
  return checked_edit(at->nested ? without_nested(text, at->lines) : with_span(text, at->lines, ""),
                      path);
}

std::optional<std::string> value_text(std::string_view text, const TextPath& path) {
  const auto layout = lay_out_edited(text);
  const TextPlace* at = layout ? layout->find(path) : nullptr;
  if (at == nullptr || at->is_header()) return {};
  return std::string(layout->value_of(*at));
}

std::size_t item_count(std::string_view text, const TextPath& path) {
  const auto layout = lay_out_edited(text);
  return layout ? layout->item_count(path) : 0;
}

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
