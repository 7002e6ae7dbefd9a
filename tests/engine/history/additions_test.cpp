#include "engine/history/additions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/temporary_folder.hpp"

namespace psygen::history {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;

// A summary with some of the fields of a run.
struct Summary {
  double cpu_s = 2, p50_ms = 8, models = 1017;
  std::string cpu = "X", revision = "\"0123456789ab\"", clean = "true";
  std::string reasons = "{}", more = {};

  std::string text() const {
    return R"({"schema":"psygen.summary/1","device":{"name":"llvmpipe","driver":"1.0"},"machine":{"cpu":")" +
           cpu + R"(","cores":2,"quota_cores":null},"build":{"revision":)" + revision +
           R"(,"clean":)" + clean + R"(},"load":{"cpu_seconds":)" + std::to_string(cpu_s) +
           R"(},"run":{"preset":"low","width":320,"height":180},"frame_ms":{"p50":)" +
           std::to_string(p50_ms) + R"(,"p99":null},"synthesis":{"models":)" +
           std::to_string(models) + R"(},"hash":{"world":"f00d"},"reasons":)" + reasons + more +
           "}\n";
  }
};

fs::path write_run(const fs::path& folder, const Summary& summary) {
  fs::create_directories(folder);
  std::ofstream(folder / "summary.json") << summary.text();
  return folder;
}

std::string write_file(const fs::path& file, const std::string& text) {
  std::ofstream(file) << text;
  return file.string();
}

const Entry* find(const Additions& additions, const std::string& figure) {
  const auto found = std::ranges::find(additions.entries, figure, &Entry::figure);
  return found == additions.entries.end() ? nullptr : &*found;
}

core::Result<Additions> read(const std::vector<fs::path>& paths, const AddOptions& options = {}) {
  return read_additions(paths, options);
}

TEST(Additions, RunsOfOneJobBecomeTheirMedian) {
  const TemporaryFolder folder;
  const auto runs = read({write_run(folder / "run_1/walk", {.cpu_s = 2}),
                          write_run(folder / "run_2/walk", {.cpu_s = 9}),
                          write_run(folder / "run_3/walk", {.cpu_s = 3})});
  ASSERT_TRUE(runs) << runs.error().message;
  EXPECT_EQ(runs->runs, 3U);
  const Entry* cpu = find(*runs, "load.cpu_seconds");
  ASSERT_NE(cpu, nullptr);
  EXPECT_EQ(cpu->value, 3);
  EXPECT_EQ(cpu->unit, "s");
  EXPECT_EQ(cpu->test, "walk");
  EXPECT_EQ(cpu->revision, "0123456789ab");
  EXPECT_EQ(cpu->work, 1017);
  EXPECT_EQ(cpu->fingerprint,
            "world hash: f00d; size: 320x180; CPU: X; cores: 2; quota of cores: unknown; device: "
            "llvmpipe; driver: 1.0; preset: low");
  EXPECT_FALSE(find(*runs, "frame_ms.p99")->value);
}

TEST(Additions, FoldersNameTheTests) {
  const TemporaryFolder folder;
  write_run(folder / "out/walk/run_1", {});
  write_run(folder / "out/walk/run_2", {});
  write_run(folder / "out/ruins", {});
  const auto all = read({folder / "out"});
  ASSERT_TRUE(all);
  EXPECT_EQ(find(*all, "load.cpu_seconds")->test, "ruins");
  EXPECT_EQ(all->entries.back().test, "walk");
  EXPECT_EQ(all->entries.back().order, 2);
  EXPECT_EQ(read({folder / "out/walk/run_1"})->entries[0].test, "walk");
  EXPECT_EQ(read({folder / "out/ruins/summary.json"})->entries[0].test, "ruins");
}

TEST(Additions, OtherMachinesAndRevisionsAreOtherEntries) {
  const TemporaryFolder folder;
  const auto runs = read({write_run(folder / "a", {}), write_run(folder / "b", {.cpu = "Y"}),
                          write_run(folder / "c", {.clean = "false"})},
                         {.test = "walk"});
  ASSERT_TRUE(runs);
  EXPECT_EQ(runs->entries.back().order, 3);
  EXPECT_EQ(runs->entries.back().revision, "0123456789ab-dirty");
}

TEST(Additions, OnTheVirtualClockOnlyRealFiguresNeedTheMachine) {
  const TemporaryFolder folder;
  const auto run =
      read({write_run(folder / "walk", {.reasons = R"({"gpu_ms.p50":"the clock is virtual"})"})});
  ASSERT_TRUE(run);
  EXPECT_EQ(find(*run, "frame_ms.p50")->unit, "virtual ms");
  EXPECT_EQ(find(*run, "frame_ms.p50")->fingerprint, "world hash: f00d; size: 320x180");
  EXPECT_THAT(find(*run, "load.cpu_seconds")->fingerprint, HasSubstr("CPU: X"));
}

