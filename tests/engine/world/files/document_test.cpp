#include "engine/world/files/document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace psygen::world {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string repeated(std::string_view text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i)
    all += text;
  return all;
}

std::string document_error(std::string_view text) {
  const auto document = parse_document(text, "f.toml");
  EXPECT_FALSE(document.has_value());
  if (document) return "accepted";
  EXPECT_EQ(document.error().code, core::ErrorCode::kParse);
  return document.error().message;
}

TEST(Document, KeepsValuesTypesAndLines) {
  const auto root = parse_document("a = 1\nb = [2.5, \"x\"]\n\n[t]\nc = true\n", "f.toml");
  ASSERT_TRUE(root.has_value());
  ASSERT_EQ(root->members.size(), 3U);
  const Member& a = root->members[0];
  EXPECT_EQ(a.key, "a");
  EXPECT_EQ(a.line, 1);
  EXPECT_EQ(a.value.kind, Node::Kind::kInteger);
  EXPECT_EQ(a.value.integer, 1);
  EXPECT_EQ(a.value.real, 1.0);
  const Member& b = root->members[1];
  EXPECT_EQ(b.value.line, 2);
  EXPECT_EQ(b.value.items[0].real, 2.5);
  EXPECT_EQ(b.value.items[1].text, "x");
  const Member& t = root->members[2];
  EXPECT_EQ(t.line, 4);
  EXPECT_EQ(t.value.members[0].line, 5);
  EXPECT_EQ(t.value.members[0].value.kind, Node::Kind::kBoolean);
}

TEST(Document, AnEmptyTextIsAnEmptyTable) {
  const auto root = parse_document("", "f.toml");
  ASSERT_TRUE(root.has_value());
  EXPECT_TRUE(root->members.empty());
}

TEST(Document, ErrorsNameFileAndLine) {
  EXPECT_THAT(document_error("a = 1\nb =\n"), StartsWith("f.toml:2: this is not valid TOML"));
  EXPECT_THAT(document_error("a = 1\n\na = 2\n"), StartsWith("f.toml:3:"));
}

TEST(Document, ErrorsOfTheSyntaxAreSentences) {
  EXPECT_EQ(document_error("b =\n"),
            "f.toml:1: this is not valid TOML: in a key-value pair: expected value, saw '\\n'");
  EXPECT_EQ(
      document_error("x = [1 2]\n"),
      "f.toml:1: this is not valid TOML: in an array: expected comma or closing ']', saw '2'");
}

TEST(Document, ABracketWithoutAKeyIsAnError) {
  for (const char* text :
       {"[", "[[", "[\n", "[[\n", "[#", "[.", "[a.", "[a.]", "[]", "[[a", "[[a]\n"})
    EXPECT_THAT(document_error(text), StartsWith("f.toml:1:")) << text;
}

TEST(Document, HundredThousandNestedArraysAreRejected) {
  EXPECT_THAT(document_error("a = " + repeated("[", 100'000)), StartsWith("f.toml:1:"));
  EXPECT_THAT(document_error("a = " + repeated("[", 100'000) + repeated("]", 100'000)),
              StartsWith("f.toml:1:"));
  EXPECT_THAT(document_error("a = " + repeated("{b = ", 100'000)), StartsWith("f.toml:1:"));
}

TEST(Document, HundredThousandDottedPartsOfAKeyAreRejected) {
  const std::string deep = repeated("a.", 100'000) + "a";
  const std::string quoted_deep = repeated("\"=\" . ", 100'000) + "a";
  for (const std::string& key : {deep, quoted_deep, repeated("1.", 100'000) + "1"}) {
    EXPECT_THAT(document_error(key + " = 1"), HasSubstr("dotted parts"));
    EXPECT_THAT(document_error("[" + key + "]"), HasSubstr("dotted parts"));
    EXPECT_THAT(document_error("[[" + key + "]]"), HasSubstr("dotted parts"));
    EXPECT_THAT(document_error("x = 1\ny = {" + key + " = 1}"), StartsWith("f.toml:2:"));
    EXPECT_THAT(document_error("y = [1.5, {z = 'it''s', " + key + " = 1}]"),
                StartsWith("f.toml:1:"));
  }
}

TEST(Document, DotsInStringsCommentsAndNumbersAreNotKeys) {
  const std::string dots = repeated(".", 100);
  EXPECT_TRUE(parse_document("a = \"" + dots + "\\\" " + dots + "\"\n# " + dots + "\nb = '" + dots +
                                 "'\nc = [" + repeated("0.5, ", 50) + "]\n",
                             "f.toml")
                  .has_value());
}

TEST(Document, StringsOverSeveralLinesAreRejected) {
  EXPECT_THAT(document_error("a = \"\"\"x\ny\"\"\"\n"), HasSubstr("several lines"));
  EXPECT_THAT(document_error("a = '''x'''\n"), HasSubstr("several lines"));
  EXPECT_TRUE(parse_document("a = \"\"\nb = ''\n", "f.toml").has_value());
}

TEST(Document, InvalidUtf8IsRejected) {
  EXPECT_THAT(document_error("a = \"\xff\xfe\"\n"), StartsWith("f.toml:1:"));
  EXPECT_THAT(document_error("a = 1\n# \xc3\x28\n"), StartsWith("f.toml:2:"));
  EXPECT_THAT(document_error("\xed\xa0\x80 = 1\n"), StartsWith("f.toml:1:"));
}

TEST(Document, BinaryFilesAreRejectedWithAPrintableMessage) {
  std::string binary =
      "\x7f"
      "ELF";
  for (int i = 0; i < 4096; ++i)
    binary += static_cast<char>(i * 37 % 256);
  for (const char c : document_error(binary))
    EXPECT_TRUE(c >= ' ' && c <= '~');
  EXPECT_THAT(document_error(std::string(64, '\0')), StartsWith("f.toml:1:"));
}

TEST(Document, DatesHaveTheirOwnKind) {
  const auto root = parse_document("a = 1979-05-27\n", "f.toml");
  ASSERT_TRUE(root.has_value());
  EXPECT_EQ(root->members[0].value.kind, Node::Kind::kTime);
}

}  // namespace
}  // namespace psygen::world
