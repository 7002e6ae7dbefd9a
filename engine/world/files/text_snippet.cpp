#include "engine/world/files/text_snippet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/world/files/document.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/text_layout.hpp"

namespace psygen::world {
namespace {

constexpr std::string_view kSnippet = "the pasted text";

std::string named(const TextPath& keys) {
  return keys.empty() ? "keys without a table" : fmt::format("[{}]", keys.text());
}

// Maps a path in the snippet, whose table has `depth` steps, to the path in the text.
TextPath moved_path(const TextPath& to, const TextPath& from, std::size_t depth) {
  TextPath path = to;
  path.steps.insert(path.steps.end(),
                    std::next(from.steps.begin(), static_cast<std::ptrdiff_t>(depth)),
                    from.steps.end());
  return path;
}

// Removes, item by item, the arrays of tables that the snippet replaces.
core::Result<std::string> without_replaced(std::string text, const TextPath& path,
                                           const TextLayout& snippet, std::size_t depth) {
  for (const TextPlace& place : snippet.places) {
    if (place.kind != TextPlace::Kind::kItem || place.path.size() != depth + 2 ||
        place.path.back().index != 0)
      continue;
    const TextPath array = moved_path(path, place.path.parent(), depth);
    for (std::size_t count = item_count(text, array); count > 0; --count) {
      auto changed = without_table(text, array.with(count - 1));
      if (!changed) return changed;
      text = *std::move(changed);
    }
  }
  return text;
}

}  // namespace

core::Result<TextPath> snippet_table(std::string_view snippet) {
  const auto layout = lay_out(snippet, kSnippet);
  if (!layout) return tl::unexpected(layout.error());
  if (layout->places.empty() || !layout->places.front().is_header()) return TextPath{};
  return layout->places.front().path.keys();
}

core::Result<std::string> copied_snippet(std::string_view text, const TextPath& path) {
  const auto layout = lay_out_edited(text);
  if (!layout) return tl::unexpected(layout.error());
  if (auto table = table_text(text, path)) return *std::move(table);
  const auto value = value_text(text, path);
  if (!value || path.back().is_index)
    return refuse_edit(path, "the text does not set this, so it cannot be copied");
  const std::string line = fmt::format("{} = {}\n", toml_key(path.back().key), *value);
  if (path.size() == 1) return line;
  return header_line(TextLayout{}, path.parent(), path.parent().back().is_index) + line;
}

core::Result<std::string> with_snippet(std::string_view text, const TextPath& path,
                                       std::string_view snippet) {
  const auto layout = lay_out(snippet, kSnippet);
  if (!layout) return tl::unexpected(layout.error());
  const bool bare = layout->places.empty() || !layout->places.front().is_header();
  const TextPath base = bare ? TextPath{} : layout->places.front().path;
  if (!bare && base.keys() != path.keys())
    return refuse_edit(path,
                       fmt::format("the pasted text belongs to {}, which does not fit into {}",
                                   named(base.keys()), named(path.keys())));
  auto changed = without_replaced(std::string(text), path, *layout, base.size());
  for (std::size_t i = 0; changed && i < layout->places.size(); ++i) {
    const TextPlace& place = layout->places[i];
    if (!place.path.starts_with(base))
      return refuse_edit(path, "the pasted text has more than one table");
    if (place.nested) continue;
    const TextPath to = moved_path(path, place.path, base.size());
    if (!place.is_header()) {
      changed = with_value(*changed, to, layout->value_of(place));
    } else if (place.kind == TextPlace::Kind::kItem && place.path.size() > base.size()) {
      changed = with_table_appended(*changed, to.parent(), "");
    }
  }
  return changed;
}

std::string preset_text(std::string_view snippet) {
  return fmt::format("# A preset of psygen: a part of a world file.\npartial = {}\n\n{}",
                     kPresetFormat, snippet);
}

core::Result<std::string> read_preset(std::string_view text, std::string_view file_name) {
  const auto layout = lay_out(text, file_name);
  if (!layout) return tl::unexpected(layout.error());
  const auto refuse = [&](std::string_view sentence) {
    return core::fail(core::ErrorCode::kParse, fmt::format("{}: {}", file_name, sentence));
  };
  const std::string version = value_text(text, {"partial"}).value_or("");
  if (version.empty()) return refuse("partial: this field is missing; the file is not a preset");
  if (version != fmt::format("{}", kPresetFormat))
    return refuse(
        fmt::format("partial: this program does not know version {} of presets; "
                    "allowed: {}",
                    version, kPresetFormat));
  const std::size_t first = layout->next_header(nullptr);
  if (first != 1 || first == layout->places.size())
    return refuse("a preset must have the line partial and one table");
  return std::string(text.substr(layout->start_of(layout->places[first])));
}

}  // namespace psygen::world
