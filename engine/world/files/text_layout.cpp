#include "engine/world/files/text_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "engine/world/files/document.hpp"

namespace psygen::world {
namespace {

constexpr std::string_view kMark = "\xEF\xBB\xBF";  // byte order mark

// The key that a quoted key with escapes denotes.
std::string unescaped(std::string_view quoted) {
  const auto parsed = parse_document("k = " + std::string(quoted), "key");
  return parsed && !parsed->members.empty() ? parsed->members.front().value.text : std::string();
}

class LayoutScanner {
 public:
  explicit LayoutScanner(TextLayout& layout) : layout_(layout), text_(layout.text) {
    at_ = layout.begin();
  }

  // Returns false for a text that a parser would not accept.
  bool run() {
    while (ok_ && at_ < text_.size()) {
      const std::size_t line = at_;
      skip_blanks();
      if (now() == '[') {
        take_header(line);
      } else if (now() != '#' && now() != '\n' && now() != '\r' && now() != '\0') {
        take_statement(line);
      }
      skip_line();
    }
    return ok_;
  }

 private:
  char now(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  void skip_blanks() {
    while (now() == ' ' || now() == '\t')
      ++at_;
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_++] != '\n') {
    }
  }
  // Blanks, comments and line breaks between the values of an array.
  void skip_space() {
    while (at_ < text_.size()) {
      if (now() == '#') {
        skip_line();
      } else if (now() == ' ' || now() == '\t' || now() == '\n' || now() == '\r') {
        ++at_;
      } else {
        return;
      }
    }
  }
  // The end of the line with at_, after its line break.
  std::size_t line_end() const {
    const std::size_t end = text_.find('\n', at_);
    return end == std::string_view::npos ? text_.size() : end + 1;
  }

  void skip_string() {
    const char quote = now();
    for (++at_; at_ < text_.size() && now() != quote && now() != '\n'; ++at_) {
      if (now() == '\\' && quote == '"') ++at_;
    }
    ok_ = ok_ && now() == quote;
    ++at_;
  }

  std::string take_key_part() {
    const std::size_t begin = at_;
    if (now() == '"' || now() == '\'') {
      skip_string();
      if (!ok_) return {};
      const std::string_view quoted = text_.substr(begin, at_ - begin);
      if (quoted.front() == '"' && quoted.find('\\') != std::string_view::npos)
        return unescaped(quoted);
      return std::string(quoted.substr(1, quoted.size() - 2));
    }
    while (at_ < text_.size() &&
           std::string_view(" \t.=]\r\n#").find(now()) == std::string_view::npos)
      ++at_;
    ok_ = ok_ && at_ > begin;
    return std::string(text_.substr(begin, at_ - begin));
  }

  std::vector<std::string> take_key() {
    std::vector<std::string> parts;
    do {
      if (!parts.empty()) ++at_;
      skip_blanks();
      parts.push_back(take_key_part());
      skip_blanks();
    } while (ok_ && now() == '.');
    return parts;
  }

  // The path of a header's key, through the newest items of arrays.
  TextPath path_of(const std::vector<std::string>& parts, bool is_item) {
    TextPath path;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      path.steps.emplace_back(parts[i]);
      const std::string name = path.text();
      const auto known = items_.find(name);
      if (i + 1 == parts.size() && is_item) {
        path.steps.emplace_back(items_[name]++);
      } else if (known != items_.end()) {
        path.steps.emplace_back(known->second - 1);
      }
    }
    return path;
  }

  void take_header(std::size_t line) {
    TextPlace place;
    place.value.begin = at_;
    const bool is_item = now(1) == '[';
    at_ += is_item ? 2 : 1;
    place.path = table_ = path_of(take_key(), is_item);
    place.kind = is_item ? TextPlace::Kind::kItem : TextPlace::Kind::kTable;
    ok_ = ok_ && now() == ']' && (!is_item || now(1) == ']');
    at_ += is_item ? 2 : 1;
    place.value.end = std::min(at_, text_.size());
    place.lines = {line, line_end()};
    layout_.places.push_back(std::move(place));
  }

  void take_statement(std::size_t line) {
    const std::size_t index = take_member(table_, false);
    if (ok_) layout_.places[index].lines = {line, line_end()};
  }

  // Reads "key = value" from at_ on, within `table`. Returns the index of its place.
  std::size_t take_member(const TextPath& table, bool nested) {
    const std::size_t begin = at_;
    TextPath path = table;
    const std::vector<std::string> key = take_key();
    for (const std::string& part : key)
      path.steps.emplace_back(part);
    ok_ = ok_ && now() == '=';
    ++at_;
    skip_blanks();
    return take_value(std::move(path), begin, nested, key.size());
  }

