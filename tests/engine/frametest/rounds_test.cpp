// Flies tests several times, on the virtual clock: runs, attempts, folders, bases, and the record
// of the machine.
#include "engine/frametest/rounds.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/file_content.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::frametest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

// A flight of five frames, which takes milliseconds. Its width tells tests apart.
std::string text_of_test(int width, const std::string& keys, const std::string& budgets) {
  return "format = 1\n[flight]\nsize = [" + std::to_string(width) +
         ", 36]\nview_distance = 64\nframes = 5\nwarmup = 0\nfixed_step = 30\n"
         "clock = \"virtual\"\nbudget_mib = 16\n[test]\nreference = false\n" +
         keys + budgets;
}

constexpr const char* kHolds = "[at_most]\nframe_ms.max = 1000\n";
constexpr const char* kNeverHolds = "[at_most]\nload.cpu_seconds = 0\n";

class Rounds : public testing::Test {
 protected:
  Rounds() {
    options_.out = folder_ / "out";
    options_.worst_frames = 0;
    hooks_.start = [this](app::Session& session) -> core::Result<void> {
      widths_.push_back(session.options().size.width);
      return {};
    };
  }
  void add(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / (name + ".toml")) << text;
    options_.files.push_back(folder_ / (name + ".toml"));
  }
  int run() {
    widths_.clear();
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_frame_tests(options_, hooks_);
    out_ = testing::internal::GetCapturedStdout();
    err_ = testing::internal::GetCapturedStderr();
    return code;
  }
  std::vector<std::string> outputs(const std::string& name) const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(options_.out / name))
      names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
  }
  bool has_run(const std::string& name) const {
    return std::filesystem::exists(options_.out / name / "summary.json");
  }

  TemporaryFolder folder_;
  RunOptions options_;
  Hooks hooks_;
  std::vector<std::uint32_t> widths_;  // of the flights, in order
  std::string out_, err_;
};

TEST_F(Rounds, FlyTestsInTurnAndKeepEachRun) {
  add("a", text_of_test(64, "runs = 3\n", kHolds));
  add("b", text_of_test(65, "", kHolds));
  add("c", text_of_test(66, "runs = 2\n", kHolds));
  EXPECT_EQ(run(), kHeld);
  EXPECT_THAT(widths_, ElementsAre(64, 65, 66, 64, 66, 64));
  EXPECT_THAT(outputs("a"), ElementsAre("run-1", "run-2", "run-3"));
  EXPECT_TRUE(has_run("a/run-3") && has_run("b") && has_run("c/run-2"));
  EXPECT_THAT(out_, StartsWith("b: frame_ms.max ")) << "told when its flights are over";
  EXPECT_THAT(out_, HasSubstr("\nc: frame_ms.max 0.9"));
  EXPECT_THAT(out_, HasSubstr(" (runs 0.9"));
}

TEST_F(Rounds, OfFewerRunsLeaveNoOlderOnesBehind) {
  add("a", text_of_test(64, "runs = 3\n", kHolds));
  ASSERT_EQ(run(), kHeld);
  std::ofstream(options_.out / "a" / "run-3" / "notes.txt") << "mine";
  add("a", text_of_test(64, "runs = 2\n", kHolds));
  options_.files.pop_back();
  ASSERT_EQ(run(), kHeld);
  EXPECT_THAT(outputs("a"), ElementsAre("run-1", "run-2", "run-3"));
  EXPECT_THAT(outputs("a/run-3"), ElementsAre("notes.txt")) << "files of others stay";
  add("a", text_of_test(64, "", kHolds));
  options_.files.pop_back();
  ASSERT_EQ(run(), kHeld);
  EXPECT_TRUE(has_run("a"));
  EXPECT_FALSE(has_run("a/run-1"));
  add("a", text_of_test(64, "runs = 2\n", kHolds));
  options_.files.pop_back();
  ASSERT_EQ(run(), kHeld);
  EXPECT_FALSE(has_run("a")) << "a run of its own would count as a third one";
}

