#include "engine/frametest/run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "ecs/ecs.hpp"
#include "engine/frametest/judge.hpp"
#include "engine/scene/systems.hpp"
#include "engine/telemetry/marks.hpp"
#include "engine/telemetry/own_figures.hpp"
#include "engine/telemetry/summary_fields.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::frametest {
namespace {

using testing::HasSubstr;

TestResult result_of(std::vector<BudgetResult> budgets) {
  TestResult result;
  result.file = "dir/walk.toml";
  result.name = "walk";
  result.seconds = 1.5;
  result.budgets = std::move(budgets);
  return result;
}

TestResult result_of(core::ErrorCode code, const std::string& file = "dir/walk.toml") {
  TestResult result = result_of(std::vector<BudgetResult>());
  result.file = file;
  result.error = core::Error{code, "it <failed> & \"more\""};
  return result;
}

TEST(Judge, ComparesBudgetsWithValuesAndMissesUnmeasuredOnes) {
  telemetry::Summary summary;
  summary.frame_ms.p99 = 24.5;
  summary.low1_fps = 30.0;
  summary.hash.world = 0xABCu;
  summary.world.name = "paper";
  const std::vector<Budget> budgets{{"frame_ms.p99", Relation::kAtMost, 24.5, 1},
                                    {"frame_ms.p99", Relation::kAtMost, 24.4, 2},
                                    {"low1_fps", Relation::kAtLeast, 30.1, 3},
                                    {"hash.world", Relation::kEqual, "0000000000000abc", 4},
                                    {"world.name", Relation::kEqual, "lakes", 5},
                                    {"frame_ms.p999", Relation::kAtMost, 1e9, 6},
                                    {"system_ms.none.p99", Relation::kAtMost, 1e9, 7}};
  const RunFields fields = telemetry::summary_fields(summary);
  const auto results = judge(budgets, Flights{.runs = {&fields, 1}});
  std::vector<bool> holds;
  for (const BudgetResult& r : results)
    holds.push_back(r.holds);
  EXPECT_EQ(holds, (std::vector{true, false, false, true, false, false, false}));
  EXPECT_EQ(results[0].value, "24.5");
  EXPECT_EQ(results[5].value, "not measured: not measured in this run");
  EXPECT_EQ(results[6].value, "the run has no such field");
}

TEST(FrameTests, HaveALineForEachBudgetWithValueAndLimit) {
  const TestResult result = result_of({{{"frame_ms.p99", Relation::kAtMost, 25.0, 1}, "23.1", true},
                                       {{"low1_fps", Relation::kAtLeast, 30.0, 1}, "12", false}});
  EXPECT_EQ(to_text(result), "walk: frame_ms.p99 23.1  <= 25\nwalk: low1_fps 12  >= 30  MISSED\n");
}

TEST(FrameTests, ReturnTheWorstResult) {
  const Budget budget{"hitches", Relation::kAtMost, 0.0, 1};
  const TestResult held = result_of({{budget, "0", true}}),
                   missed = result_of({{budget, "1", false}});
  const TestResult failed = result_of(core::ErrorCode::kParse),
                   skipped = result_of(core::ErrorCode::kNoDevice);
  const auto code = [](std::vector<TestResult> results) { return exit_code_of(results); };
  EXPECT_EQ(code({held, held}), 0);
  EXPECT_EQ(code({held, missed}), 3);
  EXPECT_EQ(code({missed, failed}), 1);
  EXPECT_EQ(code({held, skipped}), 77);
  EXPECT_EQ(code({skipped, missed}), 3);
  TestResult busy = missed;
  busy.budgets[0].judged = false;
  EXPECT_EQ(code({held, busy}), kNotJudged);
  EXPECT_EQ(code({busy, skipped}), kNotJudged);
  EXPECT_EQ(code({busy, missed}), kMissed);
  EXPECT_EQ(code({busy, failed}), kFailed);
}

TEST(FrameTests, AreWrittenAsJUnit) {
  const Budget budget{"frame_ms.p99", Relation::kAtMost, 25.0, 1};
  const std::vector<TestResult> results{result_of({{budget, "24", true}, {budget, "26", false}}),
                                        result_of(core::ErrorCode::kIo, "dir/io.toml"),
                                        result_of(core::ErrorCode::kNoDevice, "dir/none.toml")};
  const std::string xml = to_junit(results);
  EXPECT_THAT(xml, HasSubstr("<testsuites tests=\"4\" failures=\"1\" errors=\"1\" skipped=\"1\" "
                             "time=\"4.500\">"));
  EXPECT_THAT(xml,
              HasSubstr("tests=\"2\" failures=\"1\" errors=\"0\" skipped=\"0\" time=\"1.500\""));
  EXPECT_THAT(xml, HasSubstr("name=\"frame_ms.p99 at_most 25\" time=\"0.750\"><failure "
                             "message=\"26\"/>"));
  EXPECT_THAT(xml, HasSubstr("<error message=\"it &lt;failed&gt; &amp; &quot;more&quot;\"/>"));
  EXPECT_THAT(xml, HasSubstr("<skipped message="));
}

TEST(FrameTests, TellRunsAndNotesEverywhere) {
  BudgetResult missed{{"frame_ms.p99", Relation::kAtMost, 25.0, 12}, "26", false};
  missed.runs = {"26", "24", "27"};
  missed.notes = {"Processor time rose too.", "Chance: 1 %."};
  BudgetResult busy{{"hitches", Relation::kAtMost, 0.0, 13}, "4", false, false};
  busy.notes = {"The machine was busy."};
  const std::vector<TestResult> results{result_of({missed, busy})};
  EXPECT_EQ(to_text(results[0]),
            "walk: frame_ms.p99 26 (runs 26, 24, 27)  <= 25  MISSED\n"
            "walk:   Processor time rose too.\nwalk:   Chance: 1 %.\n"
            "walk: hitches 4  <= 0  NOT JUDGED\nwalk:   The machine was busy.\n");
  const std::string xml = to_junit(results);
  EXPECT_THAT(xml, HasSubstr("tests=\"2\" failures=\"1\" errors=\"0\" skipped=\"1\""));
  EXPECT_THAT(xml, HasSubstr("<failure message=\"26 (runs 26, 24, 27). Processor time rose too. "
                             "Chance: 1 %.\"/>"));
  EXPECT_THAT(xml, HasSubstr("<skipped message=\"4. The machine was busy.\"/>"));
  const std::string markdown = to_markdown(results);
  EXPECT_THAT(markdown, HasSubstr("| 26 (runs 26, 24, 27) | MISSED |"));
  EXPECT_THAT(markdown, HasSubstr("| 4 | not judged |"));
  EXPECT_THAT(markdown, HasSubstr("- frame\\_ms.p99: Processor time rose too.\n"));
  const auto remarks = remarks_of(results);
  EXPECT_EQ(remarks.at(0).message,
            "frame_ms.p99 is 26 (runs 26, 24, 27); the budget is <= 25. Processor time rose too. "
            "Chance: 1 %.");
  EXPECT_EQ(remarks.at(1).level, telemetry::RemarkLevel::kWarning);
  EXPECT_EQ(remarks.at(1).title, "walk does not judge hitches");
  EXPECT_EQ(limit_of({"frame_ms.p99", Relation::kAtMost, 26.25, 1, 1.05}), "26.25 (1.05 × base)");
}

TEST(FrameTests, HaveDistinctClassesInJUnit) {
  const Budget budget{"hitches", Relation::kAtMost, 0.0, 1};
  TestResult walk = result_of({{budget, "0", true}}), dash = walk;
  dash.name = "dash";
  const std::string xml =
      to_junit(std::vector{walk, dash, result_of(core::ErrorCode::kParse, "old/walk.toml")});
  EXPECT_THAT(xml, HasSubstr("classname=\"dir/walk.toml\" name=\"hitches at_most 0\""));
  EXPECT_THAT(xml, HasSubstr("classname=\"dash\" name=\"hitches at_most 0\""));
  EXPECT_THAT(xml, HasSubstr("classname=\"old/walk.toml\" name=\"run\""))
      << "a file that cannot be read may be called like another test";
}

TEST(FrameTests, AreWrittenAsMarkdown) {
  const Budget budget{"frame_ms.p99", Relation::kAtMost, 25.0, 1};
  TestResult dash = result_of({{budget, "20", true}});
  dash.name = "da|sh";
  const std::vector<TestResult> results{result_of({{budget, "24", true}, {budget, "26", false}}),
                                        dash, result_of(core::ErrorCode::kNoDevice)};
  EXPECT_EQ(to_markdown(results),
            "## Frame tests\n\n"
            "| test | result | time |\n| --- | --- | --- |\n"
            "| walk | missed 1 of 2 budgets | 1.5 s |\n"
            "| da\\|sh | held, 1 budget | 1.5 s |\n"
            "| walk | skipped: it \\<failed\\> \\& \"more\" | 1.5 s |\n\n"
            "### walk\n\n"
            "| budget | limit | this run |  |\n| --- | --- | --- | --- |\n"
            "| frame\\_ms.p99 | \\<= 25 | 24 | held |\n"
            "| frame\\_ms.p99 | \\<= 25 | 26 | MISSED |\n\n");
}

TEST(FrameTests, LeaveRemarksAtTheLinesOfTheirBudgets) {
  const Budget budget{"frame_ms.p99", Relation::kAtMost, 25.0, 12};
  const auto remarks = remarks_of(
      std::vector{result_of({{budget, "24", true}, {budget, "26", false}}),
                  result_of(core::ErrorCode::kIo), result_of(core::ErrorCode::kNoDevice)});
  ASSERT_EQ(remarks.size(), 3u);
  EXPECT_EQ(remarks[0].title, "walk misses frame_ms.p99");
  EXPECT_EQ(remarks[0].message, "frame_ms.p99 is 26; the budget is <= 25");
  EXPECT_EQ(remarks[0].file, "dir/walk.toml");
  EXPECT_EQ(remarks[0].line, 12);
  EXPECT_EQ(remarks[1].title, "walk failed");
  EXPECT_EQ(remarks[1].level, telemetry::RemarkLevel::kError);
  EXPECT_EQ(remarks[2].level, telemetry::RemarkLevel::kWarning);
}

TEST(FrameTests, RunNothingIfTwoHaveOneName) {
  const TemporaryFolder folder;
  const char* text = "format = 1\nname = \"walk\"\n[at_most]\nhitches = 0\n";
  std::ofstream(folder / "a.toml") << text;
  std::ofstream(folder / "b.toml") << text;
  Hooks hooks;
  int flights = 0;
  hooks.prepare = [&](app::SessionOptions&) -> core::Result<void> {
    return ++flights, core::Result<void>{};
  };
  RunOptions options;
  options.files = {folder / "a.toml", folder / "b.toml"};
  options.out = folder / "out";
  EXPECT_EQ(run_frame_tests(options, hooks), kFailed);
  EXPECT_EQ(flights, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(FrameTests, RunTheGamesHooksAndKeepTheOutputs) {
  const TemporaryFolder folder;
  std::ofstream(folder / "short.toml")
      << "format = 1\n[flight]\nsize = [64, 36]\nview_distance = 64\nframes = 5\nwarmup = 0\n"
         "clock = \"virtual\"\nbudget_mib = 16\n"
         "[at_most]\nframe_ms.max = 1000\n[equal]\nrun.frames = 5\n[at_least]\nframe_ms.max = "
         "999\n";
  int prepared = 0, started = 0, frames = 0;
  Hooks hooks;
  hooks.prepare = [&](app::SessionOptions& options) -> core::Result<void> {
    ++prepared;
    options.plugins.push_back(
        {.name = "game", .on_frame = [&](app::Session&, double) { ++frames; }});
    return {};
  };
  hooks.start = [&](app::Session&) -> core::Result<void> {
    return ++started, core::Result<void>{};
  };
  RunOptions options;
  options.files = {folder / "short.toml"};
  options.out = folder / "out";
  options.junit = folder / "junit.xml";
  options.words.markdown = folder / "words.md";
  options.words.annotations = {telemetry::Annotations::Format::kGitlab, folder / "quality.json"};
  options.worst_frames = 0;  // so the test flies only once
  EXPECT_EQ(run_frame_tests(options, hooks), kMissed) << "the last budget cannot hold";
  EXPECT_EQ(prepared, 1);
  EXPECT_EQ(started, 1);
  EXPECT_EQ(frames, 5);
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "short" / "frames.csv"));
  for (const char* file : {"junit.xml", "words.md", "quality.json"})
    EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
  options.device = "no such device";
  EXPECT_EQ(run_frame_tests(options, hooks), kSkipped);
}

TEST(FrameTests, JudgeTheFiguresOfAGameAndTheSectionsBetweenItsMarks) {
  const TemporaryFolder folder;
  std::ofstream(folder / "fight.toml")
      << "format = 1\n[flight]\nsize = [64, 36]\nview_distance = 64\nframes = 12\nwarmup = 0\n"
         "clock = \"virtual\"\nbudget_mib = 16\nfixed_step = 30\n[marks]\ncalm = 0.2\n"
         "[at_most]\nfigures.wolves.max = 11\nfigures.hunt_ms.p50 = 5\nfigures.sheep.max = 1\n"
         "[sections.fight]\nfrom = \"boss\"\nto = \"calm\"\nat_most.figures.wolves.max = 5\n"
         "equal.measured_frames = 2\n[sections.ghost]\nat_most.frame_ms.max = 1000\n";
  Hooks hooks;
  hooks.prepare = [](app::SessionOptions& options) -> core::Result<void> {
    struct Pack {
      telemetry::OwnFigure wolves, hunt_ms;
      int steps = 0;
    };
    app::Plugin plugin;
    plugin.name = "game";
    plugin.add_systems = [](scene::Systems& systems) -> core::Result<void> {
      Pack& pack = systems.resource<Pack>();
      pack.wolves = *systems.figures.add({.name = "wolves", .unit = "wolves"});
      pack.hunt_ms =
          *systems.figures.add({.name = "hunt_ms", .kind = telemetry::FigureKind::kDuration});
      systems.frame.add("hunt", [](Pack& all, telemetry::Marks& marks) {
        const telemetry::ScopedTime time(all.hunt_ms);
        if (all.steps == 4) marks.set("boss");
        all.wolves.report(all.steps++);
      });
      return {};
    };
    options.plugins.push_back(plugin);
    return {};
  };
  RunOptions options;
  options.worst_frames = 0;
  const std::filesystem::path file = folder / "fight.toml";
  const TestResult result = run_frame_test({file, load_frame_test(file)}, options, hooks);
  ASSERT_FALSE(result.error) << result.error->message;
  std::vector<std::string> lines;
  for (const BudgetResult& r : result.budgets)
    lines.push_back(r.budget.field + (r.holds ? " holds: " : " misses: ") + r.value);
  EXPECT_THAT(
      lines,
      testing::ElementsAre(
          "figures.wolves.max holds: 11",
          "figures.hunt_ms.p50 misses: not measured: the clock is virtual",
          "figures.sheep.max misses: the run has no such field",
          "sections.fight.figures.wolves.max holds: 5", "sections.fight.measured_frames holds: 2",
          "sections.ghost.frame_ms.max misses: not measured: no frame has the mark 'ghost'"));
  EXPECT_THAT(to_text(result), HasSubstr("fight: sections.fight.figures.wolves.max 5  <= 5\n"));
  EXPECT_THAT(to_junit(std::vector{result}), HasSubstr("sections.fight.measured_frames equal 2"));
}

}  // namespace
}  // namespace psygen::frametest
