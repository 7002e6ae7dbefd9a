#include "engine/history/store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "tests/engine/history/corpus.hpp"
#include "tests/engine/save/file_faults.hpp"
#include "tests/file_content.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::history {
namespace {

using save::testing::Fault;
using save::testing::FileFaults;
using ::testing::HasSubstr;

std::vector<Entry> some(std::size_t count) {
  return testing::series(std::vector<double>(count, 1.5), "instructions", "", count);
}

std::size_t entries_in(const std::filesystem::path& file) {
  const auto store = Store::open_to_read(file);
  if (!store) return 0;
  const auto entries = store->read();
  return entries ? entries->size() : 0;
}

TEST(Store, KeepsEntriesInTheOrderOfAdding) {
  const TemporaryFolder folder;
  const auto entries = testing::corpus();
  auto store = Store::open(folder / "h.sqlite");
  ASSERT_TRUE(store) << store.error().message;
  ASSERT_EQ(*store->add(entries), 1);
  EXPECT_EQ(*store->read(), entries);
  auto again = Store::open(folder / "h.sqlite");
  ASSERT_TRUE(again);
  EXPECT_EQ(*again->add(some(3)), entries.back().order + 1);
  EXPECT_EQ(again->read()->back().order, entries.back().order + 3);
}

TEST(Store, AMissingHistoryIsMadeOnlyByAdding) {
  const TemporaryFolder folder;
  const auto missing = Store::open_to_read(folder / "none.sqlite");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("none.sqlite: cannot be opened: No such file"));
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(Store, OtherFilesAreRefusedAndKept) {
  const TemporaryFolder folder;
  const auto file = folder / "notes.txt";
  std::ofstream(file) << "a text that is longer than the header of a database: "
                      << std::string(200, 'x');
  const std::string before = file_content(file);
  const auto text = Store::open(file);
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, core::ErrorCode::kParse);
  EXPECT_EQ(file_content(file), before);
  const auto other = folder / "other.sqlite";
  std::ofstream(other).close();
  auto database = sqlite::Database::open(other);
  ASSERT_TRUE(database && database->run("CREATE TABLE t(x)", "test"));
  EXPECT_THAT(Store::open(other).error().message, HasSubstr("the file is not a history of psygen"));
}

TEST(Store, OtherVersionsAreRefused) {
  const TemporaryFolder folder;
  const auto file = folder / "h.sqlite";
  ASSERT_TRUE(Store::open(file)->add(some(1)));
  ASSERT_TRUE(sqlite::Database::open(file)->run("PRAGMA user_version=2", "test"));
  const auto newer = Store::open(file);
  ASSERT_FALSE(newer);
  EXPECT_EQ(newer.error().code, core::ErrorCode::kParse);
  EXPECT_THAT(newer.error().message,
              HasSubstr("the history has format 2; this version of psygen reads format 1"));
}

TEST(Store, DamagedFilesAreRefused) {
  const TemporaryFolder folder;
  const auto file = folder / "h.sqlite", damaged = folder / "damaged.sqlite";
  ASSERT_TRUE(Store::open(file)->add(testing::corpus()));
  const std::string whole = file_content(file);
  for (const std::size_t size : {whole.size() / 2, whole.size() - 1, std::size_t{5000}}) {
    std::ofstream(damaged, std::ios::binary) << whole.substr(0, size);
    const auto store = Store::open_to_read(damaged);
    const auto entries = store ? store->read() : tl::unexpected(store.error());
    ASSERT_FALSE(entries) << size;
    EXPECT_THAT(entries.error().message, HasSubstr("damaged.sqlite"));
  }
  std::string changed = whole;
  for (std::size_t i = 4096; i < 8192; ++i)
    changed[i] = 'x';
  std::ofstream(damaged, std::ios::binary) << changed;
  const auto store = Store::open(damaged);
  ASSERT_FALSE(store);
  EXPECT_THAT(store.error().message, HasSubstr("the file is damaged"));
  EXPECT_EQ(file_content(damaged), changed);
}

