#include "engine/core/utf8.hpp"

#include <gtest/gtest.h>

namespace psygen::core {
namespace {

TEST(Utf8, CodePointsOfEveryLengthAreRead) {
  const auto read = [](std::string_view text) {
    const CodePoint point = first_code_point(text);
    EXPECT_TRUE(point.valid) << text;
    EXPECT_EQ(point.bytes, text.size()) << text;
    return point.value;
  };
  EXPECT_EQ(read("a"), U'a');
  EXPECT_EQ(read(std::string_view("\0", 1)), U'\0');
  EXPECT_EQ(read("\xC2\x80"), 0x80u);
  EXPECT_EQ(read("ö"), U'ö');
  EXPECT_EQ(read("\xE0\xA0\x80"), 0x800u);
  EXPECT_EQ(read("字"), U'字');
  EXPECT_EQ(read("\xEF\xBF\xBF"), 0xFFFFu);
  EXPECT_EQ(read("\xF0\x90\x80\x80"), 0x10000u);
  EXPECT_EQ(read("\xF4\x8F\xBF\xBF"), 0x10FFFFu);
}

TEST(Utf8, ReadsABrokenSequenceAsOneInvalidByte) {
  for (const char* text : {"\x80", "\xBF", "\xC0\x80", "\xC1\xBF", "\xC3", "\xC3(", "\xE0\x80\x80",
                           "\xE0\x9F\xBF", "\xE2\x82", "\xE2\x82(", "\xED\xA0\x80", "\xED\xBF\xBF",
                           "\xF0\x80\x80\x80", "\xF0\x8F\xBF\xBF", "\xF0\x9F\x98",
                           "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFE", "\xFF"}) {
    const CodePoint point = first_code_point(text);
    EXPECT_FALSE(point.valid) << shown(text);
    EXPECT_EQ(point.bytes, 1u) << shown(text);
    EXPECT_EQ(point.value, static_cast<unsigned char>(text[0])) << shown(text);
  }
}

TEST(Utf8, ReadsBackAppendedCharactersAndReplacesInvalidOnes) {
  for (const char32_t value : {U'\0', U'a', U'\x7F', U'\x80', U'\u07FF', U'\u0800', U'\uFFFD',
                               U'\uFFFF', U'\U00010000', U'\U0010FFFF'}) {
    std::string text = "x";
    append_utf8(text, value);
    const CodePoint point = first_code_point(std::string_view(text).substr(1));
    EXPECT_TRUE(point.valid);
    EXPECT_EQ(point.value, value);
    EXPECT_EQ(point.bytes + 1, text.size());
  }
  for (const std::uint32_t none : {0xD800u, 0xDFFFu, 0x110000u, 0xFFFFFFFFu}) {
    std::string text;
    append_utf8(text, static_cast<char32_t>(none));
    EXPECT_EQ(text, "\xEF\xBF\xBD");
  }
}

TEST(Utf8, ShowsPrintableCharactersUnchanged) {
  for (const char* text : {"", "plain \"quoted\" \\ 'text'", "größe × 3", "木", "שלום", "😀"})
    EXPECT_EQ(shown(text), text);
}

TEST(Utf8, EscapesUnprintableCharacters) {
  EXPECT_EQ(shown("a\nb\tc\r"), "a\\nb\\tc\\r");
  EXPECT_EQ(shown("\x1B[31mred\x7F"), "\\x1b[31mred\\x7f");
  EXPECT_EQ(shown(std::string_view("\0", 1)), "\\x00");
  EXPECT_EQ(shown("\xC2\x9B"
                  "31m"),
            "\\u009b31m");
  EXPECT_EQ(shown("a\xE2\x80\xAE"
                  "b"),
            "a\\u202eb");
  EXPECT_EQ(shown("a\xE2\x80\x8B"), "a\\u200b");
  EXPECT_EQ(shown("\xF3\xA0\x80\x81"), "\\U000e0001");
  EXPECT_EQ(shown("gr\xF6\xDF"
                  "e"),
            "gr\\xf6\\xdfe");
}

TEST(Utf8, ALongTextIsCutBetweenCharacters) {
  EXPECT_EQ(shown("abcdef", 6), "abcdef");
  EXPECT_EQ(shown("abcdef", 5), "abcde...");
  EXPECT_EQ(shown("aöb", 2), "a...");
  EXPECT_EQ(shown("aöb", 3), "aö...");
}

}  // namespace
}  // namespace psygen::core
