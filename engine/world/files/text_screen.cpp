#include "engine/world/files/text_screen.hpp"

#include <fmt/format.h>

#include "engine/core/utf8.hpp"

namespace psygen::world {
namespace {

enum class Sight : std::uint8_t { kSeen, kUnseen };  // kUnseen includes combining characters

struct Range {
  char32_t first, last;
  Sight sight;
  const char* kind;
  const char* advice;
};

constexpr const char* kSpace = "write a plain space";
constexpr const char* kHyphen = "write -";
constexpr const char* kDoubleQuote = "write \"";
constexpr const char* kSingleQuote = "write '";
constexpr const char* kDelete = "delete it";
constexpr const char* kLatin = "write the Latin letter if it was meant";
constexpr const char* kTurn = "an invisible mark that reverses the direction of the text";
constexpr const char* kInvisible = "an invisible character";

constexpr Range kRanges[] = {
    {0x0080, 0x0084, Sight::kUnseen, "a control character", kDelete},
    {0x0085, 0x0085, Sight::kUnseen, "a line break that is not ASCII", "insert a plain line break"},
    {0x0086, 0x009F, Sight::kUnseen, "a control character", kDelete},
    {0x00A0, 0x00A0, Sight::kUnseen, "a non-breaking space", kSpace},
    {0x00AB, 0x00AB, Sight::kSeen, "a typographic quotation mark", kDoubleQuote},
    {0x00AD, 0x00AD, Sight::kUnseen, "a soft hyphen, which is invisible", kDelete},
    {0x00B4, 0x00B4, Sight::kSeen, "an accent", kSingleQuote},
    {0x00BB, 0x00BB, Sight::kSeen, "a typographic quotation mark", kDoubleQuote},
    {0x0300, 0x036F, Sight::kUnseen, "a mark on the previous letter", kDelete},
    {0x0370, 0x03FF, Sight::kSeen, "a Greek letter", kLatin},
    {0x0400, 0x052F, Sight::kSeen, "a Cyrillic letter", kLatin},
    {0x061C, 0x061C, Sight::kUnseen, kTurn, kDelete},
    {0x1680, 0x1680, Sight::kUnseen, "a space that is not ASCII", kSpace},
    {0x180E, 0x180E, Sight::kUnseen, kInvisible, kDelete},
    {0x1AB0, 0x1AFF, Sight::kUnseen, "a mark on the previous letter", kDelete},
    {0x1DC0, 0x1DFF, Sight::kUnseen, "a mark on the previous letter", kDelete},
    {0x2000, 0x200A, Sight::kUnseen, "a space that is not ASCII", kSpace},
    {0x200B, 0x200B, Sight::kUnseen, "a zero-width space, which is invisible", kDelete},
    {0x200C, 0x200D, Sight::kUnseen, kInvisible, kDelete},
    {0x200E, 0x200F, Sight::kUnseen, kTurn, kDelete},
    {0x2010, 0x2015, Sight::kSeen, "a typographic hyphen or dash", kHyphen},
    {0x2018, 0x201B, Sight::kSeen, "a typographic quotation mark", kSingleQuote},
    {0x201C, 0x201F, Sight::kSeen, "a typographic quotation mark", kDoubleQuote},
    {0x2028, 0x2029, Sight::kUnseen, "a line break that is not ASCII", "insert a plain line break"},
    {0x202A, 0x202E, Sight::kUnseen, kTurn, kDelete},
    {0x202F, 0x202F, Sight::kUnseen, "a non-breaking space", kSpace},
    {0x2032, 0x2032, Sight::kSeen, "a prime", kSingleQuote},
    {0x2033, 0x2033, Sight::kSeen, "a double prime", kDoubleQuote},
    {0x2039, 0x203A, Sight::kSeen, "a typographic quotation mark", kSingleQuote},
    {0x205F, 0x205F, Sight::kUnseen, "a space that is not ASCII", kSpace},
    {0x2060, 0x2064, Sight::kUnseen, kInvisible, kDelete},
    {0x2066, 0x2069, Sight::kUnseen, kTurn, kDelete},
    {0x206A, 0x206F, Sight::kUnseen, kInvisible, kDelete},
    {0x20D0, 0x20FF, Sight::kUnseen, "a mark on the previous letter", kDelete},
    {0x2212, 0x2212, Sight::kSeen, "a minus sign that is not ASCII", kHyphen},
    {0x3000, 0x3000, Sight::kUnseen, "a space that is not ASCII", kSpace},
    {0xFE00, 0xFE0F, Sight::kUnseen, kInvisible, kDelete},
    {0xFE20, 0xFE2F, Sight::kUnseen, "a mark on the previous letter", kDelete},
    {0xFE58, 0xFE58, Sight::kSeen, "a typographic hyphen or dash", kHyphen},
    {0xFE63, 0xFE63, Sight::kSeen, "a typographic hyphen or dash", kHyphen},
    {0xFEFF, 0xFEFF, Sight::kUnseen, "a byte order mark, which may only start a file", kDelete},
    {0xE0000, 0xE0FFF, Sight::kUnseen, kInvisible, kDelete},
};

// The ASCII character of a full-width form, or 0.
char ascii_of_full_width(char32_t c) {
  return c >= 0xFF01 && c <= 0xFF5E ? static_cast<char>(c - 0xFF01 + '!') : '\0';
}

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// A description of a character for an error message.
struct ForeignCharacter {
  std::string name;    // "'ö' (U+00F6)", "U+200B (an invisible space)"
  std::string advice;  // how to correct it: "write -"; empty for most
};

// Describes a code point by glyph, number and, if it is invisible or easily mistaken for ASCII, in
// words. `bytes` is its UTF-8 text.
ForeignCharacter describe(const core::CodePoint& point, std::string_view bytes) {
  const std::string number = fmt::format("U+{:04X}", static_cast<std::uint32_t>(point.value));
  const auto seen = [&](std::string_view kind) {
    // Characters that {fmt} calls unprintable are given only by number.
    const std::string glyph = core::shown(bytes);
    return glyph == bytes ? fmt::format("'{}' ({}{})", glyph, number, kind) : number;
  };
  if (const char ascii = ascii_of_full_width(point.value); ascii != '\0')
    return {seen(", a full-width character"), fmt::format("write {}", ascii)};
  for (const Range& range : kRanges) {
    if (point.value < range.first || point.value > range.last) continue;
    if (range.sight == Sight::kSeen) return {seen(fmt::format(", {}", range.kind)), range.advice};
    return {fmt::format("{} ({})", number, range.kind), range.advice};
  }
  return {seen(""), ""};
}

class Screen {
 public:
  Screen(std::string_view text, std::string_view file, int max_parts)
      : text_(text), file_(file), max_parts_(max_parts) {}

