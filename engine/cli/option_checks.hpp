// Checks that CLI11 applies to the text of an option; the error message becomes the usage error.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/cli/text_values.hpp"
#include "engine/core/nearest_word.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::cli {

// Accepts a text for which `parse` succeeds; `parse` returns a core::Result.
template <class Parse>
CLI::Validator valid_if(Parse parse, const std::string& description) {
  return CLI::Validator(
      [parse](std::string& text) {
        const auto value = parse(text);
        return value ? std::string() : value.error().message;
      },
      description);
}

// Adds an option whose text `parse` converts to `value`. Help shows `form`.
template <class Value, class Parse>
CLI::Option* add_parsed(CLI::App& app, const char* name, Value& value, Parse parse,
                        const char* form, const char* meaning) {
  return app
      .add_option_function<std::string>(
          name, [&value, parse](const std::string& text) { value = *parse(text); }, meaning)
      ->check(valid_if(parse, form));
}

// Accepts a decimal number that spans the whole text, with or without a sign.
template <class Number>
CLI::Validator decimal_between(Number low, Number high, std::string_view kind) {
  return CLI::Validator(
      [low, high, kind](std::string& text) {
        Number value{};
        const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
        const char* const end = text.data() + text.size();
        const auto parsed = std::from_chars(begin, end, value);
        if (parsed.ec == std::errc() && parsed.ptr == end && value >= low && value <= high) {
          text = fmt::format("{}", value);
          return std::string();
        }
        constexpr std::size_t kMaxShownBytes = 60;
        return fmt::format("'{}' is not {} from {} to {}", core::shown(text, kMaxShownBytes), kind,
                           low, high);
      },
      fmt::format("{} to {}", low, high));
}

// Accepts finite numbers from `low` to `high`.
inline CLI::Validator number_between(double low, double high) {
  return decimal_between(low, high, "a number");
}

// For transform(): CLI11 receives the number without leading zeros, which it would read as octal.
inline CLI::Validator integer_between(std::int64_t low, std::int64_t high) {
  return decimal_between(low, high, "a whole number");
}

// Accepts 0, which disables a feature, or a number from `low` to `high`.
inline CLI::Validator zero_or_between(double low, double high) {
  const CLI::Validator zero = number_between(0, 0), other = number_between(low, high);
  return CLI::Validator(
      [zero, other](std::string& text) { return zero(text).empty() ? std::string() : other(text); },
      fmt::format("0, or {} to {}", low, high));
}

// Accepts one of these words, which must outlive the command line. Help shows them as low|high.
inline CLI::Validator one_of(std::vector<std::string_view> words) {
  const std::string shown = fmt::format("{}", fmt::join(words, "|"));
  return CLI::Validator(
      [words = std::move(words)](std::string& text) {
        if (std::ranges::find(words, text) != words.end()) return std::string();
        constexpr std::size_t kMaxShownBytes = 60;
        return fmt::format("'{}' is unknown; allowed are {}{}", core::shown(text, kMaxShownBytes),
                           fmt::join(words, ", "), core::suggestion(text, words));
      },
      shown);
}

// For an option parsed by parse_bytes(); bounds in whole MiB.
inline CLI::Validator bytes_between(std::uint64_t low, std::uint64_t high) {
  return CLI::Validator(
      [low, high](std::string& text) {
        const auto bytes = parse_bytes(text);
        if (!bytes) return bytes.error().message;
        return *bytes >= low && *bytes <= high
                   ? std::string()
                   : fmt::format("'{}' is not allowed: it must be between {}M and {}T", text,
                                 low >> 20, high >> 40);
      },
      "BYTES");
}

}  // namespace psygen::cli
