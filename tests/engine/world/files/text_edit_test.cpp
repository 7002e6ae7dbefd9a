#include "engine/world/files/text_edit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/world/files/toml_values.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using ::testing::HasSubstr;

constexpr const char* kText =
    "# größer: a file in UTF-8 – with comments\n"
    "format = 1\n"
    "\n"
    "[world]\n"
    "name = \"Hügel # 7\"   # the name\n"
    "seed = 5\n"
    "\n"
    "# one\n"
    "[[scatter]]\n"
    "model = \"tree\"\n"
    "size_m = [ 1, # low\n"
    "  2 ]  # high\n"
    "\n"
    "# two\n"
    "[[scatter]]\n"
    "model = \"rock\"\n"
    "\n"
    "[water]\n"
    "level_m = 3\n";

std::string set(std::string_view text, const TextPath& path, std::string_view value) {
  const auto changed = with_value(text, path, value);
  EXPECT_TRUE(changed) << changed.error().message;
  return changed.value_or("");
}

std::string replaced(std::string_view from, std::string_view to) {
  return testing::replaced(kText, from, to);
}

TEST(TextEdit, SetsOneValueAtEveryPathThatIsAccepted) {
  const auto is_model = [](const TextPath& path) {
    return path.size() == 3 && path.back().key == "model";
  };
  const auto changed = with_each_value(kText, is_model, "\"birch\"");
  ASSERT_TRUE(changed) << changed.error().message;
  EXPECT_EQ(*changed, set(set(kText, {"scatter", 0, "model"}, "\"birch\""), {"scatter", 1, "model"},
                          "\"birch\""));
  EXPECT_EQ(with_each_value(
                kText, [](const TextPath&) { return false; }, "1"),
            kText);
  EXPECT_FALSE(with_each_value(kText, is_model, "1 # more"));
  EXPECT_FALSE(with_each_value("a = ", is_model, "1"));
}

TEST(TextEdit, ReplacesAValueAndKeepsTheCommentBehindIt) {
  EXPECT_EQ(set(kText, {"world", "name"}, "\"Täler\""),
            replaced("\"Hügel # 7\"   # the name", "\"Täler\"   # the name"));
  EXPECT_EQ(set(kText, {"scatter", 0, "size_m"}, "3"), replaced("[ 1, # low\n  2 ]", "3"));
  EXPECT_EQ(set(kText, {"scatter", 0, "size_m", 1}, "2.5"), replaced("  2 ]", "  2.5 ]"));
}

TEST(TextEdit, AddsAKeyBehindTheLastOfItsTable) {
  EXPECT_EQ(set(kText, {"scatter", 0, "count"}, "9"), replaced("# high\n", "# high\ncount = 9\n"));
  EXPECT_EQ(set(kText, {"scatter", 1, "count"}, "9"),
            replaced("\"rock\"\n", "\"rock\"\ncount = 9\n"));
  EXPECT_EQ(set("a = 1", {"b"}, "2"), "a = 1\nb = 2\n");
  EXPECT_EQ(set("[a]", {"a", "b"}, "2"), "[a]\nb = 2\n");
  EXPECT_EQ(set("", {"b"}, "2"), "b = 2\n");
  EXPECT_EQ(set("\xEF\xBB\xBF[a]\r\n  b = 1\r\n", {"a", "c"}, "2"),
            "\xEF\xBB\xBF[a]\r\n  b = 1\r\n  c = 2\r\n");
}

TEST(TextEdit, MakesAMissingTableInTheUsualOrder) {
  EXPECT_EQ(set(kText, {"sky", "exposure"}, "2"),
            replaced("[water]", "[sky]\nexposure = 2\n\n[water]"));
  EXPECT_EQ(set(kText, {"terrain", "octaves"}, "2"),
            replaced("# one\n", "[terrain]\noctaves = 2\n\n# one\n"));
  EXPECT_EQ(set(kText, {"palette", "rock"}, "[1, 0, 0]"),
            std::string(kText) + "\n[palette]\nrock = [1, 0, 0]\n");
  EXPECT_EQ(set("[[species]]\nname = \"a\"\n\n  [[species.kind]]\n  symbol = \"T\"\n\n"
                "  [species.colours]\n\n[[species]]\n",
                {"species", 0, "foliage", "up"}, "1"),
            "[[species]]\nname = \"a\"\n\n  [[species.kind]]\n  symbol = \"T\"\n\n"
            "  [species.foliage]\n  up = 1\n\n  [species.colours]\n\n[[species]]\n");
}

