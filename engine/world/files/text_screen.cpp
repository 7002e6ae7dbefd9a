#include "engine/world/files/text_screen.hpp"

#include <fmt/format.h>

#include "engine/core/utf8.hpp"
#include "engine/world/files/foreign_character.hpp"

namespace psygen::world {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

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