TEST_F(Rounds, TryAgainOnlyWhereAnotherAttemptCanHelp) {
  add("a", text_of_test(64, "runs = 2\nretries = 2\n", kNeverHolds));
  add("b", text_of_test(65, "retries = 2\n", "[at_most]\nframe_ms.max = 0\n"));
  EXPECT_EQ(run(), kMissed);
  EXPECT_EQ(std::ranges::count(widths_, 64u), 6);
  EXPECT_EQ(std::ranges::count(widths_, 65u), 1) << "virtual times are the same in each run";
  EXPECT_TRUE(has_run("a/run-6"));
  EXPECT_THAT(out_, HasSubstr("Chance of a false alarm: "));
}

TEST_F(Rounds, ShowTheWorstFramesInTheFolderOfTheirRun) {
  add("a", text_of_test(64, "runs = 2\n", "[at_most]\nframe_ms.max = 0\n"));
  options_.worst_frames = 1;
  EXPECT_EQ(run(), kMissed);
  EXPECT_TRUE(std::filesystem::exists(options_.out / "a" / "run-2" / "failed.html"));
  EXPECT_THAT(out_, HasSubstr("a/run-2/failed.html"));
}

TEST_F(Rounds, StopAtAFailure) {
  add("a", text_of_test(64, "runs = 3\n", kHolds));
  hooks_.prepare = [](app::SessionOptions&) -> core::Result<void> {
    return core::invalid_argument("the game has no world");
  };
  EXPECT_EQ(run(), kFailed);
  EXPECT_THAT(err_, HasSubstr("a: the game has no world"));
  EXPECT_EQ(err_.find("a: the game"), err_.rfind("a: the game")) << "once";
}

TEST_F(Rounds, HaveLimitsRelativeToABase) {
  add("a", text_of_test(64, "runs = 2\n", kHolds));
  ASSERT_EQ(run(), kHeld);
  add("a", text_of_test(64, "",
                        "[at_most]\nframe_ms.max = \"1.00 × base\"\n"
                        "[at_least]\nframe_ms.max = \"1.01 * base\"\n"));
  options_.files.pop_back();
  options_.base = folder_ / "out";
  options_.out = folder_ / "new";
  EXPECT_EQ(run(), kMissed);
  EXPECT_THAT(out_, HasSubstr("(1 × base)\n")) << out_;
  EXPECT_THAT(out_, HasSubstr("(1.01 × base)  MISSED\n")) << out_;
}

TEST_F(Rounds, MayNameTheBaseInTheFile) {
  add("a", text_of_test(64, "", kHolds));
  ASSERT_EQ(run(), kHeld);
  add("a", text_of_test(64, "base = \"out\"\n", "[at_most]\nframe_ms.max = \"1 x base\"\n"));
  options_.files.pop_back();
  options_.out = folder_ / "new";
  EXPECT_EQ(run(), kHeld) << err_;
}

TEST_F(Rounds, RefuseABaseThatIsMissingOrOfOtherConditions) {
  const char* relative = "[at_most]\nframe_ms.max = \"1.05 × base\"\n";
  add("a", text_of_test(64, "", relative));
  EXPECT_EQ(run(), kFailed);
  EXPECT_THAT(err_,
              HasSubstr("the budget of frame_ms.max in line 13 is relative to a base; name one "
                        "with --base DIR"));
  options_.base = folder_ / "base";
  EXPECT_EQ(run(), kFailed);
  EXPECT_THAT(err_, HasSubstr("base/a: there is no base of the test a; make one with: psygen test "
                              "FILE --out "));
  EXPECT_TRUE(widths_.empty()) << "before the flight";

  options_.files.clear();
  options_.base.clear();
  options_.out = folder_ / "base";
  add("a", text_of_test(96, "", kHolds));
  ASSERT_EQ(run(), kHeld);
  options_.files.clear();
  options_.base = folder_ / "base";
  options_.out = folder_ / "out";
  add("a", text_of_test(64, "", relative));
  EXPECT_EQ(run(), kFailed);
  EXPECT_THAT(err_,
              HasSubstr("base/a: this run has other conditions than the base: different size: "
                        "96x36 and 64x36"));
}

