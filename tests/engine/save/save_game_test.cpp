// The content of a save, before and after it is written.
#include "engine/save/save_game.hpp"

#include <gtest/gtest.h>

#include <map>

#include "tests/engine/save/support.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::save {
namespace {

using testing::bytes_of;
using testing::opened;

std::map<core::BlockCoord, Bytes> all_edits(const SaveGame& save) {
  std::map<core::BlockCoord, Bytes> all;
  const auto visited = save.for_each_edits([&](core::BlockCoord block, std::uint32_t, auto bytes) {
    EXPECT_TRUE(all.emplace(block, Bytes(bytes.begin(), bytes.end())).second) << "visited twice";
  });
  EXPECT_TRUE(visited) << visited.error().message;
  return all;
}

TEST(SaveGame, KeepsEverythingAfterClosing) {
  const TemporaryFolder folder;
  {
    SaveGame save = opened(folder / "game.save");
    ASSERT_TRUE(testing::put_generation(save, 1));
    EXPECT_EQ(testing::generation_of(save), 1);  // also before it is written
    ASSERT_TRUE(save.save());
    EXPECT_FALSE(save.has_unsaved());
    EXPECT_EQ(testing::generation_of(save), 1);
  }
  EXPECT_EQ(folder.file_count(), 1U) << "one file is left";
  EXPECT_EQ(testing::generation_of(opened(folder / "game.save")), 1);
}

struct Tree {
  int height_m = 9;
};

TEST(SaveGame, SavesOnlyTheGamesEntitiesAndAppendsThemToAWorld) {
  const TemporaryFolder folder;
  ecs::World scene;
  scene.create<Tree>(100);
  scene.create<testing::Creature>(3).column<testing::Creature>()[1].generation = 7;
  {
    SaveGame save = opened(folder / "game.save");
    ASSERT_TRUE(save.put_entities_with<testing::Creature>(scene));
    ASSERT_TRUE(save.save());
  }
  ecs::World again;
  again.declare<testing::Creature>();
  again.create<Tree>(40);
  const auto added = opened(folder / "game.save").append_entities(again);
  ASSERT_TRUE(added) << added.error().message;
  EXPECT_TRUE(*added);
  EXPECT_EQ(again.size(), 43U);
  std::int64_t sum = 0;
  again.each<const testing::Creature>([&](auto, std::span<const testing::Creature> creatures) {
    for (const testing::Creature& creature : creatures)
      sum += creature.generation;
  });
  EXPECT_EQ(sum, 7);
}

TEST(SaveGame, UnsavedChangesAreNotInTheFile) {
  const TemporaryFolder folder;
  {
    SaveGame save = opened(folder / "game.save");
    ASSERT_TRUE(testing::put_generation(save, 1));
    ASSERT_TRUE(save.save());
    ASSERT_TRUE(testing::put_generation(save, 2));
  }
  SaveGame save = opened(folder / "game.save");
  EXPECT_EQ(testing::generation_of(save), 1);
  ASSERT_TRUE(testing::put_generation(save, 4));
  save.discard();
  EXPECT_EQ(testing::generation_of(save), 1);
}

TEST(SaveGame, EditsOfBlocksAreFoundVisitedReplacedAndErased) {
  const TemporaryFolder folder;
  SaveGame save = opened(folder / "game.save");
  const core::BlockCoord far{INT32_MIN, INT32_MAX}, near{0, -1}, third{5, 5};
  ASSERT_TRUE(save.put_edits(far, UINT32_MAX, bytes_of("far")));
  ASSERT_TRUE(save.put_edits(near, 0, {}));
  ASSERT_TRUE(save.save());
  ASSERT_TRUE(save.put_edits(third, 2, bytes_of("third")));
  EXPECT_EQ((*save.edits(far))->version, UINT32_MAX);
  EXPECT_EQ((*save.edits(far))->bytes, bytes_of("far"));
  EXPECT_TRUE((*save.edits(near))->bytes.empty());
  EXPECT_FALSE(save.edits({1, 1})->has_value());
  EXPECT_EQ(all_edits(save).size(), 3U);

  ASSERT_TRUE(save.put_edits(far, 1, bytes_of("other")));
  save.erase_edits(near);
  save.erase_edits(third);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(all_edits(save), (std::map<core::BlockCoord, Bytes>{{far, bytes_of("other")}}));
    ASSERT_TRUE(save.save());
  }
}

TEST(SaveGame, EditsOfAbsurdSizeAreRejected) {
  const TemporaryFolder folder;
  SaveGame save = opened(folder / "game.save");
  ASSERT_TRUE(save.put_edits({1, 2}, 1, Bytes(kMaxEditBytes)));
  const auto large = save.put_edits({1, 2}, 1, Bytes(kMaxEditBytes + 1));
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, core::ErrorCode::kOverBudget);
  EXPECT_EQ(large.error().message,
            "the edits of block (1, 2) have 16777217 bytes; at most 16777216 are allowed");
  ASSERT_TRUE(save.save());
  EXPECT_EQ((*save.edits({1, 2}))->bytes.size(), kMaxEditBytes);
}

