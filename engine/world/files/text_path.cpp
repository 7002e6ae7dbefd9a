#include "engine/world/files/text_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <iterator>

#include "engine/world/files/toml_values.hpp"

namespace psygen::world {
namespace {

bool is_bare(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

}  // namespace

TextPath TextPath::first(std::size_t count) const {
  TextPath path;
  path.steps.assign(steps.begin(), std::next(steps.begin(), static_cast<std::ptrdiff_t>(count)));
  return path;
}

TextPath TextPath::with(TextStep step) const {
  TextPath path = *this;
  path.steps.push_back(std::move(step));
  return path;
}

TextPath TextPath::keys() const {
  TextPath path = *this;
  std::erase_if(path.steps, std::mem_fn(&TextStep::is_index));
  return path;
}

bool TextPath::starts_with(const TextPath& start) const {
  return size() >= start.size() &&
         std::ranges::equal(start.steps.begin(), start.steps.end(), steps.begin(),
                            std::next(steps.begin(), static_cast<std::ptrdiff_t>(start.size())));
}

std::string TextPath::text() const {
  std::string out;
  for (const TextStep& step : steps) {
    if (step.is_index) {
      fmt::format_to(std::back_inserter(out), "[{}]", step.index);
    } else {
      if (!out.empty()) out += '.';
      out += toml_key(step.key);
    }
  }
  return out;
}

std::string toml_key(std::string_view key) {
  const bool bare = !key.empty() && std::ranges::all_of(key, is_bare);
  return bare ? std::string(key) : toml_string(key);
}

std::optional<TextPath> parse_text_path(std::string_view text) {
  TextPath path;
  bool first = true;
  while (!text.empty()) {
    if (text.front() == '[') {
      std::size_t index = 0;
      const auto read = std::from_chars(text.data() + 1, text.data() + text.size(), index);
      const std::size_t used = static_cast<std::size_t>(read.ptr - text.data());
      if (first || read.ec != std::errc() || used >= text.size() || text[used] != ']') return {};
      path.steps.emplace_back(index);
      text.remove_prefix(used + 1);
    } else {
      if (!first) {
        if (text.front() != '.') return {};
        text.remove_prefix(1);
      }
      const auto end = std::ranges::find_if_not(text, is_bare);
      const auto used = static_cast<std::size_t>(end - text.begin());
      if (used == 0) return {};
      path.steps.emplace_back(text.substr(0, used));
      text.remove_prefix(used);
    }
    first = false;
  }
  return path;
}

}  // namespace psygen::world
