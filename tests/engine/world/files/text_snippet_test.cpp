#include "engine/world/files/text_snippet.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/world/files/text_edit.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using ::testing::HasSubstr;

std::string with(std::string_view text, const TextPath& path, std::string_view snippet) {
  const auto changed = with_snippet(text, path, snippet);
  EXPECT_TRUE(changed) << changed.error().message;
  return changed.value_or("");
}

TEST(TextSnippet, AValueAndATableAreCopiedWithTheirHeaders) {
  constexpr const char* kSnippetText = "[sky]\nexposure = 2 # bright\n\n[[scatter]]\ncount = 3\n";
  EXPECT_EQ(*copied_snippet(kSnippetText, {"sky", "exposure"}), "[sky]\nexposure = 2\n");
  EXPECT_EQ(*copied_snippet(kSnippetText, {"scatter", 0, "count"}), "[[scatter]]\ncount = 3\n");
  EXPECT_EQ(*copied_snippet(kSnippetText, {"sky"}), "[sky]\nexposure = 2 # bright\n");
  EXPECT_EQ(copied_snippet(kSnippetText, {"sky", "cloud_cover"}).error().code,
            core::ErrorCode::kInvalidArgument);
}

TEST(TextSnippet, KeysArePastedIntoATableOfTheSameName) {
  constexpr const char* kSnippetText = "[sky]\nexposure = 2 # bright\nstart_hour = 4\n";
  EXPECT_EQ(with(kSnippetText, {"sky"}, "[sky]\nexposure = 3\ncloud_cover = 1\n"),
            "[sky]\nexposure = 3 # bright\nstart_hour = 4\ncloud_cover = 1\n");
  EXPECT_EQ(with(kSnippetText, {"sky"}, "start_hour = 5"),
            testing::replaced(kSnippetText, "start_hour = 4", "start_hour = 5"));
  EXPECT_EQ(with(kSnippetText, {"water"}, "[water]\nlevel_m = 5"),
            std::string(kSnippetText) + "\n[water]\nlevel_m = 5\n");
  const auto refused = with_snippet(kSnippetText, {"water"}, "[sky]\nexposure = 2");
  EXPECT_EQ(refused.error().message,
            "water: the pasted text belongs to [sky], which does not fit into [water]");
  EXPECT_FALSE(with_snippet(kSnippetText, {"sky"}, "[sky]\nexposure = 2\n[water]\nlevel_m = 1\n"));
  EXPECT_FALSE(with_snippet(kSnippetText, {"sky"}, "exposure = "));
  EXPECT_FALSE(with_snippet(kSnippetText, {"scatter", 0}, "[[scatter]]\ncount = 2"));
}

TEST(TextSnippet, ASpeciesPastedOverAnotherBecomesIt) {
  const std::string text = testing::shipped_text("worlds/five_species.toml");
  models::Registry before = models::make_standard_registry();
  const auto world = parse_world(text, "before", before);
  ASSERT_TRUE(world);
  for (std::size_t from = 0; from < world->species.size(); ++from) {
    const std::size_t to = (from + 1) % world->species.size();
    std::string changed = with(text, {"species", to}, *copied_snippet(text, {"species", from}));
    changed =
        *with_value(changed, {"species", to, "name"}, *value_text(text, {"species", to, "name"}));
    models::Registry after = models::make_standard_registry();
    const auto pasted = parse_world(changed, "after", after);
    ASSERT_TRUE(pasted) << pasted.error().message << changed;
    EXPECT_EQ(pasted->species[to].kinds, world->species[from].kinds);
    EXPECT_EQ(pasted->species[to].rules, world->species[from].rules);
  }
}

TEST(TextSnippet, PresetsAreSnippetsInFiles) {
  const std::string snippet = "# grey\n[sky]\nexposure = 2\n";
  EXPECT_EQ(*read_preset(preset_text(snippet), "grey.toml"), snippet);
  EXPECT_EQ(snippet_table(snippet)->text(), "sky");
  EXPECT_EQ(snippet_table("[[species.kind]]\nlength = 1")->text(), "species.kind");
  EXPECT_THAT(read_preset("partial = 2\n[sky]\n", "new.toml").error().message,
              HasSubstr("new.toml: partial: this program does not know version 2"));
  EXPECT_THAT(read_preset(snippet, "old.toml").error().message, HasSubstr("not a preset"));
  EXPECT_FALSE(read_preset("partial = 1\n", "empty.toml"));
  EXPECT_FALSE(read_preset("partial = 1\nx = 2\n[sky]\n", "more.toml"));
}

}  // namespace
}  // namespace psygen::world
