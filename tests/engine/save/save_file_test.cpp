// Files that are not saves, or not as this program writes them.
#include "engine/save/save_file.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <functional>

#include "engine/core/data_file.hpp"
#include "tests/engine/save/support.hpp"
#include "tests/faults.hpp"
#include "tests/temporary_folder.hpp"

namespace {

// Called in place of the next rename that must not replace a file; returns 0 or an error number.
std::function<int()> at_rename;

}  // namespace

extern "C" int renameat2(int from_folder, const char* from, int to_folder, const char* to,
                         unsigned flags) noexcept {
  using Function = int(int, const char*, int, const char*, unsigned);
  static const auto real = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, "renameat2"));
  if (!at_rename) return real(from_folder, from, to_folder, to, flags);
  errno = std::exchange(at_rename, nullptr)();
  return errno == 0 ? 0 : -1;
}

namespace psygen::save {
namespace {

using ::testing::HasSubstr;
using testing::write_file;

// The working directory of the process while the object lives.
class WorkingFolder {
 public:
  explicit WorkingFolder(const std::filesystem::path& folder)
      : before_(std::filesystem::current_path()) {
    std::filesystem::current_path(folder);
  }
  ~WorkingFolder() {
    std::error_code ignored;
    std::filesystem::current_path(before_, ignored);
  }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

