
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "engine/world/files/document.hpp"

namespace psygen::world {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string screen_error(std::string_view text) {
  const auto screened = screen_text(text, "f.toml", kMaxNesting);
  EXPECT_FALSE(screened.has_value()) << text;
  if (screened) return "accepted";
  EXPECT_EQ(screened.error().code, core::ErrorCode::kParse);
  EXPECT_EQ(parse_document(text, "f.toml").error().message, screened.error().message);
  return screened.error().message;
}

struct Described {
  std::string name, advice;
};

// The description of a character that is not ASCII.
Described described(std::string_view character) {
  const std::string message = screen_error("a" + std::string(character));
  std::smatch parts;
  const std::regex form("f.toml:1:2: (.*) is not allowed here(?:: (.*))?; outside of strings .*");
  EXPECT_TRUE(std::regex_match(message, parts, form)) << message;
  return {parts[1], parts[2]};
}

std::string utf8(char32_t c) {
  std::string text;
  if (c < 0x800) {
    text += static_cast<char>(0xC0 | c >> 6);
  } else {
    text += static_cast<char>(c < 0x10000 ? 0xE0 | c >> 12 : 0xF0 | c >> 18);
    if (c >= 0x10000) text += static_cast<char>(0x80 | (c >> 12 & 0x3F));
    text += static_cast<char>(0x80 | (c >> 6 & 0x3F));
  }
  return text + static_cast<char>(0x80 | (c & 0x3F));
}

TEST(TextScreen, ANonAsciiCharacterIsNamedWithItsPositionAndTheRule) {
  EXPECT_EQ(screen_error("größe = 1\n"),
            "f.toml:1:3: 'ö' (U+00F6) is not allowed here; outside of strings and comments only "
            "ASCII characters are");
  EXPECT_EQ(screen_error("# größe\nsize = 3 × 4\n"),
            "f.toml:2:10: '×' (U+00D7) is not allowed here; outside of strings and comments only "
            "ASCII characters are");
  EXPECT_THAT(screen_error("a = \"ä\"\nname = “x”\n"),
              StartsWith("f.toml:2:8: '“' (U+201C, a typographic quotation mark) is not allowed "
                         "here: write \"; outside"));
}

TEST(TextScreen, ColumnsCountCharactersAndNoByteOrderMark) {
  EXPECT_THAT(screen_error("\"äöü\" ß"), StartsWith("f.toml:1:7: 'ß'"));
  EXPECT_THAT(screen_error("\xEF\xBB\xBFö"), StartsWith("f.toml:1:1: 'ö'"));
  EXPECT_THAT(screen_error("\t\tö"), StartsWith("f.toml:1:3: 'ö'"));
  EXPECT_THAT(screen_error("a = '\xC3\xB6'\r\n\n  \xC3\xB6"), StartsWith("f.toml:3:3: 'ö'"));
}

// Every plane, and all characters that the parser's function does not handle.
TEST(TextScreen, EveryNonAsciiCharacterOutsideStringsAndCommentsIsRejected) {
  for (char32_t c = 0x80; c <= 0x10FFFF; c = c < 0x10000 ? c + 1 : c + 997) {
    if (c >= 0xD800 && c <= 0xDFFF) continue;
    const std::string foreign = utf8(c);
    const auto screened = screen_text("a" + foreign, "f", kMaxNesting);
    ASSERT_FALSE(screened.has_value()) << std::hex << static_cast<std::uint32_t>(c);
    ASSERT_THAT(screened.error().message,
                HasSubstr(fmt::format("U+{:04X}", static_cast<std::uint32_t>(c))));
  }
  for (const char* before : {"",
                             "a",
                             "a ",
                             "a.",
                             "a =",
                             "a = 1",
                             "a = 1 ",
                             "a = true",
                             "a = -",
                             "a = \"x\"",
                             "a = [",
                             "a = [1",
                             "a = [1, ",
                             "a = {",
                             "a = {b",
                             "a = {b = 1",
                             "[",
                             "[a",
                             "[a]",
                             "[[a]",
                             "[[a]]",
                             "\"a\"",
                             "'a'.",
                             "a = 1979-05-27",
                             "a = 1979-05-27 1",
                             "a = 0x",
                             "a = 1e"})
    EXPECT_THAT(screen_error(std::string(before) + "ö = 1\n"), HasSubstr("'ö' (U+00F6)")) << before;
}

TEST(TextScreen, StringsAndCommentsMayHaveAnyCharacter) {
  for (const char* text :
       {"name = \"Größe “×” \xE2\x80\xAE 木 😀\"\n", "name = 'Größe'\n", "# Größe × − \xC2\xA0\n",
        "\"größe\" = 1\n", "a = 1 # ö\nb = 2\n", "a.'ö'.b = 1\n", "[\"ö\"]\n", "[[a.'ö']] # ß\n",
        "a = [\"ö\", 'ß', # ä\n \"ü\"]\n", "a = {\"ö\" = 'ß'}\n", "a = \"\\\"ö\\\\\" # ö\n",
        "a = '\\' # ö\n", "1.\"ö\" = 2\n", "\xEF\xBB\xBF# a mark at the start\na = 1\n"}) {
    EXPECT_TRUE(screen_text(text, "f", kMaxNesting)) << text;
    EXPECT_TRUE(parse_document(text, "f")) << text;
  }
}

// Here the screen sees a string but the parser does not.
TEST(TextScreen, AQuoteRightAfterANumberIsAnErrorOfTheParser) {
  for (const char* text : {"a = 1\"ö\"\n", "a = 1'ö'\n", "a = [1\"×\"]\n", "a = 1=\"ö\"\n",
                           "a = 1.\"ö\"\n", "a = 1979-05-27 1\"ö\"\n", "a = +\"ö\"\n"}) {
    EXPECT_TRUE(screen_text(text, "f", kMaxNesting)) << text;
    EXPECT_FALSE(parse_document(text, "f")) << text;
  }
}

TEST(TextScreen, BytesThatAreNotUtf8AreRejectedEvenInStringsAndComments) {
  EXPECT_EQ(screen_error("a = 1\nname = \"Gr\xF6\xDF"
                         "e\"\n"),
            "f.toml:2:11: the byte 0xF6 is not UTF-8; save the file as UTF-8");
  EXPECT_THAT(screen_error("# \xED\xA0\x80\n"), StartsWith("f.toml:1:3: the byte 0xED"));
  EXPECT_THAT(screen_error("a = '\xF0\x9F\x98"), StartsWith("f.toml:1:6: the byte 0xF0"));
  EXPECT_THAT(screen_error("a = \"\\\xFF\"\n"), StartsWith("f.toml:1:7: the byte 0xFF"));
  EXPECT_THAT(screen_error(std::string("\xFF\xFE"
                                       "a\0",
                                       4)),
              HasSubstr("UTF-16"));
  EXPECT_THAT(screen_error(std::string("\xFE\xFF"
                                       "\0a",
                                       4)),
              HasSubstr("UTF-16"));
}

TEST(TextScreen, ForeignCharactersAreNamedByTheirGlyphAndNumber) {
  EXPECT_EQ(described("ö").name, "'ö' (U+00F6)");
  EXPECT_EQ(described("×").name, "'×' (U+00D7)");
  EXPECT_EQ(described("字").name, "'字' (U+5B57)");
  EXPECT_EQ(described("😀").name, "'😀' (U+1F600)");
  EXPECT_EQ(described("ö").advice, "");
}

TEST(TextScreen, InvisibleCharactersHaveADescriptionOnly) {
  EXPECT_EQ(described("\xC2\xA0").name, "U+00A0 (a non-breaking space)");
  EXPECT_EQ(described("\xC2\xA0").advice, "write a plain space");
  EXPECT_EQ(described("\xE2\x80\x8B").name, "U+200B (a zero-width space, which is invisible)");
  EXPECT_EQ(described("\xE2\x80\x8B").advice, "delete it");
  EXPECT_EQ(described("\xEF\xBB\xBF").name,
            "U+FEFF (a byte order mark, which may only start a file)");
  EXPECT_EQ(described("\xE2\x80\xAE").name,
            "U+202E (an invisible mark that reverses the direction of the text)");
  EXPECT_EQ(described("\xCC\x88").name, "U+0308 (a mark on the previous letter)");
  EXPECT_EQ(described("\xEE\x80\x80").name, "U+E000") << "nobody knows what it looks like";
  EXPECT_EQ(described("\xF4\x8F\xBF\xBF").name, "U+10FFFF");
}

TEST(TextScreen, LookalikesOfAsciiComeWithACorrection) {
  EXPECT_EQ(described("“").name, "'“' (U+201C, a typographic quotation mark)");
  for (const auto& [text, advice] :
       {std::pair("“", "write \""), std::pair("”", "write \""), std::pair("„", "write \""),
        std::pair("’", "write '"), std::pair("−", "write -"), std::pair("–", "write -"),
        std::pair("\xE2\x80\xAF", "write a plain space"), std::pair("＝", "write ="),
        std::pair("５", "write 5"), std::pair("ｃ", "write c")})
    EXPECT_EQ(described(text).advice, advice) << text;
  EXPECT_EQ(described("с").name, "'с' (U+0441, a Cyrillic letter)");
}

}  // namespace
}  // namespace psygen::world