  std::size_t take_value(TextPath path, std::size_t begin, bool nested, std::size_t key_parts) {
    const std::size_t index = layout_.places.size();
    const std::size_t value = at_;
    layout_.places.push_back({TextPlace::Kind::kValue, path, {}, {}, nested, key_parts});
    if (++depth_ > kMaxNesting + 1) ok_ = false;
    if (now() == '"' || now() == '\'') {
      skip_string();
    } else if (now() == '[') {
      take_items(path);
    } else if (now() == '{') {
      take_members(path);
    } else {
      skip_plain();
    }
    --depth_;
    ok_ = ok_ && at_ > value && at_ <= text_.size();
    layout_.places[index].value = {value, at_};
    layout_.places[index].lines = {begin, at_};
    return index;
  }

  void take_items(const TextPath& array) {
    ++at_;
    skip_space();
    for (std::size_t i = 0; ok_ && now() != ']'; ++i) {
      take_value(array.with(i), at_, true, 0);
      skip_space();
      if (now() == ',') {
        ++at_;
        skip_space();
      } else {
        ok_ = ok_ && now() == ']';
      }
    }
    ++at_;
  }

  void take_members(const TextPath& table) {
    ++at_;
    skip_blanks();
    while (ok_ && now() != '}') {
      take_member(table, true);
      skip_blanks();
      if (now() == ',') {
        ++at_;
        skip_blanks();
      } else {
        ok_ = ok_ && now() == '}';
      }
    }
    ++at_;
  }

  // A number, a boolean, or a date, which may have a blank before its time.
  void skip_plain() {
    constexpr std::size_t kDate = std::string_view("1979-05-27").size();
    const std::size_t begin = at_;
    const auto skip = [this] {
      while (at_ < text_.size() &&
             std::string_view(" \t\r\n,]}#").find(now()) == std::string_view::npos)
        ++at_;
    };
    skip();
    const bool is_date = at_ - begin == kDate && text_[begin + 4] == '-';
    if (!is_date || now() != ' ' || now(1) < '0' || now(1) > '9') return;
    ++at_;
    skip();
  }

  TextLayout& layout_;
  std::string_view text_;
  std::size_t at_ = 0;
  TextPath table_;                            // path of the header above
  std::map<std::string, std::size_t> items_;  // number of [[headers]] so far, by path
  int depth_ = 0;
  bool ok_ = true;
};

// The line above `line_begin`, without its line break. Nothing at the start of the text.
std::optional<TextSpan> line_above(std::string_view text, std::size_t line_begin) {
  if (line_begin == 0) return {};
  const std::size_t end = line_begin - 1;
  const std::size_t before = end == 0 ? std::string_view::npos : text.rfind('\n', end - 1);
  return TextSpan{before == std::string_view::npos ? 0 : before + 1, end};
}

constexpr std::string_view kSections[] = {"format", "world",   "terrain", "erosion",
                                          "rivers", "species", "model",   "scatter",
                                          "sky",    "water",   "palette"};
constexpr std::string_view kSpeciesParts[] = {"kind", "rule", "foliage", "colours"};

// The position of a table in the usual order; unknown ones come last.
std::ptrdiff_t order_of(const TextPath& within, const TextStep& step) {
  const std::span<const std::string_view> order =
      within.empty() ? std::span<const std::string_view>(kSections) : kSpeciesParts;
  return std::ranges::find(order, step.key) - order.begin();
}

}  // namespace

std::size_t TextLayout::begin() const {
  return text.starts_with(kMark) ? kMark.size() : 0;
}

const TextPlace* TextLayout::find(const TextPath& path) const {
  const auto at = std::ranges::find(places, path, &TextPlace::path);
  return at == places.end() ? nullptr : &*at;
}

std::size_t TextLayout::start_of(const TextPlace& header) const {
  std::size_t start = header.lines.begin;
  while (const auto above = line_above(text, start)) {
    const std::string_view line = text.substr(above->begin, above->end - above->begin);
    const std::size_t first = line.find_first_not_of(" \t");
    if (above->begin < begin() || first == std::string_view::npos || line[first] != '#') break;
    start = above->begin;
  }
  return start <= begin() ? header.lines.begin : start;
}

std::size_t TextLayout::next_header(const TextPlace* place) const {
  const auto from = places.begin() + (place == nullptr ? 0 : place - places.data() + 1);
  return static_cast<std::size_t>(
      std::find_if(from, places.end(), std::mem_fn(&TextPlace::is_header)) - places.begin());
}

std::size_t TextLayout::item_count(const TextPath& array) const {
  return static_cast<std::size_t>(std::ranges::count_if(places, [&](const TextPlace& place) {
    return place.path.size() == array.size() + 1 && place.path.back().is_index &&
           place.path.starts_with(array);
  }));
}

std::string_view TextLayout::line_break() const {
  const std::size_t end = text.find('\n');
  return end != std::string_view::npos && end > 0 && text[end - 1] == '\r' ? "\r\n" : "\n";
}

core::Result<TextLayout> lay_out(std::string_view text, std::string_view name) {
  if (auto parsed = parse_document(text, name); !parsed)
    return tl::unexpected(std::move(parsed.error()));
  TextLayout layout{text, {}};
  if (!LayoutScanner(layout).run())
    return core::fail(core::ErrorCode::kInternal,
                      std::string(name) + ": this text cannot be edited piece by piece");
  return layout;
}

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
