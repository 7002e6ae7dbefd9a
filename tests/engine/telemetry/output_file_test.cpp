#include "engine/telemetry/output_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "engine/core/replace_file.hpp"
#include "tests/engine/telemetry/synthetic_flight.hpp"

namespace psygen::telemetry {
namespace {

TEST(OutputFolder, LosesPartialFilesOfAKilledProcess) {
  const TemporaryFolder folder;
  // No process id exceeds the kernel's limit of 2^22.
  ASSERT_TRUE(core::replace_file(folder / ".trace.json.99999999-0.partial", "half"));
  ASSERT_TRUE(create_output_folder(folder.path()));
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(OutputFolder, IsCreatedWithTheFoldersAboveItAndMayExist) {
  const TemporaryFolder folder;
  ASSERT_TRUE(create_output_folder(folder / "a/b/c"));
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b/c"));
  EXPECT_TRUE(create_output_folder(folder / "a/b/c"));
}

TEST(OutputFolder, CannotReplaceAFileOrBeInAnUnwritablePlace) {
  const TemporaryFolder folder;
  ASSERT_TRUE(core::replace_file(folder / "file", "x"));
  for (const auto& path :
       {folder / "file", folder / "file/below", std::filesystem::path("/proc/psygen/out")}) {
    const auto result = create_output_folder(path);
    ASSERT_FALSE(result) << path;
    EXPECT_EQ(result.error().code, core::ErrorCode::kIo);
    EXPECT_NE(result.error().message.find(path.string()), std::string::npos);
  }
}

TEST(OutputFolder, BelongsToOneFlightAtATime) {
  const TemporaryFolder folder;
  {
    const auto first = OutputFolder::open(folder / "out");
    ASSERT_TRUE(first);
    const auto second = OutputFolder::open(folder / "out");
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().message,
              (folder / "out").string() + ": another flight writes into this folder");
    EXPECT_TRUE(OutputFolder::open(folder / "other"));
  }
  EXPECT_TRUE(OutputFolder::open(folder / "out"));
}

TEST(OutputFile, IsCheckedWithItsFolderBeforeTheWork) {
  const TemporaryFolder folder;
  EXPECT_TRUE(check_output_file(folder / "a/b/picture.png"));
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b"));
  EXPECT_FALSE(check_output_file(folder / "a/b")) << "a folder";
  EXPECT_FALSE(check_output_file("/dev/full"));
}

TEST(OutputFile, ThatIsAnInputIsRejectedUnderAnyName) {
  const TemporaryFolder folder;
  const std::filesystem::path input = folder / "world.toml", link = folder / "link.csv";
  std::ofstream(input) << "format = 1";
  std::filesystem::create_symlink(input, link);
  std::filesystem::create_hard_link(input, folder / "other.csv");
  const std::filesystem::path inputs[] = {"", folder / "missing", input};
  for (const std::filesystem::path& file :
       {input, link, folder / "other.csv", folder.path() / "." / "world.toml"}) {
    const auto checked = check_no_input(file, inputs);
    ASSERT_FALSE(checked) << file;
    EXPECT_EQ(checked.error().message, file.string() + ": is read here, and is not replaced");
  }
  EXPECT_TRUE(check_no_input(folder / "missing", inputs));
  EXPECT_TRUE(check_no_input(folder / "new.csv", inputs));
}

}  // namespace
}  // namespace psygen::telemetry
