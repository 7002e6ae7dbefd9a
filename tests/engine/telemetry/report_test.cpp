#include "engine/telemetry/report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/engine/telemetry/synthetic_flight.hpp"

namespace psygen::telemetry {
namespace {

constexpr std::size_t kFigures = 9;  // eight plots, and the distribution

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST(Report, HasAllPlotsAndHeadlineNumbers) {
  const FrameLog log = synthetic_flight();
  const std::string html = report_html(log, summarise(log, synthetic_facts(), 1.0));
  EXPECT_EQ(count_of(html, "<figure"), kFigures);
  for (const char* part :
       {"Frame time", "Missing geometry", "Missing or too coarse part of the image",
        "Geometry cache", "budget 512 MiB", "Synthesis", "Allowed screen-space error",
        "Modelers: load", "Distribution of frame times", "median 1", "p99 ", "32.8 billion",
        "llvmpipe", "Parts of a frame", "prefers-color-scheme: dark"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part;
  }
}

// Data of each frame for the page's script.
nlohmann::json rows_of(const std::string& html) {
  const std::string opening = "id=\"rows\">";
  const std::size_t start = html.find(opening) + opening.size();
  return nlohmann::json::parse(html.substr(start, html.find("</script>", start) - start));
}

// Classes of the boxes with the label `label`.
std::string state_of(const std::string& html, const std::string& label) {
  const std::size_t at = html.find("\"label\">" + label + "<");
  if (at == std::string::npos) return "missing";
  const std::size_t begin = html.rfind("class=\"card ", at) + 12;
  return html.substr(begin, html.find('"', begin) - begin);
}

TEST(Report, IsGreenOnlyIfTheImageIsAsRequested) {
  const FrameLog log = synthetic_flight();
  const std::string good = report_html(log, summarise(log, synthetic_facts(), 3.0));
  EXPECT_NE(good.find("class=\"verdict good\""), std::string::npos);
  EXPECT_EQ(state_of(good, "Frames with a hole"), "good");
  EXPECT_EQ(state_of(good, "Frames too coarse"), "good");

  FrameLog coarse(tick_systems());
  for (FrameRecord r : log.frames()) {
    r.holes = 0;
    r.missing_pixels_percent = 100;
    coarse.add(r);
  }
  const std::string poor = report_html(coarse, summarise(coarse, synthetic_facts(), 3.0));
  EXPECT_NE(poor.find("class=\"verdict bad\"><b>Image: much too coarse"), std::string::npos);
  EXPECT_EQ(count_of(poor, "card good"), 0U) << "a green box would suggest that all is well";
  EXPECT_EQ(state_of(poor, "Frames with a hole"), "");
  EXPECT_EQ(state_of(poor, "Frames too coarse"), "bad");
}

TEST(Report, OptionsInAdviceAreNotBrokenOverTwoLines) {
  FrameLog coarse(tick_systems());
  const FrameLog flight = synthetic_flight();
  for (FrameRecord r : flight.frames()) {
    r.too_coarse_percent = 100;
    r.synthesis_seconds = 0;
    coarse.add(r);
  }
  const std::string html = report_html(coarse, summarise(coarse, synthetic_facts(), 3.0));
  EXPECT_NE(html.find("A smaller <code>--size</code> or a lower <code>--preset</code> leaves"),
            std::string::npos);
}

TEST(Report, WaitingIsShownSeparatelyAndNotAsPartOfASystem) {
  const FrameLog log = synthetic_flight();
  const std::string html = report_html(log, summarise(log, synthetic_facts(), 1.0));
  EXPECT_NE(html.find("<th>waiting for the GPU</th>"), std::string::npos);
  EXPECT_NE(html.find("waiting for the GPU</span>"), std::string::npos) << "in the plot's legend";
  EXPECT_EQ(html.find("waiting for the window</span>"), std::string::npos) << "there is no window";
  EXPECT_NE(html.find("GPU</span>"), std::string::npos);
}

TEST(Report, FramesWithImagesAreMarkedAndNotInTheCurve) {
  FrameLog log = synthetic_flight();
  FrameRecord picture = log.frames().back();
  picture.time_s += 0.02;
  picture.frame_ms = 4321;
  picture.apart = Apart::kPicture;
  picture.has_picture = true;
  log.add(picture);
  const std::string html = report_html(log, summarise(log, synthetic_facts(), 1.0));
  EXPECT_EQ(html.find("4321"), std::string::npos);
  const nlohmann::json rows = rows_of(html);
  EXPECT_EQ(rows["apart"], nlohmann::json({{"1500", "picture"}}));
  EXPECT_EQ(rows["pictures"], nlohmann::json({{"1500", "frame_01499.png"}}));
  EXPECT_NE(html.find("1 written as images. They are marked."), std::string::npos);
}

TEST(Report, ImagesNextToThePageAreNamedOnAnyClock) {
  FrameLog log = synthetic_flight();
  FrameRecord record = log.frames().back();
  record.has_picture = true;  // the virtual clock excludes no frame
  log.add(record);
  record.has_picture = false;
  record.apart = Apart::kPicture;  // a plugin wrote the image elsewhere
  log.add(record);
  const nlohmann::json rows = rows_of(report_html(log, summarise(log, synthetic_facts(), 1.0)));
  EXPECT_EQ(rows["apart"], nlohmann::json({{"1501", "picture"}}));
  EXPECT_EQ(rows["pictures"], nlohmann::json({{"1500", "frame_01499.png"}}));
}

TEST(Report, AnEndlessWorldHasValuesPerAreaInsteadOfDashes) {
  RunFacts facts = synthetic_facts();
  facts.world.blocks = {0, 0};
  facts.world.triangles = facts.world.bytes = facts.world.bytes_paper = Count::missing("no end");
  const FrameLog log = synthetic_flight();
  const std::string html = report_html(log, summarise(log, facts, 1.0));
  EXPECT_NE(html.find("One square kilometre, triangles"), std::string::npos);
  EXPECT_EQ(html.find("paper's format"), std::string::npos);
}

TEST(Report, RaisedErrorsAreDrawnAgainstTheRequestedError) {
  FrameLog log(tick_systems());
  const FrameLog flight = synthetic_flight();
  for (FrameRecord r : flight.frames()) {
    r.error_pixels = 9;
    log.add(r);
  }
  const std::string html = report_html(log, summarise(log, synthetic_facts(), 1.0));
  EXPECT_NE(html.find("\"label\":\"requested 4\""), std::string::npos);
  EXPECT_EQ(state_of(html, "Error of LODs"), "fair");
}

TEST(Report, NeedsNoExternalResources) {
  const FrameLog log = synthetic_flight(100);
  const std::string html = report_html(log, summarise(log, synthetic_facts(), 1.0));
  for (const char* part : {"http:", "https:", "src=", "href=", "@import", "url("})
    EXPECT_EQ(html.find(part), std::string::npos) << part;
}

TEST(Report, SaysIfASlowFrameIsOffTheScale) {
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

TEST(Report, GivesReasonsForARunWithoutFrames) {
  const FrameLog log(tick_systems());
  const std::string html = report_html(log, summarise(log, {}, 1.0));
  EXPECT_NE(html.find("No frame was drawn."), std::string::npos);
  EXPECT_NE(html.find("title=\"needs at least 2 values, there are 0\""), std::string::npos);
  EXPECT_NE(html.find("Image: not measured"), std::string::npos);
  EXPECT_EQ(count_of(html, "card good"), 0U);
}

TEST(Report, IsMeaningfulForAFewFramesOrAWarmUpAlone) {
  for (const std::uint64_t frames : {1U, 2U, 5U}) {
    for (const double warmup_s : {0.0, 1e6}) {
      const FrameLog log = synthetic_flight(frames);
      const std::string html = report_html(log, summarise(log, synthetic_facts(), warmup_s));
      EXPECT_EQ(html.find("nan"), std::string::npos) << frames;
      EXPECT_EQ(html.find("inf,"), std::string::npos) << frames;
      EXPECT_EQ(count_of(html, "<figure"), kFigures);
    }
  }
}

TEST(Report, ShowsTheSlowestOfEveryNFramesOfALongFlight) {
  FrameLog log(tick_systems());
  FrameRecord r = synthetic_flight(1).frames()[0];
  r.holes = 0;
  for (std::uint64_t i = 0; i < 60'000; ++i) {
    r.index = i;
    r.time_s = 0.01 * static_cast<double>(i);
    r.frame_ms = i == 30'001 ? 77.25 : 10;
    r.holes = i == 30'002 ? 7 : 0;
    log.add(r, kTickSystemMs);
  }
  const std::string html = report_html(log, summarise(log, synthetic_facts(), 1.0));
  EXPECT_LT(html.size(), 6'000'000U);
  const nlohmann::json rows = rows_of(html);
  EXPECT_EQ(rows["every"], 3);
  ASSERT_EQ(rows["t"].size(), 20'000U);
  EXPECT_EQ(rows["n"][10'000], 30'001);
  EXPECT_NE(html.find("77.25"), std::string::npos);
  EXPECT_EQ(count_of(html, ",7,0,"), 1U) << "a hole that is not in the slowest frame";
}

TEST(Report, ShowsTheCommandOfTheRun) {
  RunFacts facts = synthetic_facts();
  facts.run.command = "psygen fly --world '<b>'";
  facts.run.preset = "high";
  facts.run.view_distance_m = 16000;
  const FrameLog log = synthetic_flight(10);
  const std::string html = report_html(log, summarise(log, facts, 0));
  for (const char* part :
       {"psygen fly --world &#39;&lt;b&gt;&#39;", "<td>high</td>", "<td>16000 m</td>"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST(Report, HasTheTimeOfEachSystemAndSeparateWaitingTimes) {
  const FrameLog log = synthetic_flight(10);
  const nlohmann::json rows = rows_of(report_html(log, summarise(log, synthetic_facts(), 0)));
  ASSERT_EQ(rows["parts"].size(), tick_systems().size() + 2);
  EXPECT_EQ(rows["parts"][2]["name"], "visibility");
  EXPECT_NEAR(rows["parts"][2]["v"][9], 0.9, 1e-5);
  EXPECT_EQ(rows["parts"][8]["name"], "waiting for the GPU");
  EXPECT_NEAR(rows["parts"][8]["v"][9], log.frames()[9].device_wait_ms, 1e-3);
}

}  // namespace
}  // namespace psygen::telemetry