TEST(Additions, ReferencesAndFiguresOfTheGameAreRead) {
  const TemporaryFolder folder;
  const auto run = read({write_run(
      folder / "walk", {.more = R"(,"reference":{"arith":{"cpu_s":0.25},"stream":{"cpu_s":0.5},)"
                                R"("pair":{"cpu_s":1,"wall_s":0.125}},)"
                                R"("figures":{"path_ms":{"unit":"ms","p50":1.5}})"})});
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(find(*run, "load.cpu_seconds")->reference, 1.75);
  EXPECT_EQ(find(*run, "frame_ms.p50")->reference, 0.125);
  EXPECT_EQ(find(*run, "figures.path_ms.p50")->value, 1.5);
  EXPECT_EQ(find(*run, "figures.path_ms.p50")->unit, "ms");
}

TEST(Additions, MissingValuesAndOtherWorkAreSaid) {
  const TemporaryFolder folder;
  Summary without;
  without.models = 500;
  const fs::path second = write_run(folder / "run_2/walk", without);
  std::string text = without.text();
  text.replace(text.find("\"p50\":8.000000"), 14, "\"p50\":null");
  std::ofstream(second / "summary.json") << text;
  const auto runs = read({write_run(folder / "run_1/walk", {}), second});
  ASSERT_TRUE(runs);
  EXPECT_EQ(find(*runs, "frame_ms.p50")->value, 8);
  EXPECT_THAT(runs->notes, Contains("walk: frame_ms.p50 has no value in 1 of 2 runs"));
  EXPECT_THAT(runs->notes, Contains(HasSubstr("made 500 to 1017 models")));
}

TEST(Additions, CapturesHaveTimesOnlyAndSaySo) {
  const TemporaryFolder folder;
  std::string csv = "Application,ProcessID,MsBetweenPresents\n";
  for (int i = 0; i < 200; ++i)
    csv += "game.exe,1," + std::to_string(10 + i % 3) + "\n";
  const fs::path file = write_file(folder / "capture.csv", csv);
  const auto unnamed = read({file});
  ASSERT_FALSE(unnamed);
  EXPECT_THAT(unnamed.error().message, HasSubstr("name them with --test and --revision"));
  const auto capture = read({file}, {.test = "menu", .revision = "1.2", .machine = "bench 3"});
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(find(*capture, "frame_ms.p50")->value, 11);
  EXPECT_THAT(find(*capture, "frame_ms.p50")->fingerprint,
              HasSubstr("interval: present to present; machine: bench 3"));
  EXPECT_THAT(capture->notes, Contains(HasSubstr("times only")));
}

TEST(Additions, OutputsOfCallgrindAreInstructions) {
  const TemporaryFolder folder;
  const fs::path file =
      write_file(folder / "a.callgrind", "# callgrind format\nevents: Ir\ntotals: 67846898\n");
  const auto counted = read({file}, {.test = "generators", .revision = "r1", .machine = "X"});
  ASSERT_TRUE(counted) << counted.error().message;
  EXPECT_EQ(counted->entries[0].figure, "instructions");
  EXPECT_EQ(counted->entries[0].value, 67846898);
  EXPECT_EQ(counted->entries[0].fingerprint, "counter: callgrind; CPU: X");
}

TEST(Additions, BadRunsAreRefusedWithTheirNames) {
  const TemporaryFolder folder;
  const auto message = [](const fs::path& path, const AddOptions& options = {}) {
    const auto additions = read({path}, options);
    return additions ? std::string() : additions.error().message;
  };
  EXPECT_THAT(message(write_run(folder / "a", {.revision = "null"})),
              HasSubstr("a/summary.json: the run does not tell the revision"));
  EXPECT_THAT(message(write_run(folder / "b", {}), {.figures = {"frame_ms.p42"}}),
              HasSubstr("the run has no number 'frame_ms.p42'"));
  EXPECT_THAT(message(folder / "none"), HasSubstr("none"));
  fs::create_directories(folder / "c");
  write_file(folder / "c/summary.json", Summary().text().substr(0, 100));
  EXPECT_THAT(message(folder / "c"), HasSubstr("it is not JSON, or is truncated"));
  write_file(folder / "c/summary.json", R"({"schema":"psygen.summary/9"})");
  EXPECT_THAT(message(folder / "c"), HasSubstr("it must be \"psygen.summary/1\""));
}

TEST(Additions, DifferencesOfFingerprintsAreNamed) {
  EXPECT_EQ(fingerprint_difference("CPU: X; cores: 2", "CPU: Y; cores: 2"),
            "different CPU: X and Y");
  EXPECT_EQ(fingerprint_difference("m1", "m2"), "m1 and m2");
}

}  // namespace
}  // namespace psygen::history
