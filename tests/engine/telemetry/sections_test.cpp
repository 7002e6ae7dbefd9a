// The game's figures and marks in the outputs of a run, and statistics of the sections between
// marks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/telemetry/report.hpp"
#include "engine/telemetry/summary.hpp"
#include "engine/telemetry/summary_fields.hpp"
#include "tests/engine/telemetry/synthetic_flight.hpp"

namespace psygen::telemetry {
namespace {

using testing::HasSubstr;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

// 300 frames of 10 ms, the boss's of 20 ms: frames 100 to 199. Wolves exist from frame 50 on.
FrameLog marked_flight() {
  FrameLog log({"hunt"}, FrameLog::kMaxFrames,
               {{.name = "path_ms", .unit = "ms", .kind = FigureKind::kDuration},
                {.name = "wolves", .kind = FigureKind::kGauge}});
  double time_s = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const bool boss = i >= 100 && i < 200;
    FrameRecord record;
    record.index = i;
    record.time_s = time_s;
    record.frame_ms = boss ? 20 : 10;
    record.main_cpu_ms = 1;
    record.apart = i == 150 ? Apart::kGap : Apart::kNo;
    record.holes = boss ? 1 : 0;
    const float hunt_ms = boss ? 4.0F : 1.0F;
    const double own[] = {boss       ? 3.0
                          : i == 250 ? 9.0
                                     : 1.0,
                          i < 50 ? kNotANumber : static_cast<double>(i % 10)};
    log.add(record, {&hunt_ms, 1}, own);
    if (i == 100) log.add_mark("boss");
    if (i == 200) log.add_mark("dead");
    if (i == 200) log.add_mark("spawn");
    if (i == 220) log.add_mark("spawn");
    time_s += record.frame_ms * 1e-3;
  }
  return log;
}

Summary summary_of(const FrameLog& log, std::vector<SectionRange> sections, double warmup_s = 0) {
  RunFacts facts = synthetic_facts();
  facts.sections = std::move(sections);
  facts.invalid_values = {2, 0};
  facts.ignored_marks = 1;
  return summarise(log, facts, warmup_s);
}

std::string value_of(const Summary& summary, const std::string& name) {
  for (const SummaryField& field : summary_fields(summary)) {
    if (field.name != name) continue;
    if (const double* number = std::get_if<double>(&field.value)) {
      std::ostringstream text;
      text << *number;
      return text.str();
    }
    if (const std::string* text = std::get_if<std::string>(&field.value)) return *text;
    return "null: " + field.reason;
  }
  return "no such field";
}

TEST(FiguresOfAGame, HaveStatisticsOfTheirFrames) {
  const Summary summary = summary_of(marked_flight(), {});
  EXPECT_EQ(value_of(summary, "figures.path_ms.max"), "9");
  EXPECT_EQ(value_of(summary, "figures.path_ms.p50"), "1");
  EXPECT_EQ(value_of(summary, "figures.path_ms.frames"), "299") << "one frame is excluded";
  EXPECT_EQ(value_of(summary, "figures.path_ms.invalid"), "2");
  EXPECT_EQ(value_of(summary, "figures.path_ms.unit"), "ms");
  EXPECT_EQ(value_of(summary, "figures.path_ms.kind"), "duration");
  EXPECT_EQ(value_of(summary, "figures.wolves.frames"), "250") << "the first have no value";
  EXPECT_EQ(value_of(summary, "figures.wolves.min"), "0");
  EXPECT_EQ(value_of(summary, "figures.wolves.mean"), "4.5");
  EXPECT_EQ(value_of(summary, "ignored_marks"), "1");
}

TEST(FiguresOfAGame, WithoutAnyValueHaveAReason) {
  FrameLog log({}, 10, {{.name = "never"}});
  log.add({}, {}, std::array{kNotANumber});
  EXPECT_EQ(value_of(summary_of(log, {}), "figures.never.p50"), "null: no frame had a value");
}

TEST(Marks, AreCountedWithTheirFirstFrame) {
  const Summary summary = summary_of(marked_flight(), {});
  EXPECT_EQ(value_of(summary, "marks.spawn.count"), "2");
  EXPECT_EQ(value_of(summary, "marks.spawn.frame"), "200");
  EXPECT_EQ(value_of(summary, "marks.boss.time_s"), "1");
}

TEST(Sections, CoverTheFramesFromTheirMarkToTheNext) {
  const Summary summary =
      summary_of(marked_flight(), {{"boss", "boss", "dead"}, {"rest", "dead", "end"}});
  EXPECT_EQ(value_of(summary, "sections.boss.measured_frames"), "100");
  EXPECT_EQ(value_of(summary, "sections.boss.timed_frames"), "99");
  EXPECT_EQ(value_of(summary, "sections.boss.start_s"), "1");
  EXPECT_EQ(value_of(summary, "sections.boss.end_s"), "3");
  EXPECT_EQ(value_of(summary, "sections.boss.frame_ms.max"), "20");
  EXPECT_EQ(value_of(summary, "sections.boss.system_ms.hunt.p50"), "4");
  EXPECT_EQ(value_of(summary, "sections.boss.missing.frames"), "100");
  EXPECT_EQ(value_of(summary, "sections.boss.figures.path_ms.max"), "3");
  EXPECT_EQ(value_of(summary, "sections.rest.measured_frames"), "100");
  EXPECT_EQ(value_of(summary, "sections.rest.frame_ms.max"), "10");
  EXPECT_EQ(value_of(summary, "sections.rest.figures.path_ms.max"), "9");
  EXPECT_EQ(value_of(summary, "frame_ms.max"), "20") << "the whole run";
}

TEST(Sections, WithoutTheirMarksHaveTheReasonInEveryField) {
  const Summary summary = summary_of(
      marked_flight(), {{"a", "boos", "end"}, {"b", "dead", "boss"}, {"c", "spawn", "spawn"}});
  for (const char* field : {"frame_ms.p99", "hitches", "measured_frames", "figures.path_ms.p99",
                            "system_ms.hunt.p50", "missing.frames", "start_s"})
    EXPECT_EQ(value_of(summary, std::string("sections.a.") + field),
              "null: no frame has the mark 'boos'")
        << field;
  EXPECT_EQ(value_of(summary, "sections.b.frame_ms.p99"),
            "null: no frame after the mark 'dead' has the mark 'boss'");
  EXPECT_EQ(value_of(summary, "sections.c.measured_frames"), "20") << "to the next of its name";
}

TEST(Sections, ExcludeTheWarmUp) {
  const std::vector<SectionRange> ranges{{"boss", "boss", "dead"}};
  const FrameLog log = marked_flight();
  EXPECT_EQ(value_of(summary_of(log, ranges, 2), "sections.boss.measured_frames"), "50");
  EXPECT_EQ(value_of(summary_of(log, ranges, 3.5), "sections.boss.frame_ms.p50"),
            "null: the section lies within the warm-up");
}

TEST(FramesCsv, HasColumnsOfFiguresAndMarks) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_frames_csv(folder / "frames.csv", marked_flight()));
  std::istringstream text(text_of(folder / "frames.csv"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);)
    lines.push_back(line);
  EXPECT_THAT(lines[0], testing::EndsWith(",figures.path_ms,figures.wolves,marks"));
  EXPECT_THAT(lines[1], testing::EndsWith(",1,,")) << "no value and no mark";
  EXPECT_THAT(lines[101], testing::EndsWith(",3,0,boss"));
  EXPECT_THAT(lines[201], testing::EndsWith(",1,0,dead spawn"));
  for (const std::string& line : lines)
    EXPECT_EQ(std::ranges::count(line, ','), std::ranges::count(lines[0], ',')) << line;
}

