// Saves with changed bytes: rejected, or read with the original content, or an error on reading.
#include <gtest/gtest.h>

#include "engine/core/hash.hpp"
#include "engine/core/utf8.hpp"
#include "tests/engine/save/support.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::save {
namespace {

void expect_printable(const core::Error& error) {
  EXPECT_EQ(core::shown(error.message), error.message);
  EXPECT_LT(error.message.size(), 1000U);
}

enum class Read { kWhole, kWithErrors, kWithSilentLosses };

// Reads all data with checksums. All values read must equal the written ones. A silent loss means
// that no call fails but data is missing.
Read read_everything(const SaveGame& save) {
  std::int32_t blocks = 0;
  const auto visited = save.for_each_edits([&](core::BlockCoord block, std::uint32_t, auto bytes) {
    ++blocks;
    EXPECT_EQ(Bytes(bytes.begin(), bytes.end()),
              testing::bytes_of(testing::edits_text(1, block.x)));
  });
  if (!visited) expect_printable(visited.error());
  const auto generation = save.value("generation");
  if (!generation) {
    expect_printable(generation.error());
  } else {
    EXPECT_TRUE(*generation == Value(std::int64_t{1}) || *generation == Value());
  }
  ecs::World world;
  world.declare<testing::Creature>();
  const auto loaded = save.load_entities(world);
  if (!loaded) expect_printable(loaded.error());
  (void)save.query("SELECT * FROM game_log");
  if (!visited || !generation || !loaded) return Read::kWithErrors;
  const bool whole = blocks == testing::kBlocks && *generation == Value(std::int64_t{1}) && *loaded;
  return whole ? Read::kWhole : Read::kWithSilentLosses;
}

TEST(SaveFuzz, ChangedBytesAreDetectedOrDoNotMatter) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "game.save";
  {
    SaveGame save = testing::opened(file);
    ASSERT_TRUE(testing::put_generation(save, 1));
    ASSERT_TRUE(save.save());
  }
  const std::string sound = file_content(file);
  core::RandomStream random(3, 0, 0, 0, core::Purpose::kStructure);
  int refused = 0, partial = 0, whole = 0, silent_losses = 0;
  for (int round = 0; round < 1500; ++round) {
    std::string text = sound;
    const auto last = static_cast<std::int64_t>(text.size()) - 1;
    for (std::int64_t changes = random.next_integer(1, 4); changes > 0; --changes) {
      // Half of the changes are in the headers of pages, where SQLite keeps its structure.
      const std::int64_t any = random.next_integer(0, last);
      const std::int64_t at = changes % 2 == 0 ? any : any / 4096 * 4096 + any % 64;
      text[static_cast<std::size_t>(at)] = static_cast<char>(random.next_u64());
    }
    if (round % 10 == 0) text.resize(static_cast<std::size_t>(random.next_integer(0, last)));
    testing::write_file(file, text);
    if (const auto world = world_of(file); !world) expect_printable(world.error());
    const auto save = SaveGame::open(file, testing::kWorld);
    if (!save) {
      expect_printable(save.error());
      EXPECT_TRUE(file_content(file) == text) << "a refused file is left as it is";
    }
    if (!save) {
      ++refused;
    } else {
      const Read read = read_everything(*save);
      ++(read == Read::kWhole ? whole : read == Read::kWithErrors ? partial : silent_losses);
    }
    ASSERT_FALSE(::testing::Test::HasFailure()) << "round " << round;
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(partial, 100);
  EXPECT_GT(whole, 20);
  EXPECT_EQ(silent_losses, 0);
}

}  // namespace
}  // namespace psygen::save
