#include "engine/core/replace_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "tests/faults.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::core {
namespace {

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::vector<std::uint8_t> text(std::string_view characters) {
  return {characters.begin(), characters.end()};
}

TEST(ReplaceFile, WritesANewFileReplacesAnOldOneAndLeavesNothingElse) {
  const TemporaryFolder folder;
  ASSERT_TRUE(replace_file(folder / "a.bin", text("old")));
  EXPECT_EQ(bytes_of(folder / "a.bin"), text("old"));
  ASSERT_TRUE(replace_file(folder / "a.bin", text("new and longer")));
  EXPECT_EQ(bytes_of(folder / "a.bin"), text("new and longer"));
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(ReplaceFile, WorksNextToALeftoverOfAnInterruptedWrite) {
  const TemporaryFolder folder;
  const FileReplacement other(folder / "a.bin");  // takes the first free name
  ASSERT_TRUE(replace_file(folder / "a.bin", text("new")));
  EXPECT_EQ(bytes_of(folder / "a.bin"), text("new"));
}

TEST(ReplaceFile, NamesThePathWhenTheFolderDoesNotExist) {
  const TemporaryFolder folder;
  const auto path = folder / "missing" / "a.bin";
  const auto result = replace_file(path, text("x"));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kIo);
  EXPECT_NE(result.error().message.find(path.string()), std::string::npos);
}

TEST(ReplaceFile, WritesTheFileBehindAChainOfLinksAndKeepsTheLinks) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "there");
  std::filesystem::create_symlink("there/second", folder / "first");
  std::filesystem::create_symlink(folder / "there/real", folder / "there/second");
  for (const char* content : {"new", "newer"}) {  // the file appears, and is replaced
    ASSERT_TRUE(replace_file(folder / "first", text(content)));
    EXPECT_EQ(bytes_of(folder / "there/real"), text(content));
  }
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "first"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "there/second"));
  std::filesystem::create_symlink("loop", folder / "loop");
  EXPECT_FALSE(replace_file(folder / "loop", text("x")));
}

TEST(ReplaceFile, KeepsThePermissionsOfAnExistingFile) {
  const TemporaryFolder folder;
  for (const mode_t mode : {0640, 0600, 0755}) {
    ASSERT_TRUE(replace_file(folder / "a.bin", text("old")));
    ASSERT_EQ(chmod((folder / "a.bin").c_str(), mode), 0);
    ASSERT_TRUE(replace_file(folder / "a.bin", text("new")));
    struct stat status {};
    ASSERT_EQ(stat((folder / "a.bin").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777U, mode);
  }
}

TEST(ReplaceFile, IsCheckedBeforeTheContentExists) {
  const TemporaryFolder folder;
  EXPECT_TRUE(check_replaceable(folder / "new"));
  EXPECT_FALSE(check_replaceable(folder.path()));
  EXPECT_EQ(check_replaceable(folder / "none" / "new").error().message,
            (folder / "none" / "new").string() + ": its folder is missing");
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(ReplaceFile, DoesNotWaitForAReaderOfAPipe) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(replace_file(folder / "pipe", text("x")).error().code, ErrorCode::kIo);
}

TEST(ReplaceFile, DoesNotReplaceDevicesAndFolders) {
  const TemporaryFolder folder;
  EXPECT_EQ(replace_file("/dev/full", text("x")).error().code, ErrorCode::kIo);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  EXPECT_EQ(replace_file(folder.path(), text("x")).error().code, ErrorCode::kIo);
}

// Repeats the write with room for one more call each time, until all calls have room.
TEST(ReplaceFile, KeepsTheOldContentAndReportsTheReasonIfTheDiskFillsAtAnyPoint) {
  const TemporaryFolder folder;
  const auto path = folder / "a.bin";
  bool all_fits = false;
  for (std::size_t calls = 0; !all_fits; ++calls) {
    ASSERT_TRUE(replace_file(path, text("old")));
    const FullDisk full(folder.path(), calls);
    const auto result = replace_file(path, std::vector<std::uint8_t>(100'000, 1));
    EXPECT_EQ(bytes_of(path).size(), result ? 100'000u : 3u) << calls;
    EXPECT_EQ(folder.file_count(), 1U) << calls;
    if (!result) {
      EXPECT_EQ(result.error().code, ErrorCode::kIo);
      EXPECT_EQ(result.error().message.find(path.string() + ": cannot "), 0U);
      EXPECT_NE(result.error().message.find("No space left on device"), std::string::npos);
    }
    all_fits = !full.was_met();
  }
  EXPECT_EQ(bytes_of(path).size(), 100'000u);
}

TEST(ReplaceFile, KeepsTheOldContentIfTheFileSizeIsLimited) {
  const TemporaryFolder folder;
  ASSERT_TRUE(replace_file(folder / "a.bin", text("old")));
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{1000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const auto result = replace_file(folder / "a.bin", std::vector<std::uint8_t>(100'000, 1));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kIo);
  EXPECT_EQ(bytes_of(folder / "a.bin"), text("old"));
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(FileReplacement, HoldsEveryPieceInOrderWhateverTheirSizes) {
  const TemporaryFolder folder;
  std::string expected;
  FileReplacement file(folder / "a.txt");
  for (const std::size_t size : {0u, 1u, 40'000u, 65'536u, 65'537u, 7u, 200'000u, 3u}) {
    const std::string piece(size, static_cast<char>('a' + expected.size() % 26));
    file.write(piece);
    expected += piece;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
  ASSERT_TRUE(file.commit());
  const auto bytes = bytes_of(folder / "a.txt");
  EXPECT_TRUE(std::string(bytes.begin(), bytes.end()) == expected);
}

TEST(FileReplacement, LeavesNothingWithoutACommit) {
  const TemporaryFolder folder;
  {
    FileReplacement file(folder / "a.txt");
    file.write("half");
    ASSERT_TRUE(file.flush());
  }
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(FileReplacement, IgnoresWritesAfterAnErrorUntilTheCommit) {
  FileReplacement file("/nowhere/a.txt");
  file.write("lost");
  EXPECT_FALSE(file.commit());
}

TEST(ReplaceFile, RemovesOnlyLeftoversOfKilledProcesses) {
  const TemporaryFolder folder;
  const std::string mine = ".a.bin." + std::to_string(getpid()) + "-0.partial";
  // No process has a number beyond the kernel's limit of 2^22.
  for (const std::string& name :
       {std::string(".a.bin.99999999-0.partial"), mine, std::string("b.99999999-0.partial"),
        std::string(".x.partial"), std::string("a.bin"),
        std::string(".a.bin.99999999-0@another.partial")}) {
    std::ofstream(folder / name) << "half";
  }
  remove_stale_partials(folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / ".a.bin.99999999-0.partial"));
  EXPECT_EQ(folder.file_count(), 5u);  // the file of another host, whose processes are unknown,
                                       // stays
  remove_partials_of(folder.path(), [](const std::string& file) { return file == "a.bin"; });
  EXPECT_EQ(folder.file_count(), 3u);
  EXPECT_FALSE(std::filesystem::exists(folder / mine));
}

TEST(ReplaceFile, RemovesLeftoversOfZombies) {
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) _exit(0);
  siginfo_t ended{};  // a zombie until a wait without WNOWAIT
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT), 0);
  std::ofstream(folder / fmt::format(".a.bin.{}-0.partial", child)) << "half";
  remove_stale_partials(folder.path());
  EXPECT_EQ(folder.file_count(), 0u);
  EXPECT_EQ(waitpid(child, nullptr, 0), child);
}

}  // namespace
}  // namespace psygen::core