TEST(TextEdit, ChangesInlineTablesArraysAndDottedKeys) {
  constexpr const char* kInline = "sky = { exposure = 1 } # x\nw.a = 1\nl = [{}, {b = 1}]\n";
  EXPECT_EQ(set(kInline, {"sky", "exposure"}, "2"),
            testing::replaced(kInline, "exposure = 1", "exposure = 2"));
  EXPECT_EQ(set(kInline, {"sky", "cloud_cover"}, "0"),
            testing::replaced(kInline, "= 1 }", "= 1, cloud_cover = 0 }"));
  EXPECT_EQ(set(kInline, {"sky", "a", "b"}, "0"),
            testing::replaced(kInline, "= 1 }", "= 1, a = { b = 0 } }"));
  EXPECT_EQ(set(kInline, {"w", "b"}, "2"),
            testing::replaced(kInline, "w.a = 1\n", "w.a = 1\nw.b = 2\n"));
  EXPECT_EQ(set(kInline, {"l", 0, "c"}, "2"), testing::replaced(kInline, "{}", "{ c = 2 }"));
  EXPECT_EQ(set(kInline, {"l", 2}, "7"), testing::replaced(kInline, "1}]", "1}, 7]"));
  EXPECT_EQ(set("a = []", {"a", 0}, "7"), "a = [7]");
  EXPECT_EQ(*without_value(kInline, {"sky", "exposure"}),
            testing::replaced(kInline, "exposure = 1 ", " "));
  EXPECT_EQ(*without_value("a = { b = 1, c = 2, d = 3 }", {"a", "b"}), "a = { c = 2, d = 3 }");
  EXPECT_EQ(*without_value("a = { b = 1, c = 2, d = 3 }", {"a", "d"}), "a = { b = 1, c = 2 }");
  EXPECT_EQ(*without_value("a = [1, 2, 3]", {"a", 1}), "a = [1, 3]");
}

TEST(TextEdit, ReadsKeysInQuotesDatesAndEscapes) {
  constexpr const char* kOdd = "\"a b\".'c.d' = 1979-05-27 07:32:00 # x\n\"\\u0041\" = '\"'\n";
  EXPECT_EQ(value_text(kOdd, {"a b", "c.d"}), "1979-05-27 07:32:00");
  EXPECT_EQ(value_text(kOdd, {"A"}), "'\"'");
  EXPECT_EQ(set(kOdd, {"ö"}, "1"), std::string(kOdd) + "\"ö\" = 1\n");
}

TEST(TextEdit, RemovesAValueWithItsLine) {
  EXPECT_EQ(*without_value(kText, {"scatter", 0, "size_m"}),
            replaced("size_m = [ 1, # low\n  2 ]  # high\n", ""));
  EXPECT_EQ(*without_value(kText, {"water", "level_m"}), replaced("level_m = 3\n", ""));
  EXPECT_EQ(*without_value(kText, {"water", "shore_m"}), kText);
}

TEST(TextEdit, RejectsTextsThatAreNotOneValueAndPathsThatDoNotExist) {
  for (const char* value : {"", " ", "1 ", "1 # x", "1\nb = 2", "[1", "x", "1, 2", "\"", "{", "]",
                            "1}", "\"\"\"a\nb\"\"\""}) {
    const auto changed = with_value(kText, {"world", "seed"}, value);
    ASSERT_FALSE(changed) << value;
    EXPECT_EQ(changed.error().code, core::ErrorCode::kInvalidArgument);
    EXPECT_THAT(changed.error().message, ::testing::StartsWith("world.seed: "));
  }
  EXPECT_EQ(with_value(kText, {"scatter", 2, "count"}, "1").error().message,
            "scatter[2]: there are only 2 items");
  EXPECT_EQ(with_value(kText, {"world"}, "1").error().message,
            "world: this is a table with a header, not a value");
  EXPECT_FALSE(with_value(kText, {"world", "seed", "low"}, "1"));
  EXPECT_FALSE(with_value(kText, {"world", "seed", 0}, "1"));
  EXPECT_FALSE(with_value(kText, {"scatter", "count"}, "1"));
  EXPECT_FALSE(with_value(kText, {}, "1"));
  EXPECT_FALSE(without_value(kText, {"world"}));
  EXPECT_EQ(with_value("a = ", {"b"}, "1").error().code, core::ErrorCode::kParse);
}

