#include "engine/world/files/text_change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "engine/world/files/document.hpp"

namespace psygen::world {
namespace {

constexpr std::string_view kSections[] = {"format",  "world", "terrain", "species", "model",
                                          "scatter", "sky",   "water",   "palette"};
constexpr std::string_view kSpeciesParts[] = {"kind", "rule", "foliage", "colours"};

// The position of a table in the usual order; unknown ones come last.
std::ptrdiff_t order_of(const TextPath& within, const TextStep& step) {
  const std::span<const std::string_view> order =
      within.empty() ? std::span<const std::string_view>(kSections) : kSpeciesParts;
  return std::ranges::find(order, step.key) - order.begin();
}

}  // namespace

core::Result<TextLayout> lay_out_edited(std::string_view text) {
  return lay_out(text, kEditedText);
}

tl::unexpected<core::Error> refuse_edit(const TextPath& path, std::string_view sentence) {
  return core::fail(core::ErrorCode::kInvalidArgument,
                    fmt::format("{}: {}", path.text(), sentence));
}

core::Result<std::string> checked_edit(std::string text, const TextPath& path) {
  if (auto parsed = parse_document(text, kEditedText); !parsed)
    return core::fail(core::ErrorCode::kInternal,
                      fmt::format("{}: this edit would break the text ({})", path.text(),
                                  parsed.error().message));
  return text;
}

std::size_t place_of_new_table(const TextLayout& layout, const TextPath& path) {
  TextPath parent = path.parent();
  while (!parent.empty() && layout.find(parent) == nullptr)
    parent = parent.parent();
  const std::ptrdiff_t order = order_of(parent, path.steps[parent.size()]);
  std::size_t i = layout.next_header(parent.empty() ? nullptr : layout.find(parent));
  for (; i < layout.places.size(); i = layout.next_header(&layout.places[i])) {
    const TextPlace& header = layout.places[i];
    if (!header.path.starts_with(parent) ||
        order_of(parent, header.path.steps[parent.size()]) > order)
      return layout.start_of(header);
  }
  return layout.text.size();
}

std::string with_table_at(const TextLayout& layout, std::size_t at, std::string table) {
  const std::string_view text = layout.text, end = layout.line_break();
  std::string out(text.substr(0, at));
  if (at > layout.begin()) {
    if (!out.ends_with('\n')) out += end;
    if (!out.ends_with("\n\n") && !out.ends_with("\n\r\n")) out += end;
  }
  if (!table.ends_with('\n')) table += end;
  out += table;
  if (at < text.size()) {
    if (text[at] != '\n' && text[at] != '\r') out += end;
    out += text.substr(at);
  }
  return out;
}

std::string_view indent_at(std::string_view text, std::size_t line_begin) {
  const std::size_t end = std::min(text.find_first_not_of(" \t", line_begin), text.size());
  return text.substr(line_begin, end - line_begin);
}

std::string header_line(const TextLayout& layout, const TextPath& path, bool is_item) {
  std::string_view indent;
  for (const TextPlace& place : layout.places) {
    if (place.is_header() && place.path.size() > 1 && !path.parent().empty() &&
        place.path.starts_with(path.parent()) && place.path.size() > path.parent().size()) {
      indent = indent_at(layout.text, place.lines.begin);
      break;
    }
  }
  return fmt::format("{}{}{}{}{}", indent, is_item ? "[[" : "[", path.keys().text(),
                     is_item ? "]]" : "]", layout.line_break());
}

std::string with_breaks(const TextLayout& layout, std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n' && (i == 0 || text[i - 1] != '\r'))
      out += layout.line_break();
    else
      out += text[i];
  }
  return out;
}

}  // namespace psygen::world
