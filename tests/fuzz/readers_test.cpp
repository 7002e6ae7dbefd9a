#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/mutator.hpp"
#include "tests/fuzz/reading.hpp"
#include "tests/source_file.hpp"

namespace psygen::fuzz {
namespace {

constexpr std::size_t kMaxBytes = 1 << 16;

// Sorted, so that the order does not depend on the file system.
std::vector<std::string> shipped_texts() {
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"worlds", "paths"}) {
    for (const auto& entry : std::filesystem::directory_iterator(source_file("game/") + folder))
      files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<std::string> texts;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return texts;
}

TEST(Readers, TakeEveryShippedFileAsWhatItIs) {
  FileInMemory file;
  EXPECT_EQ(read_as_everything(example_bindings(), file), 1);
  EXPECT_EQ(read_as_everything(example_frame_test(), file), 1);
  EXPECT_EQ(read_as_everything(example_recording(), file), 1);
  EXPECT_EQ(read_as_everything(example_edits(), file), 1);
  EXPECT_EQ(read_as_everything(example_gltf(), file), 1);
  EXPECT_EQ(read_as_everything(example_world(), file), 1);
  for (const std::string& text : shipped_texts())
    EXPECT_EQ(read_as_everything(text, file), 1) << text.substr(0, 200);
}

TEST(Readers, SurviveShippedFilesWithUnicodeAndOtherThingsInWrongPlaces) {
  constexpr int kTextsOfEachFile = 40;
  std::vector<std::string> texts = shipped_texts();
  for (const auto& example : {example_bindings, example_frame_test, example_recording,
                              example_edits, example_gltf, example_world})
    texts.push_back(example());
  ASSERT_GT(texts.size(), 10u);
  FileInMemory file;
  std::mt19937_64 random(1);
  int taken = 0, refused = 0;
  for (const std::string& text : texts) {
    for (int i = 0; i < kTextsOfEachFile; ++i)
      ++(read_as_everything(mutated(text, texts, kMaxBytes, random), file) > 0 ? taken : refused);
  }
  EXPECT_GT(taken, 10) << "only texts that are taken reach what comes after the parser";
  EXPECT_GT(refused, 100);
}

// Text in wrong places breaks binary formats at the first check. Changes of single bytes reach the
// later checks.
TEST(Readers, SurviveRecordingsAndEditsWithChangedBytes) {
  FileInMemory file;
  std::mt19937_64 random(2);
  for (const std::string& whole : {example_recording(), example_edits()}) {
    int taken = 0, refused = 0;
    for (int round = 0; round < 1500; ++round) {
      std::string bytes = whole;
      for (std::uint64_t changes = 1 + random() % 3; changes > 0; --changes)
        bytes[random() % bytes.size()] = static_cast<char>(random());
      if (round % 9 == 0) bytes.resize(random() % bytes.size());
      ++(read_as_everything(bytes, file) > 0 ? taken : refused);
    }
    EXPECT_GT(taken, 100);
    EXPECT_GT(refused, 100);
  }
}

TEST(Mutator, TheSameNumbersMakeTheSameText) {
  const std::vector<std::string> others{"b = 2\n", "[c]\n"};
  std::mt19937_64 one(7), two(7);
  bool differ = false;
  for (int i = 0; i < 100; ++i) {
    const std::string text = mutated("größe = 1\n", others, 50, one);
    EXPECT_EQ(text, mutated("größe = 1\n", others, 50, two));
    EXPECT_LE(text.size(), 50u);
    differ = differ || text != "größe = 1\n";
  }
  EXPECT_TRUE(differ);
}

}  // namespace
}  // namespace psygen::fuzz
