#include "tests/fuzz/mutator.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace psygen::fuzz {
namespace {

using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t end) {
  return end == 0 ? 0 : static_cast<std::size_t>(random() % end);
}

template <class T, std::size_t N>
const T& one_of(Random& random, const T (&items)[N]) {
  return items[below(random, N)];
}

struct CodePoints {
  char32_t first, last;
};
// Characters that resemble ASCII, invisible characters, joiners and direction marks; the TOML
// parser's table of spaces; the ends of planes; any code point.
constexpr CodePoints kCodePoints[] = {
    {0x00A0, 0x00FF},   {0x00A1, 0x0499},   {0x0300, 0x036F},   {0x0590, 0x06FF},
    {0x1680, 0x1680},   {0x180E, 0x180E},   {0x2000, 0x206F},   {0x2010, 0x201F},
    {0x2028, 0x202E},   {0x2066, 0x2069},   {0x2212, 0x2212},   {0x2C5E, 0x3057},
    {0xFB26, 0xFEFF},   {0xFE00, 0xFE0F},   {0xFEFF, 0xFEFF},   {0xFF01, 0xFF5E},
    {0xD7F0, 0xD7FF},   {0xE000, 0xE010},   {0xFFF0, 0xFFFF},   {0x10000, 0x1FFFF},
    {0x1F300, 0x1F6FF}, {0x20000, 0x2FFFF}, {0xE0000, 0xE01EF}, {0x10FFF0, 0x10FFFF},
    {0x0000, 0x009F},   {0x0080, 0xD7FF},   {0xE000, 0x10FFFF}};

std::string utf8(char32_t c) {
  const auto tail = [c](int shift) { return static_cast<char>(0x80 | (c >> shift & 0x3F)); };
  if (c < 0x80) return {static_cast<char>(c)};
  if (c < 0x800) return {static_cast<char>(0xC0 | c >> 6), tail(0)};
  if (c < 0x10000) return {static_cast<char>(0xE0 | c >> 12), tail(6), tail(0)};
  return {static_cast<char>(0xF0 | c >> 18), tail(12), tail(6), tail(0)};
}

std::string code_point(Random& random) {
  const CodePoints& range = one_of(random, kCodePoints);
  return utf8(range.first + static_cast<char32_t>(below(random, range.last - range.first + 1)));
}

// Invalid UTF-8: truncated, overlong, surrogates, beyond the last plane.
constexpr std::string_view kBroken[] = {
    "\x80",         "\xBF",         "\xC3",     "\xE2\x80",     "\xF0\x9F\x98",     "\xC0\xAF",
    "\xE0\x80\xAF", "\xED\xA0\x80", "\xED\xBF", "\xF0\x80\x80", "\xF4\x90\x80\x80", "\xFE\xFF",
    "\xFF\xFE"};

// clang-format off
constexpr std::string_view kTokens[] = {
    "[", "]", "[[", "]]", "{", "}", "=", ".", ",", "#", "\"", "'", "\\", "\"\"\"", "'''", "\n",
    "\r", "\r\n", "\t", " ", "\v", "\f", "\\u", "\\U", "\\\"", "\\u00e9", "\\ud800", "\\U0010FFFF",
    "\\x1b", "\\e", "= ", "a.b", "\"\"", "''", "_", "+", "-", "0", "1", "e", "0x", "0b", "0o",
    "true", "false", "1979-05-27", "1979-05-27T07:32:00Z", "1979-05-27 07:32", "07:32:00.5",
    "format = 1\n", "[world]\n", "[terrain]\n", "[[scatter]]\n", "[[species]]\n",
    "[[species.kind]]\n", "[[species.rule]]\n", "[species.foliage]\n", "[species.colours]\n",
    "[[river]]\n", "[[lake]]\n", "[sky]\n", "[water]\n", "[palette]\n", "[path]\n", "[[point]]\n", "jump = true\n",
    "model = \"rock\"\n", "count = 3\n", "to = \"LB*\"\n", "\xEF\xBB\xBF"};

constexpr std::string_view kNumbers[] = {
    "0", "-0", "1", "-1", "0.0", "-0.0", "1e308", "1e-308", "1e400", "-1e400", "5e-324", "nan",
    "-nan", "inf", "-inf", "9223372036854775807", "-9223372036854775808", "9223372036854775808",
    "18446744073709551615", "\"18446744073709551615\"", "2147483647", "2147483648", "-2147483649",
    "4294967296", "0xFFFFFFFFFFFFFFFF", "1_000", "1.", ".5", "+1", "01", "1e", "3.5", "[1, 2]",
    "[2, 1]", "[0.5, inf]", "\"1\"", "true", "{}", "[]", "1979-05-27",
    "0.00000000000000000000000000000000000000000000000000000000000000000000000000000000000000000001",
    "1000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000"
    "00000000000000000000000000000000000000000000000000000"};
