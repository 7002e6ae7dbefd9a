#include "engine/core/nearest_word.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace psygen::core {
namespace {

TEST(NearestWord, FindsTyposAndRejectsOtherWords) {
  const std::vector<std::string> known{"count", "max_height_m", "min_height_m", "model"};
  EXPECT_EQ(nearest_word("cuont", known), "count");
  EXPECT_EQ(nearest_word("max_heigth_m", known), "max_height_m");
  EXPECT_EQ(nearest_word("modle", known), "model");
  EXPECT_EQ(nearest_word("zebra", known), "");
}

TEST(NearestWord, AShortWordIsNearFewWordsAndASwapIsOneEdit) {
  const std::vector<std::string> options{"--out", "--help", "--seed", "tree"};
  EXPECT_EQ(nearest_word("--set", options), "");
  EXPECT_EQ(nearest_word("--hepl", options), "--help");
  EXPECT_EQ(nearest_word("-help", options), "--help");
  EXPECT_EQ(nearest_word("tre", options), "tree");
  EXPECT_EQ(nearest_word("walk", std::vector<std::string>{"wall", "walk27"}), "wall");
  EXPECT_EQ(nearest_word("walk", std::vector<std::string>{"dash", "walk27"}), "walk27");
  EXPECT_EQ(nearest_word("-world", std::vector<std::string>{"--worlds", "--world"}), "--world");
  EXPECT_EQ(nearest_word("wa", std::vector<std::string>{"dash", "walk27"}), "");
  EXPECT_EQ(nearest_word("", options), "");
  EXPECT_EQ(nearest_word("--", options), "");
}

TEST(NearestWord, ASuggestionEndsAMessage) {
  const std::vector<std::string_view> presets{"low", "high"};
  EXPECT_EQ(suggestion("hihg", presets), "; did you mean high?");
  EXPECT_EQ(suggestion("zebra", presets), "");
}

TEST(NearestWord, FindsNothingForAVeryLongWordOrAmongNoWords) {
  EXPECT_EQ(nearest_word(std::string(100'000, 'x'), std::vector<std::string>{"x"}), "");
  EXPECT_EQ(nearest_word("count", std::vector<std::string>{}), "");
}

}  // namespace
}  // namespace psygen::core
