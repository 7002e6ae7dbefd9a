// Formats numbers for people: three significant digits, decimal prefixes for counts and sizes of
// worlds, binary prefixes for memory. For reports and terminals, not for files that programs read.
// Pure.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "engine/telemetry/statistics.hpp"

namespace psygen::telemetry {

// 3 significant digits, no exponent: 0.123, 1.23, 12.3, 123, 1234.
inline std::string three_digits(double value) {
  const double size = std::abs(value);
  const int decimals = size == 0 || size >= 99.95 ? 0 : size >= 9.995 ? 1 : size >= 0.9995 ? 2 : 3;
  return fmt::format("{:.{}f}", value, decimals);
}

// Without decimals, in milliseconds and in percent.
inline std::string whole(double value) {
  return fmt::format("{:.0f}", value);
}
inline std::string ms_text(double value) {
  return three_digits(value) + " ms";
}
inline std::string percent_text(double value) {
  return three_digits(value) + " %";
}

// The value in the largest of `units` in which it is at least 1; each unit is `step` times the
// previous one. No decimals in the first unit, three digits in the others.
inline std::string with_prefix(double value, double step, const std::array<const char*, 6>& units) {
  std::size_t i = 0;
  while (i + 1 < units.size() && std::abs(value) >= step * 0.9995) {
    value /= step;
    ++i;
  }
  const std::string number = i == 0 ? fmt::format("{:.0f}", value) : three_digits(value);
  return units[i][0] == '\0' ? number : number + " " + units[i];
}

// Sizes in memory, in binary units: 8.40 GiB.
inline std::string bytes_text(double bytes) {
  return with_prefix(bytes, 1024.0, {"B", "KiB", "MiB", "GiB", "TiB", "PiB"});
}

// Sizes of data in general, in the decimal units of disks: 8.40 TB.
inline std::string size_text(double bytes) {
  return with_prefix(bytes, 1000.0, {"B", "kB", "MB", "GB", "TB", "PB"});
}

// Counts: 12.3 thousand, 32.8 billion.
inline std::string count_text(double count) {
  return with_prefix(count, 1000.0,
                     {"", "thousand", "million", "billion", "trillion", "quadrillion"});
}

// The value formatted by `text`, or a dash.
template <class T, class Text>
std::string value_or_dash(const Measured<T>& measured, const Text& text) {
  return measured.has_value() ? text(static_cast<double>(*measured)) : std::string("–");
}

}  // namespace psygen::telemetry