 private:
  std::filesystem::path before_;
};

// The error message for a file, after checking that the file is not changed.
std::string refusal(const TemporaryFolder& folder, core::ErrorCode code,
                    const std::string& name = "game.save") {
  const std::string before = file_content(folder / name);
  const std::size_t files = folder.file_count();
  const auto save = SaveGame::open(folder / name, testing::kWorld);
  if (save) return "it was opened";
  EXPECT_EQ(save.error().code, code) << save.error().message;
  EXPECT_TRUE(file_content(folder / name) == before) << "the file has changed";
  EXPECT_EQ(folder.file_count(), files);
  EXPECT_EQ(save.error().message.find((folder / name).string() + ": "), 0U) << save.error().message;
  return save.error().message.substr((folder / name).string().size() + 2);
}

void make_save(const std::filesystem::path& file) {
  SaveGame save = testing::opened(file);
  ASSERT_TRUE(testing::put_generation(save, 1));
  ASSERT_TRUE(save.save());
}

// Changes a save like another program with SQLite.
void tamper(const std::filesystem::path& file, const std::string& sql) {
  auto database = Database::open(file);
  ASSERT_TRUE(database);
  sqlite3_db_config(database->get(), SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
  const auto done = database->run(sql.c_str(), "tamper");
  ASSERT_TRUE(done) << done.error().message;
}

constexpr const char* kForeign = "is not a saved game of psygen; it was not changed";

TEST(SaveFile, OtherFilesAreRejected) {
  const TemporaryFolder folder;
  const std::string magic("SQLite format 3\0", 16);
  for (const std::string& content :
       {std::string(), std::string("hello"), std::string(5000, '\0'), magic, magic + "x",
        magic + std::string(4080, 'x'), magic + std::string(4080, '\0')}) {
    write_file(folder / "game.save", content);
    EXPECT_EQ(refusal(folder, core::ErrorCode::kParse), kForeign);
  }
}

TEST(SaveFile, DatabasesOfOtherProgramsAreRejected) {
  const TemporaryFolder folder;
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open((folder / "game.save").c_str(), &other), SQLITE_OK);
  EXPECT_EQ(
      sqlite3_exec(other, "PRAGMA application_id=7; CREATE TABLE t(x)", nullptr, nullptr, nullptr),
      SQLITE_OK);
  sqlite3_close(other);
  EXPECT_EQ(refusal(folder, core::ErrorCode::kParse), kForeign);
}

TEST(SaveFile, TruncatedFilesAreRejectedAndNotChanged) {
  const TemporaryFolder folder;
  make_save(folder / "game.save");
  const std::string whole = file_content(folder / "game.save");
  for (const std::size_t lost : {1UL, 3UL, 60UL, 4000UL, 4095UL, 4096UL, 8000UL}) {
    const std::string cut = whole.substr(0, whole.size() - lost);
    write_file(folder / "game.save", cut);
    // SQLite itself detects missing whole pages.
    const std::string sentence =
        lost >= 4096 ? "cannot be opened: the file is damaged"
                     : fmt::format("the file is cut short: it has {} of its {} bytes", cut.size(),
                                   whole.size());
    EXPECT_EQ(refusal(folder, core::ErrorCode::kParse), sentence);
    EXPECT_TRUE(file_content(folder / "game.save") == cut) << lost;
  }
}

TEST(SaveFile, NamesThatLeadNowhereAreErrors) {
  const TemporaryFolder folder;
  const auto sentence = [](const std::filesystem::path& file) {
    const auto save = SaveGame::open(file, testing::kWorld);
    return save ? "opened" : save.error().message;
  };
  EXPECT_EQ(sentence(""), "the file name is empty");
  std::filesystem::create_symlink("loop", folder / "loop");
  EXPECT_THAT(sentence(folder / "loop/x.save"), HasSubstr("loop/x.save: Too many levels"));
  EXPECT_THAT(sentence(folder / std::string(300, 'a') / "x.save"), HasSubstr("name too long"));
  const int status = testing::in_child([&] {
    const std::filesystem::path gone = folder / "gone";
    std::filesystem::create_directory(gone);
    std::filesystem::current_path(gone);
    std::filesystem::remove(gone);
    return sentence("x.save") == "x.save: No such file or directory";
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "the working folder is gone";
}

TEST(SaveFile, NewerFormatsAreRejected) {
  const TemporaryFolder folder;
  make_save(folder / "game.save");
  tamper(folder / "game.save", "PRAGMA user_version=3");
  EXPECT_EQ(refusal(folder, core::ErrorCode::kParse),
            fmt::format("has format 3 of a newer version; psygen {} reads up to format 2",
                        core::version()));
}

TEST(SaveFile, AJournalOfAForeignFileIsNotChanged) {
  const TemporaryFolder folder;
  write_file(folder / "game.save", "not a save");
  write_file(folder / "game.save-journal", "not a journal");
  EXPECT_EQ(refusal(folder, core::ErrorCode::kParse), kForeign);
  EXPECT_EQ(file_content(folder / "game.save-journal"), "not a journal");
}

TEST(SaveFile, ForeignTablesAndChangedOnesAreRejected) {
  const TemporaryFolder folder;
  const std::pair<const char*, const char*> cases[] = {
      {"CREATE TABLE other(x)", "has a table 'other' that this program did not make"},
      {"CREATE VIEW game_view AS SELECT 1",
       "has a view 'game_view' that this program did not make"},
      {"CREATE TRIGGER game_trigger AFTER INSERT ON psygen_edits BEGIN DELETE FROM psygen_edits; "
       "END",
       "has a trigger 'game_trigger' that this program did not make"},
      {"CREATE VIRTUAL TABLE game_text USING fts5(x)",
       "has a table 'game_text' that this program did not make"},
      {"CREATE INDEX game_index ON psygen_edits(version)",
       "has a index 'game_index' that this program did not make"},
      {"DROP TABLE psygen_values", "lacks a table; the file is damaged"},
      {"ALTER TABLE psygen_values ADD COLUMN more ANY",
       "has a table 'psygen_values' that this program did not make"},
      {"PRAGMA journal_mode=WAL",
       "was changed by another program (its journal mode is not \"delete\")"},
      {"DELETE FROM psygen_facts WHERE name = 'world hash'",
       "does not name its world; the file is damaged"},
      {"UPDATE psygen_facts SET value = 5 WHERE name = 'world name'",
       "does not name its world; the file is damaged"},
  };
  for (const auto& [sql, sentence] : cases) {
    std::filesystem::remove(folder / "game.save");
    make_save(folder / "game.save");
    tamper(folder / "game.save", sql);
    EXPECT_EQ(refusal(folder, core::ErrorCode::kParse), sentence) << sql;
  }
}

TEST(SaveFile, ChangedRowsAreErrorsWhenRead) {
  const TemporaryFolder folder;
  make_save(folder / "game.save");
  tamper(folder / "game.save",
         "UPDATE psygen_edits SET bytes = x'00' WHERE x = 0;"
         "UPDATE psygen_edits SET version = -1 WHERE x = 2;"
         "UPDATE psygen_edits SET bytes = zeroblob(20000000) WHERE x = 4;"
         "INSERT INTO psygen_edits VALUES(5000000000, 0, 1, 1, x'');"
         "UPDATE psygen_facts SET value = 'text' WHERE name = 'entities';"
         "UPDATE psygen_values SET value = 'seven';");
  const SaveGame save = testing::opened(folder / "game.save");
  for (const std::int32_t x : {0, 2, 4}) {
    const auto edits = save.edits({x, -x});
    ASSERT_FALSE(edits) << x;
    EXPECT_EQ(edits.error().message,
              fmt::format("{}: the edits of block ({}, {}) do not match their checksum; the file "
                          "is damaged",
                          (folder / "game.save").string(), x, -x));
  }
  EXPECT_FALSE(save.for_each_edits([](auto, auto, auto) {}));
  EXPECT_FALSE(save.value("generation"));
  ecs::World world;
  EXPECT_FALSE(save.load_entities(world));
}

TEST(SaveFile, MissingFoldersAndNonFilesAreRejected) {
  const TemporaryFolder folder;
  const auto missing = SaveGame::open(folder / "none/game.save", testing::kWorld);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().message,
            fmt::format("{}: the folder {} does not exist", (folder / "none/game.save").string(),
                        (folder / "none").string()));
  std::filesystem::create_directory(folder / "folder");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink(folder / "nowhere", folder / "link");
  const auto sentence = [&](const char* name) {
    return SaveGame::open(folder / name, testing::kWorld).error().message;
  };
  EXPECT_EQ(sentence("folder"), (folder / "folder").string() + ": is not a regular file");
  EXPECT_EQ(sentence("pipe"), (folder / "pipe").string() + ": is not a regular file");
  EXPECT_EQ(sentence("link"), (folder / "link").string() + ": the file does not exist");
}

// Runs as an unprivileged user: root may write to read-only files.
std::string refusal_without_rights(const std::filesystem::path& file) {
  const std::filesystem::path answer = file.parent_path().parent_path() / "answer";
  write_file(answer, "");
  std::filesystem::permissions(answer, std::filesystem::perms::all);
  testing::in_child([&] {
    if (geteuid() == 0 && setuid(65534) != 0) return false;
    const auto save = SaveGame::open(file, testing::kWorld);
    write_file(answer, save ? "it was opened" : save.error().message);
    return true;
  });
  return file_content(answer);
}

TEST(SaveFile, ReadOnlyFilesAndFoldersAreRejected) {
  const TemporaryFolder folder;
  using std::filesystem::perms;
  std::filesystem::create_directory(folder / "saves");
  const std::filesystem::path file = folder / "saves/game.save";
  make_save(file);
  const std::string before = file_content(file);
  const perms readable = perms::owner_read | perms::group_read | perms::others_read;
  const perms enterable = perms::owner_exec | perms::group_exec | perms::others_exec;
  std::filesystem::permissions(file, readable);
  std::filesystem::permissions(folder / "saves", perms::all);
  EXPECT_EQ(refusal_without_rights(file), file.string() + ": the file is read-only");
  std::filesystem::permissions(file, perms::all);
  std::filesystem::permissions(folder / "saves", readable | enterable);
  EXPECT_EQ(refusal_without_rights(file), file.string() + ": its folder is read-only");
  const std::filesystem::path fresh = folder / "saves/new.save";
  EXPECT_EQ(refusal_without_rights(fresh),
            fresh.string() + ": cannot create a file in its folder: Permission denied");
  std::filesystem::permissions(folder / "saves", perms::all);
  EXPECT_TRUE(file_content(file) == before);
}

TEST(SaveFile, AFullDiskLeavesNoNewSave) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "saves");
  bool fits = false;
  int refused = 0;
  for (std::size_t calls = 0; !fits; ++calls) {
    const FullDisk full(folder / "saves", calls);
    const auto made = create_file(folder / "saves/game.save", testing::kWorld);
    fits = !full.was_met();
    refused += made ? 0 : 1;
    if (made) {
      EXPECT_TRUE(SaveGame::open(folder / "saves/game.save", testing::kWorld));
      std::filesystem::remove(folder / "saves/game.save");
      continue;
    }
    EXPECT_EQ(made.error().message.find((folder / "saves/game.save").string() + ": cannot"), 0U)
        << made.error().message;
    EXPECT_NE(made.error().message.find("No space left"), std::string::npos);
    EXPECT_TRUE(std::filesystem::is_empty(folder / "saves"));
  }
  EXPECT_GT(refused, 2);
}

TEST(SaveFile, AFileThatAppearsMeanwhileIsNotChanged) {
  const TemporaryFolder folder;
  write_file(folder / "game.save", "made by somebody else");
  for (const bool knows_how : {true, false}) {
    if (!knows_how) at_rename = [] { return EINVAL; };
    const auto made = create_file(folder / "game.save", testing::kWorld);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_FALSE(*made);
    EXPECT_EQ(file_content(folder / "game.save"), "made by somebody else");
    EXPECT_EQ(folder.file_count(), 1U);
  }
}

TEST(SaveFile, ASaveIsMadeWhereTheFileSystemCannotRenameWithoutReplacing) {
  const TemporaryFolder folder;
  at_rename = [] { return EINVAL; };
  const auto made = create_file(folder / "game.save", testing::kWorld);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(*made);
  EXPECT_EQ(folder.file_count(), 1U);
  EXPECT_TRUE(SaveGame::open(folder / "game.save", testing::kWorld));
}

TEST(SaveFile, ASaveThatAppearsMeanwhileIsNotANewOne) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "game.save", other = folder / "other.save";
  for (const OpenMode mode : {OpenMode::kCreateNew, OpenMode::kOpenOrCreate}) {
    std::filesystem::remove(file);
    make_save(other);
    at_rename = [&] {
      std::filesystem::rename(other, file);
      return EEXIST;
    };
    const auto save = SaveGame::open(file, testing::kWorld, mode);
    if (mode == OpenMode::kCreateNew) {
      ASSERT_FALSE(save);
      EXPECT_EQ(save.error().message, file.string() + ": already exists");
      EXPECT_EQ(folder.file_count(), 1U);
    } else {
      ASSERT_TRUE(save) << save.error().message;
      EXPECT_EQ(testing::generation_of(*save), 1);
    }
  }
}

