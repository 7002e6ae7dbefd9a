// The path of a value in a TOML text: scatter[2].branches. It addresses text edits (text_edit.hpp)
// and an editor's controls; it knows no text. Plain value, any thread.
#pragma once

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace psygen::world {

// One step of a path: a key of a table, or an index of an array.
struct TextStep {
  std::string key;  // empty for an index
  std::size_t index = 0;
  bool is_index = false;

  // A key.
  TextStep(std::string name) : key(std::move(name)) {}
  TextStep(std::string_view name) : key(name) {}
  TextStep(const char* name) : key(name) {}
  // An index, from 0.
  template <std::integral I>
  TextStep(I i) : index(static_cast<std::size_t>(i)), is_index(true) {}
  friend bool operator==(const TextStep&, const TextStep&) = default;
};

// The steps from the root of the text: TextPath{"scatter", 2, "branches"}. Empty: the root.
struct TextPath {
  std::vector<TextStep> steps;

  TextPath() = default;
  TextPath(std::initializer_list<TextStep> list) : steps(list) {}
  // Number of steps.
  std::size_t size() const { return steps.size(); }
  bool empty() const { return steps.empty(); }
  const TextStep& back() const { return steps.back(); }
  // The first `count` steps, count <= size(); and all but the last step. parent() requires
  // !empty().
  TextPath first(std::size_t count) const;
  TextPath parent() const { return first(size() - 1); }
  // This path with one more step.
  TextPath with(TextStep step) const;
  // The path without indices, as headers write it.
  TextPath keys() const;
  // True if `start` is this path or the beginning of it.
  bool starts_with(const TextPath& start) const;
  // The path as messages write it: "scatter[2].branches". Keys that are not bare are in quotes.
  std::string text() const;
  friend bool operator==(const TextPath&, const TextPath&) = default;
};

// A key as TOML writes it: bare if allowed, else in quotes.
std::string toml_key(std::string_view key);

// Parses the result of text(), for paths with bare keys only. Returns nothing for other texts.
std::optional<TextPath> parse_text_path(std::string_view text);

}  // namespace psygen::world
