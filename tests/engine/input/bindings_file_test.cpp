#include "engine/input/bindings_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.hpp"

namespace psygen::input {
namespace {

using platform::Key;
using ::testing::AllOf;
using ::testing::HasSubstr;

Actions game() {
  Actions actions;
  EXPECT_TRUE(actions.add("jump", {{Key::kSpace}, {platform::PadButton::kA}}));
  EXPECT_TRUE(actions.add("move_x", {{Key::kD},
                                     {Key::kA, -1},
                                     {PadAxisDirection::kLeftStickRight, 1, 0.25F},
                                     {PadAxisDirection::kLeftStickLeft, -1, 0.25F}}));
  EXPECT_TRUE(actions.add("look_x", {{MouseDirection::kRight, 0.1F}}));
  return actions;
}

std::vector<std::vector<Binding>> all_bindings(const Actions& actions) {
  std::vector<std::vector<Binding>> all;
  for (ActionId id = 0; id < actions.size(); ++id)
    all.emplace_back(actions.bindings(id).begin(), actions.bindings(id).end());
  return all;
}

TEST(BindingsFile, SavedBindingsLoadEqual) {
  const TemporaryFolder folder;
  Actions saved = game();
  ASSERT_TRUE(saved.set_bindings(0, {}));
  ASSERT_TRUE(saved.set_bindings(2, {{WheelDirection::kUp, -0.3F}}));
  const auto file = folder.path() / "bindings.toml";
  ASSERT_TRUE(save_bindings(saved, file));
  Actions loaded = game();
  const auto ok = load_bindings(file, loaded);
  ASSERT_TRUE(ok) << ok.error().message;
  EXPECT_EQ(all_bindings(loaded), all_bindings(saved));
}

TEST(BindingsFile, ActionsThatAreNotMentionedKeepTheirBindings) {
  Actions actions = game();
  const auto before = all_bindings(actions);
  ASSERT_TRUE(
      apply_bindings("format = 1\n[[action]]\nname = \"jump\"\n[[action.binding]]\n"
                     "control = \"Mouse 4\"\n",
                     "b.toml", actions));
  EXPECT_EQ(actions.bindings(0).size(), 1u);
  EXPECT_EQ(name_of(actions.bindings(0)[0].control), "Mouse 4");
  EXPECT_EQ(all_bindings(actions)[1], before[1]);
  ASSERT_TRUE(apply_bindings("format = 1\n[[action]]\nname = \"jump\"\n", "b.toml", actions));
  EXPECT_TRUE(actions.bindings(0).empty());
}

TEST(BindingsFile, ABadFileIsAnErrorWithItsLineAndChangesNothing) {
  const std::string good =
      "format = 1\n[[action]]\nname = \"move_x\"\n[[action.binding]]\n"
      "control = \"Left\"\n";
  const std::vector<std::pair<std::string, std::string>> bad{
      {"", "format"},
      {"format = 2\n", "2"},
      {"no toml", "b.toml:1"},
      {"format = 1\n[[action]]\n", "name"},
      {good + "[[action]]\nname = \"jmup\"\n", "did you mean \"jump\"?"},
      {good + "[[action]]\nname = \"move_x\"\n", "b.toml:6"},
      {good + "[[action.binding]]\ncontrol = \"Spce\"\n", "b.toml:7"},
      {good + "scale = 0\n", "scale"},
      {good + "scale = nan\n", "scale"},
      {good + "scale = 1e9\n", "1000"},
      {good + "dead_zone = 1\n", "0.95"},
      {good + "deadzone = 0.2\n", "dead_zone"},
      {good + "[other]\n", "other"},
      {good + "control = 7\n", "b.toml:6"}};
  for (const auto& [text, words] : bad) {
    Actions actions = game();
    const auto before = all_bindings(actions);
    const auto refused = apply_bindings(text, "b.toml", actions);
    ASSERT_FALSE(refused) << text;
    EXPECT_THAT(refused.error().message, AllOf(HasSubstr("b.toml"), HasSubstr(words))) << text;
    EXPECT_EQ(refused.error().message.find('\n'), std::string::npos);
    EXPECT_EQ(all_bindings(actions), before) << text;
  }
}

TEST(BindingsFile, EveryPrefixOfAFileIsAcceptedOrRejectedAsAWhole) {
  const std::string whole = bindings_text(game());
  for (std::size_t bytes = 0; bytes <= whole.size(); ++bytes) {
    Actions actions = game();
    for (ActionId id = 0; id < actions.size(); ++id)
      ASSERT_TRUE(actions.set_bindings(id, {{Key::kF1}}));
    const auto before = all_bindings(actions);
    if (!apply_bindings(whole.substr(0, bytes), "b.toml", actions)) {
      EXPECT_EQ(all_bindings(actions), before);
    }
  }
}

TEST(BindingsFile, MissingAndUnwritableFilesAreErrors) {
  Actions actions = game();
  const auto missing = load_bindings("/nowhere/bindings.toml", actions);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, core::ErrorCode::kIo);
  EXPECT_THAT(missing.error().message, HasSubstr("/nowhere/bindings.toml"));
  EXPECT_FALSE(save_bindings(actions, "/nowhere/bindings.toml"));
}

}  // namespace
}  // namespace psygen::input
