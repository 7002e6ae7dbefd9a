#include "engine/world/files/toml_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <iterator>

namespace psygen::world {

std::string toml_number(double value) {
  return fmt::format("{}", value);
}

std::string toml_number(std::int64_t value) {
  return fmt::format("{}", value);
}

std::string toml_seed(std::uint64_t seed) {
  return seed <= INT64_MAX ? fmt::format("{}", seed) : fmt::format("\"{}\"", seed);
}

std::string toml_vector(std::span<const double> values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}

std::string toml_vector(const glm::vec3& value) {
  return fmt::format("[{}, {}, {}]", value.x, value.y, value.z);
}

std::string toml_range(double low, double high, bool integers) {
  const auto number = [integers](double value) {
    return integers ? toml_number(std::int64_t{std::llround(value)}) : toml_number(value);
  };
  return low == high ? number(low) : fmt::format("[{}, {}]", number(low), number(high));
}

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7F') {
      fmt::format_to(std::back_inserter(out), "\\u{:04X}", static_cast<unsigned>(c));
    } else {
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
  }
  return out + '"';
}

}  // namespace psygen::world
