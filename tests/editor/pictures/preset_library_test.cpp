#include "editor/pictures/preset_library.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>

#include "editor/document/parsed_world.hpp"
#include "editor/pictures/model_world.hpp"
#include "tests/editor/pictures/worlds.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::editor {
namespace {

std::vector<Preset> shipped_library() {
  std::vector<std::string> problems;
  auto presets = load_library({source_file("editor/library")}, &problems);
  EXPECT_TRUE(problems.empty()) << problems.front();
  return presets;
}

TEST(PresetLibrary, TheShippedLibraryHasPresetsOfEveryKind) {
  std::map<std::string, int> headings;
  for (const Preset& preset : shipped_library()) {
    ++headings[preset.heading];
    EXPECT_FALSE(preset.doc.empty()) << preset.file;
  }
  for (const char* heading : {"Species", "Rocks", "Terrains", "Skies"})
    EXPECT_GE(headings[heading], 5) << heading;
}

TEST(PresetLibrary, EveryPresetAppliesToEveryShippedWorld) {
  for (const std::string& name : testing::shipped_worlds()) {
    const std::string text = testing::world_text(name);
    for (const Preset& preset : shipped_library()) {
      const auto changed = with_preset(text, preset);
      ASSERT_TRUE(changed.has_value()) << preset.file << ": " << changed.error().message;
      const auto parsed = parse_world_text(*changed, name + " with " + preset.name, {});
      EXPECT_TRUE(parsed.has_value()) << parsed.error().message;
    }
  }
}

TEST(PresetLibrary, EveryPresetHasAWorldForItsImage) {
  for (const Preset& preset : shipped_library()) {
    const auto text = snippet_world(preset.snippet);
    ASSERT_TRUE(text.has_value()) << preset.file << ": " << text.error().message;
    const auto parsed = parse_world_text(*text, preset.name, {});
    ASSERT_TRUE(parsed.has_value()) << parsed.error().message;
    if (is_portrait(preset.snippet)) {
      EXPECT_TRUE(portrait_pose(**parsed, {}).has_value()) << preset.file;
    }
  }
}

TEST(PresetLibrary, ASpeciesIsAddedUnderAFreeNameAndScattered) {
  const auto presets = shipped_library();
  const auto oak = std::ranges::find(presets, "Oak", &Preset::name);
  ASSERT_NE(oak, presets.end());
  const std::string text = testing::world_text("silver_combe");
  const auto before = parse_world_text(text, "", {});
  const auto twice = with_preset(*with_preset(text, *oak), *oak);
  ASSERT_TRUE(twice.has_value()) << twice.error().message;
  const auto after = parse_world_text(*twice, "", {});
  ASSERT_TRUE(after.has_value()) << after.error().message;
  EXPECT_EQ((*after)->world.species.size(), (*before)->world.species.size() + 2);
  EXPECT_EQ((*after)->world.scatter.size(), (*before)->world.scatter.size() + 2);
  std::set<std::string> names;
  for (const auto& species : (*after)->world.species)
    EXPECT_TRUE(names.insert(species.name).second) << species.name;
}

TEST(PresetLibrary, InvalidPresetFilesAreReported) {
  const TemporaryFolder folder;
  std::ofstream(folder / "good.toml") << "partial = 1\n\n[sky]\nexposure = 2\n";
  std::ofstream(folder / "world.toml") << testing::world_text("endless");
  std::ofstream(folder / "broken.toml") << "partial = 1\n[sky\n";
  std::ofstream(folder / "notes.txt") << "hello";
  std::vector<std::string> problems;
  const auto presets = load_library({folder.path()}, &problems);
  ASSERT_EQ(presets.size(), 1U);
  EXPECT_EQ(presets[0].name, "Good");
  EXPECT_EQ(problems.size(), 2U);
}

}  // namespace
}  // namespace psygen::editor