TEST(Store, AFullDiskLosesNothing) {
  const TemporaryFolder folder;
  const auto file = folder / "h.sqlite";
  ASSERT_TRUE(Store::open(file)->add(some(2)));
  bool all_fits = false;
  int refusals = 0;
  for (std::size_t calls = 0; !all_fits; ++calls) {
    core::Result<std::int64_t> added = 0;
    {
      const FileFaults full(Fault::kFullDisk, calls);
      auto store = Store::open(file);
      added = store ? store->add(some(50)) : tl::unexpected(store.error());
      all_fits = !full.was_met();
    }
    ASSERT_LT(calls, 100U);
    if (added) continue;
    ++refusals;
    EXPECT_THAT(added.error().message, HasSubstr("h.sqlite"));
    EXPECT_THAT(added.error().message,
                ::testing::AnyOf(HasSubstr("the disk is full"),
                                 // SQLite does not tell why it cannot
                                 // remove its journal.
                                 HasSubstr("disk I/O error"), HasSubstr("No space left on device")))
        << calls;
    EXPECT_EQ(entries_in(file), 2U) << calls;
  }
  EXPECT_GT(refusals, 0);
  EXPECT_EQ(entries_in(file), 52U);
}

// The process dies in the middle of adding, at each of its calls.
TEST(Store, AKilledProcessLosesNothing) {
  const TemporaryFolder folder;
  const auto file = folder / "h.sqlite";
  ASSERT_TRUE(Store::open(file)->add(some(2)));
  bool died = true;
  int deaths = 0;
  for (std::size_t calls = 0; died; ++calls) {
    ASSERT_LT(calls, 100U);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const FileFaults faults(Fault::kKillHalf, calls);
      auto store = Store::open(file);
      _exit(store && store->add(some(50)) ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    died = WIFSIGNALED(status);
    deaths += died ? 1 : 0;
    // Either nothing is added or all; a reader needs the right to roll back.
    auto store = Store::open(file);
    ASSERT_TRUE(store) << store.error().message;
    const std::size_t count = store->read()->size();
    if (count == 52U) break;
    EXPECT_EQ(count, 2U) << calls;
  }
  EXPECT_GT(deaths, 0);
  EXPECT_EQ(entries_in(file), 52U);
}

TEST(Store, SeveralProcessesAddAtOnce) {
  const TemporaryFolder folder;
  const auto file = folder / "h.sqlite";
  constexpr int kProcesses = 4, kJobs = 10;
  std::vector<pid_t> children;
  for (int i = 0; i < kProcesses; ++i) {
    children.push_back(fork());
    ASSERT_GE(children.back(), 0);
    if (children.back() != 0) continue;
    bool ok = true;
    for (int job = 0; job < kJobs; ++job) {
      auto store = Store::open(file);  // the first one makes it
      ok = ok && store && store->add(some(3));
    }
    _exit(ok ? 0 : 1);
  }
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  const auto entries = Store::open_to_read(file)->read();
  ASSERT_TRUE(entries);
  ASSERT_EQ(entries->size(), std::size_t{kProcesses * kJobs * 3});
  for (std::size_t i = 0; i < entries->size(); ++i)
    EXPECT_EQ((*entries)[i].order, static_cast<std::int64_t>(i) + 1);
}

// Runs as an unprivileged user: root may write to read-only files.
TEST(Store, ReadOnlyHistoriesCanBeRead) {
  const TemporaryFolder folder;
  const auto file = folder / "h.sqlite";
  ASSERT_TRUE(Store::open(file)->add(some(2)));
  std::filesystem::permissions(file, std::filesystem::perms(0444));
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0555));
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (getuid() == 0 && setuid(65534) != 0) _exit(2);
    const auto refused = Store::open(file);
    const bool said =
        !refused && refused.error().message == file.string() + ": the file is read-only";
    _exit(said && entries_in(file) == 2 ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

TEST(Store, WrongEntriesAreRefusedAndNothingIsAdded) {
  const TemporaryFolder folder;
  auto store = Store::open(folder / "h.sqlite");
  ASSERT_TRUE(store);
  auto entries = some(2);
  entries[1].order = 1;
  EXPECT_THAT(store->add(entries).error().message, HasSubstr("two values of instructions"));
  entries = some(2);
  entries[1].test.clear();
  EXPECT_THAT(store->add(entries).error().message, HasSubstr("needs a test and a figure"));
  entries = some(1);
  entries[0].report = std::string(kMaxTextBytes + 1, 'r');
  EXPECT_THAT(store->add(entries).error().message, HasSubstr("at most 4096 are allowed"));
  EXPECT_TRUE(store->read()->empty());
}

TEST(Store, RenamesATest) {
  const TemporaryFolder folder;
  auto store = Store::open(folder / "h.sqlite");
  ASSERT_TRUE(store && store->add(some(2)));
  EXPECT_EQ(*store->rename("walk", "stroll"), 2);
  EXPECT_EQ(store->read()->front().test, "stroll");
  EXPECT_THAT(store->rename("strol", "x").error().message,
              HasSubstr("no test 'strol'; did you mean stroll?"));
}

}  // namespace
}  // namespace psygen::history
