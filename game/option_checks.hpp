// Checks that CLI11 runs on an option's text; the sentence becomes the usage error.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <string>

namespace psygen::game {

// `parse` gives a core::Result.
template <class Parse>
CLI::Validator valid_if(Parse parse, const std::string& description) {
  return CLI::Validator(
      [parse](std::string& text) {
        const auto value = parse(text);
        return value ? std::string() : value.error().message;
      },
      description);
}

inline CLI::Validator number_between(double low, double high) {
  return CLI::Validator(
      [low, high](std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        const bool ok =
            !text.empty() && *end == 0 && std::isfinite(value) && value >= low && value <= high;
        return ok ? std::string() : fmt::format("'{}' is not between {} and {}", text, low, high);
      },
      fmt::format("{} to {}", low, high));
}

}  // namespace psygen::game
