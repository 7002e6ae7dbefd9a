// Hostile files beside a save: SQLite must not act on them.
#include "engine/save/journal.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "engine/save/bound_value.hpp"
#include "tests/engine/save/support.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::save {
namespace {

using ::testing::HasSubstr;
using testing::write_file;

// A save of generation 1 whose process died while it wrote other pages: its journal restores it.
class JournalTest : public ::testing::Test {
 protected:
  void SetUp() override {
    {
      SaveGame save = testing::opened(file_);
      ASSERT_TRUE(testing::put_generation(save, 1));
      ASSERT_TRUE(save.save());
    }
    testing::in_child([&] {
      auto database = Database::open(file_);
      const bool written = database && database->run(
                                           "PRAGMA journal_mode=DELETE; PRAGMA cache_size=1; BEGIN;"
                                           "UPDATE psygen_edits SET bytes = zeroblob(6000)",
                                           "change");
      _exit(written ? 0 : 1);  // without a rollback
      return written;
    });
    ASSERT_EQ(file_content(journal_).substr(0, 4), "\xd9\xd5\x05\xf9") << "the journal is not hot";
  }

  // The end of a journal that takes part in a transaction of several files.
  static std::string name_of_super_journal(const std::string& name) {
    std::uint32_t sum = 0;
    for (const char c : name)
      sum += static_cast<std::uint32_t>(static_cast<signed char>(c));
    const auto number = [](std::uint32_t value) {
      std::string bytes;
      for (int shift = 24; shift >= 0; shift -= 8)
        bytes += static_cast<char>(value >> shift & 0xff);
      return bytes;
    };
    return number((1U << 30) / 4096 + 1) + name + number(static_cast<std::uint32_t>(name.size())) +
           number(sum) + "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7";
  }

  // The error message; the save must stay as it is.
  std::string refusal(const std::filesystem::path& file) const {
    const std::string before = file_content(file_);
    const auto save = SaveGame::open(file, testing::kWorld);
    EXPECT_EQ(file_content(file_), before);
    return save ? "it was opened" : save.error().message;
  }
  std::string refusal() const { return refusal(file_); }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "game.save",
                              journal_ = folder_ / "game.save-journal";
};

TEST_F(JournalTest, AJournalOfAKilledProcessRestoresTheSave) {
  const SaveGame save = testing::opened(file_);
  EXPECT_EQ(testing::generation_of(save), 1);
}

TEST_F(JournalTest, NoFileThatAJournalNamesIsRemoved) {
  const std::filesystem::path letter = folder_ / "letter.txt";
  const std::string hot = file_content(journal_);
  write_file(letter, "dear reader");
  for (const std::string& start : {hot, "x" + hot.substr(1)}) {
    write_file(journal_, start + name_of_super_journal(letter));
    EXPECT_THAT(refusal(), HasSubstr("its journal game.save-journal names a file for removal"));
    EXPECT_EQ(file_content(letter), "dear reader");
    EXPECT_TRUE(world_of(file_));
    EXPECT_EQ(file_content(letter), "dear reader");
  }
  // The shortest journal that SQLite obeys: a name of one letter, and nothing else.
  write_file(journal_, name_of_super_journal("v").substr(4));
  EXPECT_THAT(refusal(), HasSubstr("names a file for removal"));
  write_file(journal_, hot + name_of_super_journal(letter));
  std::filesystem::create_symlink("game.save", folder_ / "link.save");
  EXPECT_THAT(refusal(folder_ / "link.save"), HasSubstr("names a file for removal"));
  // SQLite alone removes it.
  write_file(journal_, hot + name_of_super_journal(letter));
  auto database = Database::open(file_);
  ASSERT_TRUE(database);
  EXPECT_TRUE(database->run("SELECT * FROM sqlite_schema", "read"));
  EXPECT_FALSE(std::filesystem::exists(letter));
}

TEST_F(JournalTest, AJournalThatEnlargesTheSaveWithoutBoundIsRefused) {
  std::string hot = file_content(journal_);
  hot.replace(16, 4, "\x7f\xff\xff\xff");
  write_file(journal_, hot);
  EXPECT_THAT(refusal(), HasSubstr("restores 8796093018112 bytes, but it and the save hold only"));
  hot.replace(24, 4, std::string("\0\0\x02\0", 4));
  write_file(journal_, hot);
  EXPECT_THAT(refusal(), HasSubstr("has pages of another size"));
}

TEST_F(JournalTest, AJournalThatIsNoFileIsRefusedAndItsTargetKept) {
  std::filesystem::rename(journal_, folder_ / "diary.txt");
  const std::string diary = file_content(folder_ / "diary.txt");
  std::filesystem::create_symlink("diary.txt", journal_);
  EXPECT_THAT(refusal(), HasSubstr("is not a regular file"));
  EXPECT_EQ(file_content(folder_ / "diary.txt"), diary);
  std::filesystem::remove(journal_);
  ASSERT_EQ(mkfifo(journal_.c_str(), 0600), 0);
  EXPECT_THAT(refusal(), HasSubstr("is not a regular file"));
}

TEST_F(JournalTest, AWriteAheadLogBesideTheSaveIsRefused) {
  std::filesystem::remove(journal_);
  write_file(folder_ / "game.save-wal", "");
  EXPECT_THAT(refusal(), HasSubstr("another program left a write-ahead log"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "game.save-wal"));
}

TEST(SaveFile, ConstraintsOfAGamesTablesAreNotComputedWhenASaveIsOpened) {
  const TemporaryFolder folder;
  {
    SaveGame save = testing::opened(folder / "game.save");
    ASSERT_TRUE(save.execute("CREATE TABLE game_t(x CHECK(x < 0 OR length(randomblob(9)) = 9))"));
    ASSERT_TRUE(save.execute("INSERT INTO game_t VALUES(1)"));
    ASSERT_TRUE(save.save());
  }
  {
    auto database = Database::open(folder / "game.save");
    ASSERT_TRUE(database);
    sqlite3_db_config(database->get(), SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
    // A constraint that row 1 breaks: an open that computed it would report damage.
    ASSERT_TRUE(
        database->run("UPDATE sqlite_schema SET sql = 'CREATE TABLE game_t(x CHECK(x < 0))'"
                      " WHERE name = 'game_t'",
                      "tamper"));
  }
  SaveGame save = testing::opened(folder / "game.save");
  EXPECT_FALSE(save.execute("INSERT INTO game_t VALUES(1)")) << "constraints hold in statements";
}

}  // namespace
}  // namespace psygen::save
