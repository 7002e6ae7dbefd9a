#include "engine/telemetry/report.hpp"

#include <gtest/gtest.h>

#include "tests/engine/telemetry/synthetic_flight.hpp"

namespace psygen::telemetry {
namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST(Report, HasAllPlotsAndTheHeadlineFigures) {
  const FrameLog log = synthetic_flight();
  const std::string html = report_html(log, summarise(log, synthetic_facts(), 1.0));
  EXPECT_EQ(count_of(html, "<figure>"), 5U);
  for (const char* part : {"Frame time", "Missing geometry", "Geometry cache", "budget 512 MiB",
                           "Synthesis", "median 1", "p99 ", "32.8 billion", "llvmpipe",
                           "Where the frame goes", "prefers-color-scheme: dark"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part;
  }
}

TEST(Report, NeedsNothingFromOutside) {
  const FrameLog log = synthetic_flight(100);
  const std::string html = report_html(log, summarise(log, synthetic_facts(), 1.0));
  for (const char* part : {"http:", "https:", "src=", "href=", "@import", "url("})
    EXPECT_EQ(html.find(part), std::string::npos) << part;
}

TEST(Report, SaysSoWhenASlowFrameIsOffTheScale) {
  const FrameLog log = synthetic_flight();
  const std::string html = report_html(log, summarise(log, synthetic_facts(), 1.0));
  EXPECT_NE(html.find("off the scale; the slowest took 112 ms."), std::string::npos);
}

TEST(Report, EscapesNamesFromWorldFiles) {
  RunFacts facts = synthetic_facts();
  facts.world.name = "<script>alert('x')</script>";
  const FrameLog log = synthetic_flight(10);
  const std::string html = report_html(log, summarise(log, facts, 0.0));
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_NE(html.find("&lt;script&gt;alert(&#39;x&#39;)"), std::string::npos);
}

TEST(Report, OfARunWithoutFramesSaysSoAndGivesReasons) {
  const FrameLog log(tick_systems());
  const std::string html = report_html(log, summarise(log, {}, 1.0));
  EXPECT_NE(html.find("No frame was drawn."), std::string::npos);
  EXPECT_NE(html.find("title=\"needs at least 2 values, there are 0\""), std::string::npos);
}

TEST(Report, StaysSmallForALongFlight) {
  const FrameLog log = synthetic_flight(20'000);
  EXPECT_LT(report_html(log, summarise(log, synthetic_facts(), 1.0)).size(), 700'000U);
}

TEST(Report, GoesIntoAFileOrSaysWhyNot) {
  const TemporaryFolder folder;
  const FrameLog log = synthetic_flight();
  const Summary summary = summarise(log, synthetic_facts(), 1.0);
  ASSERT_TRUE(write_report_html(folder / "report.html", log, summary));
  EXPECT_EQ(text_of(folder / "report.html"), report_html(log, summary));
  EXPECT_EQ(write_report_html("/dev/full", log, summary).error().code, core::ErrorCode::kIo);
}

}  // namespace
}  // namespace psygen::telemetry