// clang-format on

bool goes_on(const std::string& text, std::size_t at) {
  return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
}

// Returns a position between two characters, if the text is UTF-8.
std::size_t boundary(Random& random, const std::string& text) {
  std::size_t at = below(random, text.size() + 1);
  while (goes_on(text, at))
    ++at;
  return at;
}

std::size_t character_bytes(const std::string& text, std::size_t at) {
  std::size_t end = at + 1;
  while (goes_on(text, end))
    ++end;
  return end - at;
}

struct Piece {
  std::size_t at, size;
};

Piece line_of(Random& random, const std::string& text) {
  const std::size_t middle = below(random, text.size() + 1);
  const std::size_t before = middle == 0 ? std::string::npos : text.rfind('\n', middle - 1);
  const std::size_t at = before == std::string::npos ? 0 : before + 1;
  const std::size_t end = text.find('\n', at);
  return {at, (end == std::string::npos ? text.size() : end + 1) - at};
}

// Returns the next number after a random position.
Piece number_of(Random& random, const std::string& text) {
  constexpr const char* kDigits = "0123456789+-._eE";
  const std::size_t at =
      std::min(text.find_first_of("0123456789", below(random, text.size() + 1)), text.size());
  const std::size_t end = std::min(text.find_first_not_of(kDigits, at), text.size());
  return {at, end - at};
}

void insert(std::string& text, std::size_t at, std::string_view piece) {
  text.insert(std::min(at, text.size()), piece);
}

void change_characters(std::string& text, Random& random) {
  const std::size_t at = boundary(random, text);
  switch (below(random, 5)) {
    case 0:
      return insert(text, at, code_point(random));
    case 1:
      text.replace(at, character_bytes(text, at), code_point(random));
      return;
    case 2:  // possibly inside a character
      return insert(text, below(random, text.size() + 1), code_point(random));
    case 3: {  // several code points after a key, a number or any other text
      const char quote = below(random, 2) == 0 ? '"' : '\'';
      return insert(text, at, quote + code_point(random) + code_point(random) + quote);
    }
    default:  // directly after a number
      const Piece number = number_of(random, text);
      return insert(text, number.at + number.size, code_point(random));
  }
}

void change_bytes(std::string& text, Random& random) {
  const std::size_t at = below(random, text.size() + 1);
  switch (below(random, 4)) {
    case 0:
      text.erase(at, 1 + below(random, 4));
      return;
    case 1:
      return insert(text, at, one_of(random, kBroken));
    case 2:
      if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(random, 8)));
      return;
    default:
      text.resize(at);
  }
}

void change_structure(std::string& text, std::span<const std::string> others, Random& random) {
  const Piece line = line_of(random, text);
  switch (below(random, 7)) {
    case 0:
      return insert(text, boundary(random, text), one_of(random, kTokens));
    case 1: {  // deep nesting, or a long key
      const std::string_view token = one_of(random, kTokens);
      std::string many;
      for (std::size_t i = below(random, 40); i > 0; --i)
        many += token;
      return insert(text, boundary(random, text), many);
    }
    case 2: {
      const Piece number = number_of(random, text);
      text.replace(number.at, number.size, one_of(random, kNumbers));
      return;
    }
    case 3:
      return insert(text, line_of(random, text).at, text.substr(line.at, line.size));
    case 4:
      text.erase(line.at, line.size);
      return;
    case 5: {
      const std::string& other = others[below(random, others.size())];
      const Piece theirs = line_of(random, other);
      return insert(text, line.at, other.substr(theirs.at, theirs.size));
    }
    default: {
      const std::string& other = others[below(random, others.size())];
      text = text.substr(0, line.at) + other.substr(line_of(random, other).at);
    }
  }
}

}  // namespace

std::string mutated(std::string text, std::span<const std::string> others, std::size_t max_bytes,
                    std::mt19937_64& random) {
  for (std::size_t changes = 1 + below(random, 8); changes > 0; --changes) {
    switch (below(random, 4)) {
      case 0:
      case 1:
        change_characters(text, random);
        break;
      case 2:
        change_bytes(text, random);
        break;
      default:
        change_structure(text, others, random);
    }
  }
  text.resize(std::min(text.size(), max_bytes));
  return text;
}

}  // namespace psygen::fuzz