TEST(SaveGame, ValuesKeepTheirTypes) {
  const TemporaryFolder folder;
  const std::map<std::string, Value> values{
      {"integer", std::int64_t{-5}}, {"real", 1e300},
      {"whole real", 2.0},           {"text", std::string("naïve\0x", 8)},
      {"bytes", bytes_of("abc")},    {"no bytes", Bytes()}};
  {
    SaveGame save = opened(folder / "game.save");
    for (const auto& [name, value] : values)
      ASSERT_TRUE(save.put_value(name, value));
    ASSERT_TRUE(save.save());
  }
  SaveGame save = opened(folder / "game.save");
  for (const auto& [name, value] : values)
    EXPECT_EQ(*save.value(name), value) << name;
  EXPECT_EQ(*save.value("other"), Value());
  ASSERT_TRUE(save.put_value("real", {}));
  EXPECT_EQ(*save.value("real"), Value());
  ASSERT_TRUE(save.save());
  EXPECT_EQ(*save.value("real"), Value());
}

TEST(SaveGame, ValuesNeedANameOfSensibleLength) {
  const TemporaryFolder folder;
  SaveGame save = opened(folder / "game.save");
  EXPECT_TRUE(save.put_value(std::string(kMaxNameBytes, 'x'), 1.0));
  for (const std::string& name : {std::string(), std::string(kMaxNameBytes + 1, 'x')})
    EXPECT_EQ(save.put_value(name, 1.0).error().code, core::ErrorCode::kInvalidArgument);
}

TEST(SaveGame, EntitiesThatDoNotFitAreAnErrorAndDoNotChangeTheWorld) {
  const TemporaryFolder folder;
  SaveGame save = opened(folder / "game.save");
  ecs::World empty;
  empty.declare<testing::Creature>();
  EXPECT_EQ(save.load_entities(empty).value(), false);
  ASSERT_TRUE(testing::put_generation(save, 1));
  ecs::World without_type;
  const auto loaded = save.load_entities(without_type);
  ASSERT_FALSE(loaded);
  EXPECT_NE(loaded.error().message.find("the entities cannot be loaded: "), std::string::npos);
  EXPECT_NE(loaded.error().message.find("creature"), std::string::npos);
  EXPECT_EQ(without_type.size(), 0U);
}

TEST(SaveGame, ASaveOfAnotherWorldIsRejectedAndNotChanged) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "game.save";
  {
    SaveGame save = opened(file);
    ASSERT_TRUE(testing::put_generation(save, 1));
    ASSERT_TRUE(save.save());
  }
  const std::string before = file_content(file);
  for (const char* name : {"test world", "other"}) {
    const auto save = SaveGame::open(file, {name, 0x1235});
    ASSERT_FALSE(save);
    EXPECT_EQ(save.error().code, core::ErrorCode::kInvalidArgument);
    EXPECT_EQ(save.error().message,
              fmt::format("{}: belongs to the world 'test world' with hash 0000000000001234, not "
                          "to '{}' with hash 0000000000001235",
                          file.string(), name));
  }
  EXPECT_TRUE(file_content(file) == before);
  EXPECT_EQ(*world_of(file), testing::kWorld);
}

TEST(SaveGame, TheWorldMayBeRenamed) {
  const TemporaryFolder folder;
  ASSERT_TRUE(opened(folder / "game.save").save());
  const auto save = SaveGame::open(folder / "game.save", {"another name", testing::kWorld.hash});
  EXPECT_TRUE(save) << save.error().message;
}

TEST(SaveGame, TheModeDecidesAboutExistingAndMissingFiles) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "game.save";
  const auto missing = SaveGame::open(file, testing::kWorld, OpenMode::kOpenExisting);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().message, file.string() + ": the file does not exist");
  ASSERT_TRUE(SaveGame::open(file, testing::kWorld, OpenMode::kCreateNew));
  ASSERT_TRUE(SaveGame::open(file, testing::kWorld, OpenMode::kOpenExisting));
  const auto there = SaveGame::open(file, testing::kWorld, OpenMode::kCreateNew);
  ASSERT_FALSE(there);
  EXPECT_EQ(there.error().message, file.string() + ": already exists");
}

TEST(SaveGame, ASecondOneOnTheSameFileIsRejectedAndTheFirstKeepsItsLock) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "game.save";
  SaveGame first = opened(file);
  for (int i = 0; i < 2; ++i) {
    const auto second = SaveGame::open(file, testing::kWorld);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, core::ErrorCode::kIo);
    EXPECT_EQ(second.error().message, file.string() + ": is in use by this program");
  }
  const int status = testing::in_child([&] {
    const auto other = SaveGame::open(file, testing::kWorld);
    const std::string expected =
        fmt::format("{}: is in use by process {} (psygen_test_sav)", file.string(), getppid());
    if (!other && other.error().message != expected)
      std::fprintf(stderr, "%s\n", other.error().message.c_str());
    return !other && other.error().message == expected;
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  ASSERT_TRUE(testing::put_generation(first, 1));
  ASSERT_TRUE(first.save());
}

}  // namespace
}  // namespace psygen::save