TEST(TextEdit, AddsDuplicatesMovesAndRemovesTables) {
  const auto added = with_table_appended(kText, {"scatter"}, "model = \"grass\"\ncount = 2");
  ASSERT_TRUE(added) << added.error().message;
  EXPECT_EQ(*added, replaced("[water]", "[[scatter]]\nmodel = \"grass\"\ncount = 2\n\n[water]"));
  EXPECT_EQ(*without_table(*added, {"scatter", 2}), kText);
  EXPECT_EQ(*table_text(kText, {"scatter", 1}), "# two\n[[scatter]]\nmodel = \"rock\"\n");
  EXPECT_EQ(*with_table_duplicated(kText, {"scatter", 1}),
            replaced("[water]", "# two\n[[scatter]]\nmodel = \"rock\"\n\n[water]"));
  const std::string moved = *with_table_moved(kText, {"scatter", 1}, 0);
  EXPECT_EQ(table_text(moved, {"scatter", 0}), table_text(kText, {"scatter", 1}));
  EXPECT_EQ(table_text(moved, {"scatter", 1}), table_text(kText, {"scatter", 0}));
  EXPECT_EQ(*with_table_moved(moved, {"scatter", 0}, 1), kText);
  EXPECT_EQ(*without_table(kText, {"water"}), replaced("\n[water]\nlevel_m = 3\n", ""));
  EXPECT_FALSE(with_table_appended(kText, {"water"}, "level_m = 1"));
  EXPECT_FALSE(with_table_appended(kText, {"scatter"}, "[sky]\nexposure = 1"));
  EXPECT_FALSE(with_table_appended(kText, {"scatter"}, "model = "));
  EXPECT_FALSE(with_table_moved(kText, {"scatter", 1}, 2));
  EXPECT_FALSE(with_table_duplicated(kText, {"scatter", 2}));
}

TEST(TextEdit, ASpeciesIsCopiedWithItsKindsAndRules) {
  const auto text = testing::shipped_text("worlds/five_species.toml");
  const auto oak = table_text(text, {"species", 0});
  ASSERT_TRUE(oak);
  EXPECT_THAT(*oak, HasSubstr("[species.colours]"));
  auto copied = with_table_appended(text, {"species"}, *oak);
  ASSERT_TRUE(copied) << copied.error().message;
  const std::size_t last = item_count(text, {"species"});
  EXPECT_EQ(item_count(*copied, {"species", last, "kind"}),
            item_count(text, {"species", 0, "kind"}));
  copied = with_value(*copied, {"species", last, "name"}, "\"oak_2\"");
  models::Registry registry = models::make_standard_registry();
  const auto world = parse_world(*copied, "copied", registry);
  ASSERT_TRUE(world) << world.error().message;
  models::Species first = world->species.front();
  first.name = "oak_2";
  EXPECT_EQ(world->species.back(), first);
}

TEST(TomlValues, AreTheShortestThatReadBackEqual) {
  EXPECT_EQ(toml_number(0.1), "0.1");
  EXPECT_EQ(toml_number(3.0), "3");
  EXPECT_EQ(toml_number(std::int64_t{-4}), "-4");
  EXPECT_EQ(toml_seed(~std::uint64_t{0}), "\"18446744073709551615\"");
  EXPECT_EQ(toml_vector(glm::vec3(0.1F, 1, 0.25F)), "[0.1, 1, 0.25]");
  EXPECT_EQ(toml_range(1, 1), "1");
  EXPECT_EQ(toml_range(1, 2.5), "[1, 2.5]");
  EXPECT_EQ(toml_range(0.9, 2.2, true), "[1, 2]");
  EXPECT_EQ(toml_string("a\"\\\n"), "\"a\\\"\\\\\\u000A\"");
}

TEST(TextPaths, AreReadAsTheyAreWritten) {
  for (const char* path :
       {"", "world", "scatter[2].branches", "species[0].kind[11].length", "a[0][1]"})
    EXPECT_EQ(parse_text_path(path).value_or(TextPath{"?"}).text(), path);
  EXPECT_EQ((TextPath{"scatter", 2, "a b"}.text()), "scatter[2].\"a b\"");
  for (const char* path : {".", "a.", ".a", "a[", "a[]", "a[x]", "[0]", "a b", "a[1]b", "a[-1]"})
    EXPECT_FALSE(parse_text_path(path)) << path;
}

}  // namespace
}  // namespace psygen::world
