#include "editor/document/recovery.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <QSignalSpy>
#include <csignal>

#include "editor/document/document.hpp"
#include "tests/editor/document/support.hpp"

namespace psygen::editor {
namespace {

using testing::good;
using ::testing::HasSubstr;
using testing::kWorld;
using testing::Place;
using testing::replaced;

// Runs `work` with a document in a process that is then killed.
template <class Work>
void killed_after(const Place& place, const Work& work) {
  const pid_t child = fork();
  if (child == 0) {
    Document document(place.options());
    const bool done = work(document);
    kill(getpid(), done ? SIGKILL : SIGTERM);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
}

TEST(Recovery, UnsavedChangesOfAKilledEditorReturnAsAStep) {
  const Place place;
  killed_after(place, [&](Document& document) {
    return document.open(place.file) && document.set_value({"world", "seed"}, "6") &&
           document.write_recovery();
  });
  Document document(place.options());
  const auto left = document.recoveries();
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left[0].world_file, place.file);
  EXPECT_TRUE(left[0].time.isValid());
  EXPECT_TRUE(good(document.recover(left[0])));
  EXPECT_EQ(document.text(), replaced(kWorld, "seed = 5", "seed = 6"));
  EXPECT_TRUE(document.is_modified());
  EXPECT_TRUE(document.recoveries().empty());
  document.undo_stack().undo();
  EXPECT_EQ(document.text(), kWorld);
}

// A relative path, an absolute one and a link name one file; a file of the same name does not.
TEST(Recovery, KnowsItsFileByAnyPath) {
  const Place place;
  const std::filesystem::path other = place.folder / "other";
  std::filesystem::create_directory(other);
  testing::write(other / "world.toml", kWorld);
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(place.folder.path());
  killed_after(place, [](Document& document) {
    return document.open("world.toml") && document.set_value({"world", "seed"}, "6") &&
           document.write_recovery();
  });
  std::filesystem::current_path(other);
  Document document(place.options());
  const auto left = document.recoveries();
  ASSERT_EQ(left.size(), 1U);
  EXPECT_TRUE(left[0].world_file.is_absolute());
  EXPECT_TRUE(same_file(left[0].world_file, place.file));
  EXPECT_FALSE(same_file(left[0].world_file, "world.toml"));
  EXPECT_FALSE(same_file(left[0].world_file, {}));
  std::filesystem::create_symlink(place.file, other / "link.toml");
  EXPECT_TRUE(good(document.open("link.toml")));
  EXPECT_TRUE(same_file(left[0].world_file, document.file()));
  EXPECT_TRUE(good(document.recover(left[0])));
  EXPECT_EQ(document.file(), "link.toml");
  EXPECT_EQ(document.undo_stack().count(), 1);
  std::filesystem::current_path(before);
}

TEST(Recovery, OfAnEarlierEditorWithARelativePathHasNoFile) {
  const Place place;
  Document document(place.options());
  testing::write(place.state / "a.recovery",
                 R"({"format": 1, "world_file": "world.toml", "text": "format = 1"})");
  ASSERT_EQ(document.recoveries().size(), 1U);
  EXPECT_TRUE(document.recoveries()[0].world_file.empty());
}

TEST(Recovery, AWorldWithoutAFileReturnsToo) {
  const Place place;
  std::string text;
  {
    Document document(place.options());
    EXPECT_TRUE(good(document.set_value({"world", "seed"}, "77")));
    text = document.text();
  }
  killed_after(place, [](Document& document) {
    return document.set_value({"world", "seed"}, "77") && document.write_recovery();
  });
  Document document(place.options());
  ASSERT_EQ(document.recoveries().size(), 1U) << "a clean end leaves nothing";
  EXPECT_TRUE(good(document.recover(document.recoveries()[0])));
  EXPECT_EQ(document.text(), text);
  EXPECT_TRUE(document.file().empty() && document.is_modified());
}

TEST(Recovery, IsWrittenAutomaticallyAndRemovedWhenNothingIsUnsaved) {
  const Place place;
  DocumentOptions options = place.options();
  options.autosave_ms = 1;
  Document document(options);
  EXPECT_TRUE(good(document.open(place.file)));
  EXPECT_TRUE(good(document.set_value({"world", "seed"}, "6")));
  const auto written = [&] {
    for (const auto& entry : std::filesystem::directory_iterator(place.state))
      if (entry.path().extension() == ".recovery") return true;
    return false;
  };
  QTimer timer;
  QSignalSpy ticks(&timer, &QTimer::timeout);
  timer.start(2);
  for (int i = 0; i < 10000 && !written(); ++i)
    (void)ticks.wait();
  EXPECT_TRUE(written());
  EXPECT_TRUE(document.recoveries().empty()) << "its session runs";
  EXPECT_TRUE(good(document.save()));
  EXPECT_FALSE(written());
}

TEST(Recovery, ASecondEditorOfAFileIsRejected) {
  const Place place;
  Document first(place.options()), second(place.options());
  EXPECT_TRUE(good(first.open(place.file)));
  EXPECT_TRUE(good(first.open(place.file))) << "again in the same one";
  std::filesystem::create_symlink(place.file, place.folder / "link.toml");
  const auto refused = second.open(place.folder / "link.toml");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              HasSubstr("another editor has this file open (process " + std::to_string(getpid())));
  EXPECT_FALSE(second.save_as(place.file));
  EXPECT_TRUE(good(second.open(place.file, true)));
  testing::write(place.folder / "other.toml", kWorld);
  killed_after(
      place, [&](Document& other) { return other.open(place.folder / "other.toml").has_value(); });
  EXPECT_TRUE(good(first.save_as(place.folder / "other.toml"))) << "a killed editor holds nothing";
}

TEST(Recovery, DamagedFilesAndAReadOnlyFolderLoseNothing) {
  const Place place;
  {
    Document document(place.options());
    testing::write(place.state / "a.recovery", "{\"format\":");
    testing::write(place.state / "b.recovery", "{\"format\": 2}");
    testing::write(place.state / "c.recovery", "");
    EXPECT_TRUE(document.recoveries().empty());
    Recovery broken;
    broken.text = "broken = ";
    EXPECT_FALSE(document.recover(broken));
  }
  EXPECT_TRUE(std::filesystem::exists(place.state / "b.recovery")) << "a newer editor may read it";
  DocumentOptions options;
  options.state_folder = place.file / "no_folder";  // below a file
  Document document(options);
  QSignalSpy failed(&document, &Document::autosave_failed);
  EXPECT_TRUE(good(document.open(place.file)));
  EXPECT_TRUE(good(document.set_value({"world", "seed"}, "6")));
  EXPECT_FALSE(document.write_recovery());
  EXPECT_TRUE(good(document.save()));
  EXPECT_TRUE(document.recoveries().empty());
}

}  // namespace
}  // namespace psygen::editor
