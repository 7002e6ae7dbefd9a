#include "engine/core/utf8.hpp"

#include <fmt/format.h>

#include <array>

#include "engine/core/assert.hpp"

namespace psygen::core {
namespace {

std::string escape_of(const CodePoint& point) {
  const auto value = static_cast<std::uint32_t>(point.value);
  if (value == '\n') return "\\n";
  if (value == '\r') return "\\r";
  if (value == '\t') return "\\t";
  if (!point.valid || value < 0x80) return fmt::format("\\x{:02x}", value);
  return value > 0xFFFF ? fmt::format("\\U{:08x}", value) : fmt::format("\\u{:04x}", value);
}

bool is_printable(const CodePoint& point, std::string_view bytes) {
  if (!point.valid || point.value < 0x80)
    return point.valid && point.value >= ' ' && point.value <= '~';
  return fmt::format("{:?}", bytes).size() == bytes.size() + 2;  // only quotes were added
}

}  // namespace

CodePoint first_code_point(std::string_view text) {
  PSYGEN_ASSERT(!text.empty(), "a text without characters has no first one");
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return {first, 1, true};
  const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  const CodePoint invalid{first, 1, false};
  if (first < 0xC2 || first > 0xF4 || text.size() < bytes) return invalid;
  char32_t value = first & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return invalid;
    value = value << 6 | (byte(i) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> kMin{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (value < kMin[bytes] || surrogate || value > 0x10FFFF) return invalid;
  return {value, bytes, true};
}

void append_utf8(std::string& text, char32_t value) {
  const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (surrogate || value > 0x10FFFF) value = 0xFFFD;
  const auto put = [&text](char32_t byte) { text += static_cast<char>(byte); };
  const auto rest = [&](unsigned shift) { put(0x80 | (value >> shift & 0x3F)); };
  if (value < 0x80) return put(value);
  if (value < 0x800) {
    put(0xC0 | value >> 6);
  } else if (value < 0x10000) {
    put(0xE0 | value >> 12);
    rest(6);
  } else {
    put(0xF0 | value >> 18);
    rest(12);
    rest(6);
  }
  rest(0);
}

std::string shown(std::string_view text, std::size_t max_bytes) {
  std::string line;
  std::size_t taken = 0;
  while (taken < text.size()) {
    const CodePoint point = first_code_point(text.substr(taken));
    if (taken + point.bytes > max_bytes) return line + "...";
    const std::string_view bytes = text.substr(taken, point.bytes);
    line += is_printable(point, bytes) ? std::string(bytes) : escape_of(point);
    taken += point.bytes;
  }
  return line;
}

std::string lower_ascii(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

}  // namespace psygen::core