TEST_F(Rounds, DoWithoutABaseThatNoLimitNeeds) {
  add("a", text_of_test(64, "", kHolds));
  options_.base = folder_ / "base";
  EXPECT_EQ(run(), kHeld);
  EXPECT_EQ(err_.find("base"), std::string::npos) << err_;
}

TEST_F(Rounds, RecordTheRunsOfTheMachine) {
  add("a", text_of_test(64, "runs = 2\n", kHolds));
  add("b", text_of_test(65, "", kNeverHolds));
  options_.usual = folder_ / "usual.jsonl";
  EXPECT_EQ(run(), kMissed);
  const std::string text = file_content(options_.usual);
  EXPECT_EQ(std::ranges::count(text, '\n'), 2);
  EXPECT_THAT(text, HasSubstr("\"test\":\"a\",\"pair_s\":null,\"cpu_s\":"));
  EXPECT_THAT(text, testing::Not(HasSubstr("\"cpu_s\":null")));
  EXPECT_THAT(text, testing::Not(HasSubstr("\"test\":\"b\"")))
      << "a run that does not hold is not usual, and there was no reference load";
  std::ofstream(options_.usual) << "damaged\n";
  EXPECT_EQ(run(), kFailed);
  EXPECT_TRUE(widths_.empty());
  EXPECT_THAT(err_, HasSubstr("usual.jsonl:1: this is no run of psygen.usual/1"));
}

TEST_F(Rounds, KeepTheirTestsFromTheirOutputs) {
  add("a", text_of_test(64, "", kHolds));
  const std::string before = file_content(options_.files[0]);
  options_.words.markdown = options_.files[0];
  EXPECT_EQ(run(), kFailed);
  EXPECT_THAT(err_, HasSubstr("is read here, and is not replaced"));
  EXPECT_TRUE(widths_.empty());
  EXPECT_EQ(file_content(options_.files[0]), before);
}

TEST_F(Rounds, LeaveNoProfileOfAnEarlierRunBehind) {
  add("a", text_of_test(64, "", kHolds));
  options_.profile = true;
  EXPECT_EQ(run(), kHeld);
  EXPECT_TRUE(std::filesystem::exists(options_.out / "a" / "profile.json"));
  options_.profile = false;
  EXPECT_EQ(run(), kHeld);
  EXPECT_FALSE(std::filesystem::exists(options_.out / "a" / "profile.json"));
}

// The usual times are made up, so the verdict is the same on any machine.
TEST_F(Rounds, AreNotJudgedWhereTheMachineIsUsuallyFaster) {
  add("a",
      "format = 1\n[flight]\nsize = [64, 36]\nview_distance = 64\nframes = 5\nwarmup = 0\n"
      "fixed_step = 30\nbudget_mib = 16\n[at_most]\nframe_ms.max = 0\n");
  options_.usual = folder_ / "usual.jsonl";
  options_.junit = folder_ / "junit.xml";
  const auto record = [&](double pair_s) {
    UsualLoadFile file;
    for (std::size_t i = 0; i < UsualLoadFile::kFewestRuns; ++i)
      file.add({machine_name(telemetry::machine_facts()), "a", pair_s, telemetry::Figure()});
    ASSERT_TRUE(file.save(options_.usual));
  };
  record(1e-9);
  EXPECT_EQ(run(), kNotJudged);
  EXPECT_THAT(out_, HasSubstr("  NOT JUDGED\na:   The machine was busy: the reference load took "));
  EXPECT_THAT(
      out_, testing::EndsWith("\nnot judged: no budget is missed, but the machine was too busy\n"));
  record(1e9);
  EXPECT_EQ(run(), kMissed) << out_;
  EXPECT_THAT(out_, testing::Not(HasSubstr("not judged:")));
}

}  // namespace
}  // namespace psygen::frametest