TEST(FrameLog, AMarkOfAFrameThatWasNotStoredIsIgnored) {
  FrameLog log({}, 1);
  log.add_mark("early");
  log.add({});
  log.add_mark("kept");
  log.add({});
  log.add_mark("late");
  ASSERT_EQ(log.marks().size(), 1u);
  EXPECT_EQ(log.marks()[0].name, "kept");
}

TEST(Report, ShowsFiguresMarksAndSections) {
  const FrameLog log = marked_flight();
  const std::string html =
      report_html(log, summary_of(log, {{"boss", "boss", "dead"}, {"gone", "x", "end"}}));
  EXPECT_THAT(html, HasSubstr("\"marks\":{\"100\":\"boss\",\"200\":\"dead, spawn\","));
  EXPECT_THAT(html, HasSubstr("<figcaption>path_ms</figcaption>"));
  EXPECT_THAT(html, HasSubstr("2 values were not finite"));
  EXPECT_THAT(html, HasSubstr("section boss</th><td>1.00 to 3.00 s, 100 frames"));
  EXPECT_THAT(html, HasSubstr("no frame has the mark &#39;x&#39;"));
}

TEST(TextOfASummary, HasALineForEachFigureAndSection) {
  const std::string text = to_text(summary_of(marked_flight(), {{"boss", "boss", "dead"}}));
  EXPECT_THAT(text, HasSubstr("path_ms            p50 1.00, p99 3.00 ms"));
  EXPECT_THAT(text, HasSubstr("boss               frame p50 20.0 ms"));
}

}  // namespace
}  // namespace psygen::telemetry
