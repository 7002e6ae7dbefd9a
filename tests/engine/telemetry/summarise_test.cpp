#include <gtest/gtest.h>

#include "engine/telemetry/statistics.hpp"
#include "engine/telemetry/summary.hpp"
#include "tests/engine/telemetry/synthetic_flight.hpp"

namespace psygen::telemetry {
namespace {

TEST(Summarise, LeavesTheWarmUpOutOfAllFiguresButNotOutOfTheLengthOfTheRun) {
  const FrameLog log = synthetic_flight();
  const Summary s = summarise(log, synthetic_facts(), 3.0);
  EXPECT_EQ(s.run.frames, 1500U);
  EXPECT_EQ(s.run.measured_frames, log.frames_since(3.0).size());
  EXPECT_LT(s.run.measured_frames, 1500U);
  EXPECT_EQ(*s.missing.frames, 0U);
  EXPECT_GT(*summarise(log, synthetic_facts(), 0.0).missing.frames, 0U);
}

TEST(Summarise, FrameFiguresAreTheStatisticsOfTheMeasuredFrames) {
  const FrameLog log = synthetic_flight();
  const Summary s = summarise(log, synthetic_facts(), 1.0);
  std::vector<double> ms;
  for (const FrameRecord& r : log.frames_since(1.0))
    ms.push_back(r.frame_ms);
  EXPECT_EQ(s.frame_ms.p50, percentile(ms, 0.5));
  EXPECT_EQ(s.frame_ms.p999, percentile(ms, 0.999));
  EXPECT_EQ(s.low1_fps, low1_fps(ms));
  EXPECT_EQ(*s.hitches, 1U);
  EXPECT_EQ(s.stutter_percent, stutter_percent(ms));
  ASSERT_EQ(s.system_ms.size(), 8U);
  EXPECT_EQ(s.system_ms[2].name, "visibility");
  EXPECT_NEAR(*s.system_ms[2].p50, 0.9, 1e-6);
}

TEST(Summarise, SumsCountsAndDividesTrianglesByBusySeconds) {
  FrameLog log({});
  for (int i = 0; i < 4; ++i) {
    FrameRecord r;
    r.time_s = i;
    r.cache_hits = 10;
    r.cache_misses = 3;
    r.models_synthesised = 2;
    r.triangles_synthesised = 1000;
    r.synthesis_seconds = 0.25;
    r.holes = i == 2 ? 5 : 0;
    r.coarse_nodes = 1;
    log.add(r);
  }
  const Summary s = summarise(log, {}, 1.0);
  EXPECT_EQ(*s.cache.hits, 30U);
  EXPECT_EQ(*s.cache.misses, 9U);
  EXPECT_EQ(*s.synthesis.models, 6U);
  EXPECT_DOUBLE_EQ(*s.synthesis.triangles_per_second, 4000.0);
  EXPECT_EQ(*s.missing.frames, 1U);
}

TEST(Summarise, CachePeakIncludesTheWarmUpAndPrefersTheCachesOwnFigure) {
  FrameLog log({});
  FrameRecord r;
  r.cache_bytes = 500;
  log.add(r);
  r.time_s = 2;
  r.cache_bytes = 300;
  log.add(r);
  RunFacts facts;
  EXPECT_EQ(*summarise(log, facts, 1.0).cache.peak_bytes, 500U);
  facts.cache_peak_bytes = 700;
  EXPECT_EQ(*summarise(log, facts, 1.0).cache.peak_bytes, 700U);
}

TEST(Summarise, OfARunWithoutFramesHasReasonsInsteadOfFigures) {
  const Summary s = summarise(FrameLog(tick_systems()), {}, 1.0);
  EXPECT_FALSE(s.frame_ms.p50.has_value());
  EXPECT_FALSE(s.frame_ms.p50.reason.empty());
  EXPECT_FALSE(s.hitches.has_value());
  EXPECT_EQ(s.cache.hits.reason, "no frame is left after the warm-up");
  EXPECT_FALSE(s.synthesis.triangles_per_second.has_value());
  EXPECT_FALSE(s.cache.peak_bytes.has_value());
}

TEST(Summarise, SamplesOfTheWarmUpDoNotCount) {
  FrameLog log({});
  log.add_time_to_visible(0.5, 9000.0);
  for (int i = 0; i < 200; ++i)
    log.add_time_to_visible(2.0, 50.0);
  const Summary s = summarise(log, {}, 1.0);
  EXPECT_DOUBLE_EQ(*s.missing.time_to_visible_ms.max, 50.0);
  EXPECT_DOUBLE_EQ(*s.missing.time_to_visible_ms.p99, 50.0);
}

}  // namespace
}  // namespace psygen::telemetry
