// The file of a document: opening, saving, and changes by other programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <QSignalSpy>
#include <csignal>

#include "editor/document/document.hpp"
#include "tests/editor/document/support.hpp"
#include "tests/faults.hpp"

namespace psygen::editor {
namespace {

using testing::good;
using ::testing::HasSubstr;
using testing::kWorld;
using testing::Place;
using testing::replaced;

TEST(DocumentFile, IsSavedByteForByte) {
  const Place place;
  Document document(place.options());
  QSignalSpy modified(&document, &Document::modified_changed);
  EXPECT_TRUE(good(document.open(place.file)));
  EXPECT_TRUE(good(document.set_value({"world", "seed"}, "6")));
  EXPECT_TRUE(document.is_modified());
  EXPECT_THAT(document.unsaved_diff(), HasSubstr("-seed = 5\n+seed = 6\n"));
  EXPECT_TRUE(good(document.save()));
  EXPECT_FALSE(document.is_modified());
  EXPECT_EQ(document.unsaved_diff(), "");
  EXPECT_EQ(testing::read(place.file), replaced(kWorld, "seed = 5", "seed = 6"));
  document.undo_stack().undo();
  EXPECT_TRUE(document.is_modified());
  EXPECT_TRUE(good(document.revert()));
  EXPECT_FALSE(document.is_modified());
  EXPECT_EQ(modified.count(), 4);
  EXPECT_TRUE(good(document.save_as(place.folder / "other.toml")));
  EXPECT_EQ(document.file(), place.folder / "other.toml");
  EXPECT_EQ(testing::read(place.folder / "other.toml"), document.text());
}

TEST(DocumentFile, ThatIsNotAWorldIsRejectedAndTheOpenOneStays) {
  const Place place;
  Document document(place.options());
  EXPECT_TRUE(good(document.open(place.file)));
  const auto refused = [&](const std::string& text) {
    testing::write(place.folder / "bad.toml", text);
    const auto opened = document.open(place.folder / "bad.toml");
    EXPECT_FALSE(opened);
    EXPECT_EQ(document.file(), place.file);
    EXPECT_EQ(document.text(), kWorld);
    return opened ? "" : opened.error().message;
  };
  EXPECT_THAT(refused("format = 2\n"), HasSubstr("newer than this program"));
  EXPECT_THAT(refused("\x7F"
                      "ELF"),
              HasSubstr("bad.toml:1"));
  EXPECT_THAT(refused(std::string(2 << 20, ' ')), HasSubstr("too large"));
  EXPECT_THAT(refused(std::string(5000, '[')), HasSubstr("bad.toml"));
  EXPECT_THAT(refused(""), HasSubstr("format"));
  EXPECT_FALSE(document.open(place.folder / "missing.toml"));
  EXPECT_FALSE(document.open(place.folder.path()));
  EXPECT_FALSE(document.open("/dev/zero"));
}

TEST(DocumentFile, AFullDiskOrAMissingFolderLosesNothing) {
  const Place place;
  Document document(place.options());
  EXPECT_TRUE(good(document.open(place.file)));
  EXPECT_TRUE(good(document.set_value({"world", "seed"}, "6")));
  for (std::size_t calls = 0;; ++calls) {
    const FullDisk full(place.folder.path(), calls);
    const auto saved = document.save();
    if (!full.was_met()) break;
    if (saved) continue;  // only writing the recovery failed
    EXPECT_EQ(saved.error().code, core::ErrorCode::kIo);
    EXPECT_THAT(saved.error().message, HasSubstr("No space left"));
    EXPECT_EQ(testing::read(place.file), kWorld);
    EXPECT_TRUE(document.is_modified());
  }
  EXPECT_TRUE(good(document.save()));
  EXPECT_FALSE(document.save_as(place.folder / "no_folder" / "world.toml"));
  EXPECT_EQ(document.file(), place.file);
}

TEST(DocumentFile, ALinkStaysALinkAndPermissionsStay) {
  const Place place;
  std::filesystem::create_symlink(place.file, place.folder / "link.toml");
  std::filesystem::permissions(place.file, std::filesystem::perms(0640));
  Document document(place.options());
  EXPECT_TRUE(good(document.open(place.folder / "link.toml")));
  EXPECT_TRUE(good(document.set_value({"world", "seed"}, "6")));
  EXPECT_TRUE(good(document.save()));
  EXPECT_TRUE(std::filesystem::is_symlink(place.folder / "link.toml"));
  EXPECT_EQ(testing::read(place.file), document.text());
  EXPECT_EQ(std::filesystem::status(place.file).permissions(), std::filesystem::perms(0640));
}

TEST(DocumentFile, ChangesByOthersAreReportedAndReloadedAsAStep) {
  const Place place;
  Document document(place.options());
  EXPECT_TRUE(good(document.open(place.file)));
  QSignalSpy told(&document, &Document::disk_changed);
  testing::write(place.file, replaced(kWorld, "seed = 5", "seed = 7"));
  ASSERT_TRUE(told.wait(20000)) << "the watch notices it by itself";
  EXPECT_EQ(told.at(0).at(0).value<DiskState>(), DiskState::kChanged);
  EXPECT_EQ(told.at(0).at(1).toBool(), false);
  EXPECT_TRUE(good(document.reload()));
  EXPECT_EQ(document.world().seed, 7U);
  EXPECT_FALSE(document.is_modified());
  document.undo_stack().undo();
  EXPECT_EQ(document.world().seed, 5U);
  EXPECT_TRUE(document.is_modified());
}

TEST(DocumentFile, AConflictIsReportedAndNeitherTextIsLost) {
  const Place place;
  Document document(place.options());
  EXPECT_TRUE(good(document.open(place.file)));
  QSignalSpy told(&document, &Document::disk_changed);
  EXPECT_TRUE(good(document.set_value({"world", "seed"}, "6")));
  const std::string theirs = replaced(kWorld, "seed = 5", "seed = 7");
  testing::write(place.file, theirs);
  EXPECT_EQ(document.check_disk(), DiskState::kChanged);
  EXPECT_EQ(document.check_disk(), DiskState::kChanged);
  ASSERT_EQ(told.count(), 1);
  EXPECT_EQ(told.at(0).at(1).toBool(), true);
  EXPECT_THAT(document.save().error().message, HasSubstr("another program changed"));
  EXPECT_EQ(testing::read(place.file), theirs);
  document.keep_editor_version();
  EXPECT_THAT(document.unsaved_diff(), HasSubstr("-seed = 7\n+seed = 6\n"));
  EXPECT_TRUE(good(document.save()));
  EXPECT_EQ(testing::read(place.file), document.text());
  testing::write(place.file, "broken = ");
  EXPECT_EQ(document.check_disk(), DiskState::kChanged);
  EXPECT_FALSE(document.reload());
  EXPECT_EQ(document.world().seed, 6U);
  std::filesystem::remove(place.file);
  EXPECT_EQ(document.check_disk(), DiskState::kRemoved);
  EXPECT_TRUE(good(document.save())) << "a file that is gone is made again";
  EXPECT_EQ(document.check_disk(), DiskState::kSame);
}

// Saves two texts in turn until it is killed.
[[noreturn]] void save_forever(Document& document, int pipe) {
  for (int i = 0;; ++i) {
    const bool saved =
        document.set_value({"world", "seed"}, i % 2 == 0 ? "8" : "9") && document.save();
    if (!saved || write(pipe, "s", 1) != 1) _exit(1);
  }
}

TEST(DocumentFile, AfterAKillDuringSavingItIsTheOldOrTheNewOne) {
  const Place place;
  const std::string one = replaced(kWorld, "seed = 5", "seed = 8");
  const std::string two = replaced(kWorld, "seed = 5", "seed = 9");
  for (int kills = 0; kills < 20; ++kills) {
    testing::write(place.file, kWorld);
    int pipes[2];
    ASSERT_EQ(pipe(pipes), 0);
    const pid_t child = fork();
    if (child == 0) {
      Document document(place.options());
      if (!document.open(place.file, true)) _exit(1);
      save_forever(document, pipes[1]);
    }
    close(pipes[1]);
    char byte = 0;
    for (int saves = 0; saves <= kills % 4; ++saves)
      ASSERT_EQ(read(pipes[0], &byte, 1), 1);
    for (int spin = 0; spin < kills * 20'000; ++spin)
      asm volatile("");
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(pipes[0]);
    const std::string left = testing::read(place.file);
    EXPECT_TRUE(left == one || left == two) << "kill " << kills << ":\n" << left;
  }
}

}  // namespace
}  // namespace psygen::editor