TEST(SaveFile, NamesThatLookLikeUrisAreFileNames) {
  const TemporaryFolder folder;
  const WorkingFolder inside(folder.path());
  for (const char* name : {"file:game.save?mode=memory", "a%20b#c&d=e", "naïve %"}) {
    make_save(name);
    EXPECT_TRUE(std::filesystem::is_regular_file(folder / name));
    const auto world = world_of(name);
    ASSERT_TRUE(world) << world.error().message;
    EXPECT_EQ(*world, testing::kWorld);
  }
}

TEST(SaveFile, TheWorldOfASaveIsReadWithoutALockAndWithoutTheRest) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "game.save";
  std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
  {
    SaveGame save = testing::opened(file);
    ASSERT_TRUE(testing::put_generation(save, 1));
    ASSERT_TRUE(save.save());
    EXPECT_EQ(*world_of(file), testing::kWorld) << "open in this process";
    EXPECT_FALSE(SaveGame::open(file, testing::kWorld)) << "it has kept its lock";
    const int status = testing::in_child([&] {
      const auto world = world_of(file);
      return world && *world == testing::kWorld &&
             !SaveGame::open(file, testing::kWorld).has_value();
    });
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "open in another process";
    ASSERT_TRUE(testing::put_generation(save, 2));
    ASSERT_TRUE(save.save());
  }
  std::string text = file_content(file);
  // The last page is one of the blobs.
  for (std::size_t i = text.size() - 4096; i < text.size(); ++i)
    text[i] = '\xFF';
  write_file(file, text);
  std::filesystem::permissions(file, std::filesystem::perms::owner_read);
  EXPECT_EQ(*world_of(file), testing::kWorld) << "the end is damaged, and it is read-only";
  EXPECT_EQ(folder.file_count(), 1U);
  EXPECT_TRUE(file_content(file) == text);
}

TEST(SaveFile, TheWorldOfAnotherFileIsAnError) {
  const TemporaryFolder folder;
  const auto sentence = [&](const char* name) {
    const auto world = world_of(folder / name);
    return world ? "a world" : world.error().message.substr((folder / name).string().size() + 2);
  };
  EXPECT_EQ(sentence("none"), "the file does not exist");
  EXPECT_EQ(sentence("."), "is not a regular file");
  write_file(folder / "text", "hello");
  EXPECT_EQ(sentence("text"), kForeign);
  make_save(folder / "view");
  tamper(folder / "view",
         "DROP TABLE psygen_facts; CREATE VIEW psygen_facts AS SELECT 'world name' AS name, 'x' AS "
         "value");
  EXPECT_EQ(sentence("view"), "has a view 'psygen_facts' that this program did not make");
  make_save(folder / "newer");
  tamper(folder / "newer", "PRAGMA user_version=3");
  EXPECT_EQ(sentence("newer"),
            fmt::format("has format 3 of a newer version; psygen {} reads up to format 2",
                        core::version()));
}

}  // namespace
}  // namespace psygen::save