  core::Result<void> run() {
    if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF"))
      return refuse("this is UTF-16; save the file as UTF-8");
    if (text_.starts_with(kByteOrderMark)) at_ = line_start_ = kByteOrderMark.size();
    while (at_ < text_.size()) {
      if (auto ok = take(); !ok) return ok;
    }
    return {};
  }

 private:
  enum class Within : std::uint8_t { kNothing, kComment, kString };

  tl::unexpected<core::Error> refuse(std::string_view sentence) const {
    std::size_t column = 1;
    for (std::size_t i = line_start_; i < at_; ++column)
      i += core::first_code_point(text_.substr(i)).bytes;
    return core::fail(core::ErrorCode::kParse,
                      fmt::format("{}:{}:{}: {}", file_, line_, column, sentence));
  }

  core::Result<void> take() {
    const core::CodePoint point = core::first_code_point(text_.substr(at_));
    if (!point.valid)
      return refuse(fmt::format("the byte 0x{:02X} is not UTF-8; save the file as UTF-8",
                                static_cast<std::uint32_t>(point.value)));
    if (point.value >= 0x80 && within_ == Within::kNothing) return refuse_foreign(point);
    const char c = text_[at_];
    if (c == '\n') {
      end_line();
    } else if (within_ == Within::kNothing) {
      if (auto ok = take_plain(c); !ok) return ok;
    } else if (within_ == Within::kString) {
      take_in_string(c);
    }
    at_ += point.bytes;
    return {};
  }

  void take_in_string(char c) {
    if (escaped_) {
      escaped_ = false;
    } else if (c == '\\' && quote_ == '"') {
      escaped_ = true;
    } else if (c == quote_) {
      within_ = Within::kNothing;
    }
  }

  void end_line() {
    ++line_;
    line_start_ = at_ + 1;
    within_ = Within::kNothing;
    escaped_ = false;
    dots_ = 0;
  }

  // The parser limits the nesting of values, but not the parts of a dotted key. Each part is a
  // table, so long keys would exhaust the stack. Strings over several lines are rejected, so a line
  // break ends every string and comment.
  core::Result<void> take_plain(char c) {
    if (c == '#') {
      within_ = Within::kComment;
    } else if (c == '"' || c == '\'') {
      if (text_.substr(at_, 3) == std::string(3, c))
        return refuse("strings over several lines are not allowed");
      within_ = Within::kString;
      quote_ = c;
    } else if (c == '.') {
      if (++dots_ >= max_parts_)
        return refuse(fmt::format("a key may have at most {} dotted parts", max_parts_));
    } else if (std::string_view("=,[]{}").find(c) != std::string_view::npos) {
      dots_ = 0;
    }
    return {};
  }

  core::Result<void> refuse_foreign(const core::CodePoint& point) const {
    const ForeignCharacter character = describe(point, text_.substr(at_, point.bytes));
    return refuse(
        fmt::format("{} is not allowed here{}{}; outside of strings and comments only "
                    "ASCII characters are",
                    character.name, character.advice.empty() ? "" : ": ", character.advice));
  }

  std::string_view text_, file_;
  int max_parts_;
  std::size_t at_ = 0, line_start_ = 0, line_ = 1;
  Within within_ = Within::kNothing;
  char quote_ = '"';      // the string's delimiter
  bool escaped_ = false;  // by a backslash in the string
  int dots_ = 0;
};

}  // namespace

core::Result<void> screen_text(std::string_view text, std::string_view file, int max_parts) {
  return Screen(text, file, max_parts).run();
}

}  // namespace psygen::world
