// Processes are killed and disks fill up at every possible moment; the file then has the old state
// or the new one.
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>

#include <csignal>

#include "engine/core/hash.hpp"
#include "engine/save/save_game.hpp"
#include "tests/engine/save/file_faults.hpp"
#include "tests/engine/save/support.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::save {
namespace {

using testing::Fault;
using testing::FileFaults;

void make_first_generation(const std::filesystem::path& file) {
  SaveGame save = testing::opened(file);
  ASSERT_TRUE(testing::put_generation(save, 1));
  const auto saved = save.save();
  ASSERT_TRUE(saved) << saved.error().message;
}

bool save_generation(const std::filesystem::path& file, std::int64_t generation) {
  auto save = SaveGame::open(file, testing::kWorld);
  return save && testing::put_generation(*save, generation) && save->save();
}

void restore(const TemporaryFolder& folder) {
  std::filesystem::remove(folder / "game.save-journal");
  std::filesystem::copy_file(folder / "first", folder / "game.save",
                             std::filesystem::copy_options::overwrite_existing);
}

// Kills a process at its n-th change of a file, for every n, while it opens, changes, saves and
// closes; then kills the one that repairs the file, and lets another repair it.
void kill_everywhere(Fault fault) {
  const TemporaryFolder folder;
  make_first_generation(folder / "first");
  std::size_t kills = 0, olds = 0, news = 0;
  for (bool whole = false; !whole; ++kills) {
    restore(folder);
    whole = WIFEXITED(testing::in_child([&] {
      const FileFaults faults(fault, kills);
      return save_generation(folder / "game.save", 2);
    }));
    testing::in_child([&] {
      const FileFaults faults(fault, kills % 5);
      return SaveGame::open(folder / "game.save", testing::kWorld).has_value();
    });
    const SaveGame save = testing::opened(folder / "game.save");
    const std::int64_t generation = testing::generation_of(save);
    EXPECT_TRUE(generation == 1 || generation == 2) << "kill " << kills;
    EXPECT_TRUE(!whole || generation == 2);
    ++(generation == 1 ? olds : news);
    ASSERT_FALSE(::testing::Test::HasFailure()) << "kill " << kills;
  }
  EXPECT_GT(olds, 20U);  // as many calls as pages that change, and more
  EXPECT_GT(news, 1U);   // the last calls are after the commit
}

TEST(SaveCrash, KilledBeforeAnyWriteLeavesTheOldOrTheNewState) {
  kill_everywhere(Fault::kKill);
}

TEST(SaveCrash, KilledInTheMiddleOfAnyWriteLeavesTheOldOrTheNewState) {
  kill_everywhere(Fault::kKillHalf);
}

// Saves one generation after the other until it is killed, and writes a byte for each.
[[noreturn]] void save_forever(const std::filesystem::path& file, int pipe) {
  auto save = SaveGame::open(file, testing::kWorld);
  if (!save) _exit(1);
  const auto value = save->value("generation");
  std::int64_t generation = value ? std::get<std::int64_t>(*value) : 0;
  while (testing::put_generation(*save, ++generation) && save->save())
    if (write(pipe, "s", 1) != 1) break;
  _exit(1);
}

TEST(SaveCrash, KilledAtAnyTimeLeavesTheLastSaveOrTheNextOne) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "game.save";
  make_first_generation(file);
  core::RandomStream random(7, 0, 0, 0, core::Purpose::kStructure);
  std::int64_t generation = 1;
  for (int kills = 0; kills < 250; ++kills) {
    int pipes[2];
    ASSERT_EQ(pipe(pipes), 0);
    const pid_t child = fork();
    if (child == 0) {
      close(pipes[0]);  // so the child ends with the test, by SIGPIPE
      save_forever(file, pipes[1]);
    }
    close(pipes[1]);
    std::int64_t told = 0;
    char byte = 0;
    for (const std::int64_t wanted = random.next_integer(1, 3); told < wanted; ++told)
      ASSERT_EQ(read(pipes[0], &byte, 1), 1);
    for (std::int64_t spin = random.next_integer(0, 2'000'000); spin > 0; --spin)
      asm volatile("");
    kill(child, SIGKILL);
    while (read(pipes[0], &byte, 1) == 1)
      ++told;
    close(pipes[0]);
    waitpid(child, nullptr, 0);
    const std::int64_t found = testing::generation_of(testing::opened(file));
    EXPECT_TRUE(found == generation + told || found == generation + told + 1)
        << found << " after " << generation << " and " << told << " saves";
    ASSERT_FALSE(::testing::Test::HasFailure()) << "kill " << kills;
    generation = found;
  }
}

TEST(SaveCrash, AFullDiskAtAnyWriteIsAnErrorAndTheNextSaveHasEverything) {
  const TemporaryFolder folder;
  make_first_generation(folder / "first");
  std::size_t refused = 0;
  bool fits = false;
  for (std::size_t calls = 0; !fits; ++calls) {
    restore(folder);
    SaveGame save = testing::opened(folder / "game.save");
    ASSERT_TRUE(testing::put_generation(save, 3));
    {
      const FileFaults full(Fault::kFullDisk, calls);
      const auto saved = save.save();
      fits = !full.was_met();
      EXPECT_TRUE(!fits || saved);
      if (!saved) {
        ++refused;
        EXPECT_EQ(saved.error().code, core::ErrorCode::kIo);
        EXPECT_EQ(saved.error().message,
                  (folder / "game.save").string() +
                      ": cannot be saved: the disk is full; the file keeps the last save");
        EXPECT_TRUE(save.has_unsaved());
      }
    }
    if (save.has_unsaved()) {
      const auto again = save.save();
      ASSERT_TRUE(again) << again.error().message;
    }
    EXPECT_EQ(testing::generation_of(save), 3);
    ASSERT_FALSE(::testing::Test::HasFailure()) << "call " << calls;
  }
  EXPECT_GT(refused, 20U);
}

TEST(SaveCrash, AFullDiskLeavesTheOldStateInTheFile) {
  const TemporaryFolder folder;
  make_first_generation(folder / "first");
  for (std::size_t calls = 0; calls < 60; calls += 7) {
    restore(folder);
    {
      SaveGame save = testing::opened(folder / "game.save");
      const FileFaults full(Fault::kFullDisk, calls);
      (void)testing::put_generation(save, 2);
      EXPECT_FALSE(save.save());
    }
    EXPECT_EQ(testing::generation_of(testing::opened(folder / "game.save")), 1);
  }
}

TEST(SaveCrash, ALimitOnTheSizeOfFilesIsAnError) {
  const TemporaryFolder folder;
  make_first_generation(folder / "game.save");
  const int status = testing::in_child([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    SaveGame save = testing::opened(folder / "game.save");
    const rlimit limit{256 << 10, 256 << 10};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) return false;
    const bool put = save.put_edits({9, 9}, 1, Bytes(1 << 20)).has_value();
    const auto saved = save.save();
    return put && !saved && saved.error().message.find("File too large") != std::string::npos &&
           testing::generation_of(save) == 1;
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(testing::generation_of(testing::opened(folder / "game.save")), 1);
}

}  // namespace
}  // namespace psygen::save
