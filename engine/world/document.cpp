#include "engine/world/document.hpp"

#include <fmt/format.h>

#include <utility>

#define TOML_EXCEPTIONS 0
#define TOML_HEADER_ONLY 1
#define TOML_ENABLE_FORMATTERS 0
#define TOML_MAX_NESTED_VALUES 16
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <toml++/impl/preprocessor.h>
// Version 3.3 assumes that a key follows "[", checked or not, and has a proper error for what else
// may stand there a few lines further down: without the assumption all is well.
#undef TOML_ASSERT_ASSUME
#define TOML_ASSERT_ASSUME(condition) static_assert(true)
#include <toml++/toml.h>
#pragma GCC diagnostic pop

namespace psygen::world {
namespace {

static_assert(kMaxNesting == TOML_MAX_NESTED_VALUES);

core::Error error_at(std::string_view file, std::size_t line, std::string_view sentence) {
  return {core::ErrorCode::kParse, fmt::format("{}:{}: {}", file, line, sentence)};
}

// The end of the string that begins at `i`, on the same line; the end of the line if it is open.
std::size_t skip_string(std::string_view text, std::size_t i) {
  const char quote = text[i++];
  while (i < text.size() && text[i] != quote && text[i] != '\n') {
    if (text[i] == '\\' && quote == '"' && i + 1 < text.size() && text[i + 1] != '\n') ++i;
    ++i;
  }
  return i;
}

// The parser limits nested values, but not the parts of a dotted key, each of which is a table:
// long ones would exhaust the stack. Strings over several lines are refused so that this scan knows
// what is a string.
core::Result<void> check_keys(std::string_view text, std::string_view file) {
  std::size_t line = 1;
  int dots = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      ++line;
      dots = 0;
    } else if (c == '#') {
      while (i + 1 < text.size() && text[i + 1] != '\n')
        ++i;
    } else if (c == '"' || c == '\'') {
      if (text.substr(i, 3) == std::string(3, c))
        return tl::unexpected(error_at(file, line, "strings over several lines are not allowed"));
      i = skip_string(text, i);
      if (i < text.size() && text[i] == '\n') --i;
    } else if (c == '.') {
      if (++dots >= kMaxNesting)
        return tl::unexpected(error_at(
            file, line, fmt::format("a key may have at most {} dotted parts", kMaxNesting)));
    } else if (std::string_view("=,[]{}").find(c) != std::string_view::npos) {
      dots = 0;
    }
  }
  return {};
}

int line_of(const toml::source_region& source) {
  return static_cast<int>(source.begin.line);
}

Node convert(const toml::node& from);

void convert_table(const toml::table& from, Node& to) {
  to.kind = Node::Kind::kTable;
  for (auto&& [key, value] : from)
    to.members.push_back({std::string(key.str()), line_of(key.source()), convert(value)});
}

Node convert(const toml::node& from) {
  Node to;
  to.line = line_of(from.source());
  if (const auto* table = from.as_table()) {
    convert_table(*table, to);
  } else if (const auto* array = from.as_array()) {
    to.kind = Node::Kind::kArray;
    for (const toml::node& item : *array)
      to.items.push_back(convert(item));
  } else if (const auto* integer = from.as_integer()) {
    to.kind = Node::Kind::kInteger;
    to.integer = integer->get();
    to.real = static_cast<double>(to.integer);
  } else if (const auto* real = from.as_floating_point()) {
    to.kind = Node::Kind::kReal;
    to.real = real->get();
  } else if (const auto* text = from.as_string()) {
    to.kind = Node::Kind::kText;
    to.text = text->get();
  } else if (const auto* boolean = from.as_boolean()) {
    to.kind = Node::Kind::kBoolean;
    to.boolean = boolean->get();
  } else {
    to.kind = Node::Kind::kTime;
  }
  return to;
}

// Only what any terminal shows; the text may be a binary file.
std::string printable(std::string_view text) {
  std::string shown(text);
  for (char& c : shown) {
    if (c < ' ' || c > '~') c = '?';
  }
  return shown;
}

}  // namespace

core::Result<Node> parse_document(std::string_view text, std::string_view file_name) {
  if (auto checked = check_keys(text, file_name); !checked)
    return tl::unexpected(std::move(checked.error()));
  const toml::parse_result parsed = toml::parse(text, file_name);
  if (!parsed) {
    const toml::parse_error& error = parsed.error();
    return tl::unexpected(
        error_at(file_name, error.source().begin.line,
                 fmt::format("this is not valid TOML: {}", printable(error.description()))));
  }
  Node root;
  convert_table(parsed.table(), root);
  return root;
}

std::string_view kind_name(Node::Kind kind) {
  switch (kind) {
    case Node::Kind::kInteger:
      return "an integer";
    case Node::Kind::kReal:
      return "a number";
    case Node::Kind::kText:
      return "a string";
    case Node::Kind::kBoolean:
      return "a boolean";
    case Node::Kind::kTime:
      return "a date or time";
    case Node::Kind::kArray:
      return "an array";
    case Node::Kind::kTable:
      return "a table";
  }
  return "a value";
}

}  // namespace psygen::world
