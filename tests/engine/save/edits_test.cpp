// Edits of a world in a saved game: felled, placed and dug parts are kept over a restart.
#include "engine/world/edits/edits.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "engine/save/save_game.hpp"
#include "engine/save/world_identity.hpp"
#include "engine/world/edits/edit_bytes.hpp"
#include "tests/engine/world/edits/edited_world.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::save {
namespace {

class SavedEdits : public ::testing::Test, protected world::testing::EditedWorld {
 protected:
  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "game.save";

  SaveGame open() {
    auto save = SaveGame::open(file_, identity_of(world, registry));
    EXPECT_TRUE(save) << save.error().message;
    return std::move(*save);
  }
  // Stores the blocks that differ.
  void store(const world::Edits& before, const world::Edits& now) {
    SaveGame save = open();
    for (const core::BlockCoord block : world::changed_blocks(before, now)) {
      const auto bytes = world::encode_block(now, registry, block);
      if (bytes.empty()) {
        save.erase_edits(block);
      } else {
        EXPECT_TRUE(save.put_edits(block, world::kEditFormat, bytes));
      }
    }
    EXPECT_TRUE(save.save());
  }
  world::Edits loaded() {
    world::Edits read;
    const SaveGame save = open();
    const auto visited = save.for_each_edits(
        [&](core::BlockCoord block, std::uint32_t, std::span<const std::byte> bytes) {
          const auto ok = world::load_block(read, world, registry, block, bytes);
          EXPECT_TRUE(ok) << ok.error().message;
        });
    EXPECT_TRUE(visited);
    return read;
  }
};

TEST_F(SavedEdits, AFelledTreeStaysFelledAfterARestart) {
  const std::uint32_t tree = unedited({2, 3})[5].index;
  ASSERT_TRUE(edits.remove(world, {{2, 3}, tree}));
  ASSERT_TRUE(edits.raise(world, {{2, 4}, {30, 0, 0.5}}, 20, 5));
  store({}, edits);
  const world::Edits again = loaded();
  EXPECT_EQ(world::testing::hash_of(again), world::testing::hash_of(edits));
  world::set_edits(world, again.layer());
  const std::vector<world::Placement> models = placements({2, 3});
  EXPECT_EQ(models.size() + 1, unedited({2, 3}).size());
  for (const world::Placement& model : models)
    EXPECT_NE(model.index, tree);
}

TEST_F(SavedEdits, UndoneEditsAreNotStored) {
  ASSERT_TRUE(edits.remove(world, {{2, 3}, 5}));
  ASSERT_TRUE(edits.remove(world, {{9, 9}, 5}));
  store({}, edits);
  const world::Edits before = edits;
  ASSERT_TRUE(edits.restore({{2, 3}, 5}));
  store(before, edits);
  EXPECT_EQ(world::testing::hash_of(loaded()), world::testing::hash_of(edits));
  EXPECT_EQ(loaded().counts().removed, 1u);
}

// The identity of a save is the identity of the world's function.
TEST_F(SavedEdits, ASaveBelongsToTheSameWorldWithAndWithoutEdits) {
  store({}, edits);
  ASSERT_TRUE(edits.flatten(world, {{2, 3}, {5, 0, 5}}, 12, 30));
  apply();
  EXPECT_TRUE(SaveGame::open(file_, identity_of(world, registry)));
}

}  // namespace
}  // namespace psygen::save
