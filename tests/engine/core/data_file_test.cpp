#include "engine/core/data_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>

#include "tests/temporary_folder.hpp"

namespace psygen::core {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

// Sets an environment variable until the end of the test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name_)) old_ = old;
    setenv(name_, value.c_str(), 1);
  }
  ~Variable() {
    if (old_) {
      setenv(name_, old_->c_str(), 1);
    } else {
      unsetenv(name_);
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

void put(const fs::path& file) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << "x\n";
}

fs::path own_folder() {
  return fs::read_symlink("/proc/self/exe").parent_path();
}

TEST(DataFile, SearchesTheGivenFolderTheVariablesTheExecutablesAndThePackages) {
  const Variable variable("PSYGEN_DATA", "/first:/second/./folder:");
  EXPECT_THAT(
      data_folders("/given", "/package"),
      ElementsAre("/given", "/first", "/second/folder", own_folder(),
                  (own_folder() / PSYGEN_DATA_FROM_EXECUTABLE).lexically_normal(), "/package"));
}

TEST(DataFile, FoldersOfTheVariableAreNotInstalled) {
  const Variable variable("PSYGEN_DATA", "/first");
  EXPECT_THAT(
      installed_folders("worlds", "/package"),
      ElementsAre(own_folder() / "worlds",
                  (own_folder() / PSYGEN_DATA_FROM_EXECUTABLE).lexically_normal() / "worlds",
                  "/package/worlds"));
}

TEST(DataFile, SkipsEmptyAndRepeatedFolders) {
  const Variable variable("PSYGEN_DATA", "::/given::/given");
  EXPECT_THAT(data_folders("/given", ""),
              ElementsAre("/given", own_folder(),
                          (own_folder() / PSYGEN_DATA_FROM_EXECUTABLE).lexically_normal()));
}

TEST(DataFile, TakesTheFirstFolderThatHasTheFile) {
  const TemporaryFolder folder;
  const fs::path name = "worlds/psygen_test_data_file.toml";
  const Variable variable("PSYGEN_DATA", (folder / "variable").string());
  put(folder / "package" / name);
  EXPECT_EQ(data_file(name, folder / "given", folder / "package"), folder / "package" / name);
  put(folder / "variable" / name);
  EXPECT_EQ(data_file(name, folder / "given", folder / "package"), folder / "variable" / name);
  put(folder / "given" / name);
  EXPECT_EQ(data_file(name, folder / "given", folder / "package"), folder / "given" / name);
}

TEST(DataFile, FindsTheWorldsOfPsygenNextToTheExecutable) {
  const Variable variable("PSYGEN_DATA", "");
  const auto file = data_file("worlds/paper.toml", "", "");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(*file, own_folder() / "worlds/paper.toml");
}

TEST(DataFile, ListsAllFoldersIfNoneHasTheFile) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "given/worlds/none.toml");  // a folder is not a file
  const Variable variable("PSYGEN_DATA", "/from/the/variable");
  const auto file = data_file("worlds/none.toml", folder / "given", "/of/the/package");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, ErrorCode::kIo);
  for (const std::string& words :
       {std::string("worlds/none.toml: no such data file; looked in "), (folder / "given").string(),
        std::string("/from/the/variable"), own_folder().string(), std::string("/of/the/package"),
        std::string("set PSYGEN_DATA")})
    EXPECT_THAT(file.error().message, HasSubstr(words));
}

TEST(DataFile, RejectsNamesThatLeaveTheFolders) {
  for (const char* name : {"", "/etc/passwd", "../secret", "worlds/../../secret"}) {
    const auto file = data_file(name);
    ASSERT_FALSE(file) << name;
    EXPECT_EQ(file.error().code, ErrorCode::kInvalidArgument) << name;
  }
}

TEST(UserFolder, IsCreatedInTheConfiguredFolder) {
  const TemporaryFolder folder;
  const Variable home("HOME", folder.path().string());
  {
    const Variable data("XDG_DATA_HOME", (folder.path() / "data").string());
    EXPECT_EQ(*user_folder(UserFolder::kData, "game"), folder.path() / "data" / "game");
    EXPECT_TRUE(fs::is_directory(folder.path() / "data" / "game"));
  }
  // A relative path does not count, as the specification says.
  const Variable data("XDG_DATA_HOME", "data"), config("XDG_CONFIG_HOME", "");
  EXPECT_EQ(*user_folder(UserFolder::kData, "game"), folder.path() / ".local/share/game");
  EXPECT_EQ(*user_folder(UserFolder::kConfig, "game"), folder.path() / ".config/game");
  EXPECT_EQ(*user_folder(UserFolder::kConfig, "game", folder.path() / "mine"),
            folder.path() / "mine");
}

TEST(UserFolder, ItsPathIsToldWithoutCreatingIt) {
  const TemporaryFolder folder;
  const Variable home("HOME", folder.path().string()), state("XDG_STATE_HOME", "");
  EXPECT_EQ(*user_folder_path(UserFolder::kState, "game"), folder.path() / ".local/state/game");
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(UserFolder, ReportsAMissingFolder) {
  const TemporaryFolder folder;
  const Variable home("HOME", ""), data("XDG_DATA_HOME", "");
  const auto none = user_folder(UserFolder::kData, "game");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("XDG_DATA_HOME"));
  std::ofstream(folder.path() / "file") << "x";
  const auto blocked = user_folder(UserFolder::kData, "game", folder.path() / "file" / "sub");
  ASSERT_FALSE(blocked);
  EXPECT_EQ(blocked.error().code, ErrorCode::kIo);
  EXPECT_THAT(blocked.error().message, HasSubstr("file"));
}

}  // namespace
}  // namespace psygen::core
