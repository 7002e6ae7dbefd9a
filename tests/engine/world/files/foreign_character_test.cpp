#include "engine/world/files/foreign_character.hpp"

#include <gtest/gtest.h>

namespace psygen::world {
namespace {

ForeignCharacter described(std::string_view text) {
  return describe(core::first_code_point(text), text);
}

TEST(ForeignCharacter, IsNamedByItsGlyphAndItsNumber) {
  EXPECT_EQ(described("ö").name, "'ö' (U+00F6)");
  EXPECT_EQ(described("×").name, "'×' (U+00D7)");
  EXPECT_EQ(described("字").name, "'字' (U+5B57)");
  EXPECT_EQ(described("😀").name, "'😀' (U+1F600)");
  EXPECT_EQ(described("ö").advice, "");
}

TEST(ForeignCharacter, InvisibleCharactersHaveADescriptionOnly) {
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

TEST(ForeignCharacter, LookalikesOfAsciiComeWithACorrection) {
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
