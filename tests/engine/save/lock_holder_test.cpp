#include "engine/save/lock_holder.hpp"

#include <gtest/gtest.h>

#include "tests/engine/save/support.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::save {
namespace {

TEST(LockHolder, IsThisProgramIfItHasTheSaveOpen) {
  const TemporaryFolder folder;
  const SaveGame save = testing::opened(folder / "game.save");
  EXPECT_EQ(lock_holder(folder / "game.save"), "this program");
}

TEST(LockHolder, IsUnknownForUnlockedAndMissingFiles) {
  const TemporaryFolder folder;
  testing::write_file(folder / "file", "text");
  EXPECT_EQ(lock_holder(folder / "file"), "another program");
  EXPECT_EQ(lock_holder(folder / "missing"), "another program");
}

}  // namespace
}  // namespace psygen::save
