#include <gtest/gtest.h>

#include "engine/telemetry/statistics.hpp"
#include "engine/telemetry/summary.hpp"
#include "tests/engine/telemetry/synthetic_flight.hpp"

namespace psygen::telemetry {
namespace {

TEST(Summarise, ExcludesTheWarmUpExceptFromTheLengthOfTheRun) {
  const FrameLog log = synthetic_flight();
  const Summary s = summarise(log, synthetic_facts(), 3.0);
  EXPECT_EQ(s.run.frames, 1500U);
  EXPECT_EQ(s.run.measured_frames, log.frames_since(3.0).size());
  EXPECT_LT(s.run.measured_frames, 1500U);
  EXPECT_EQ(*s.missing.frames, 0U);
  EXPECT_GT(*summarise(log, synthetic_facts(), 0.0).missing.frames, 0U);
}

TEST(Summarise, FrameTimesAreStatisticsOfTheMeasuredFrames) {
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

// Frames of 10 ms. Of each ten, the fifth is written, which takes 200 ms, and the next two find an
// idle GPU and take 1 ms each.
FrameLog flight_with_pictures(std::uint64_t frames) {
  FrameLog log({"render"});
  constexpr std::array kOneMs{1.0F};
  for (std::uint64_t i = 0; i < frames; ++i) {
    FrameRecord r;
    r.index = i;
    r.time_s = 0.1 * static_cast<double>(i);
    r.frame_ms = 10;
    r.device_wait_ms = 8;
    r.gpu_ms = 9;
    r.triangles = 100 + i % 10;
    if (i % 10 == 5) r.apart = Apart::kPicture;
    if (i % 10 == 6 || i % 10 == 7) r.apart = Apart::kAfterIdle;
    if (r.apart == Apart::kPicture) r.frame_ms = 200;
    if (r.apart == Apart::kAfterIdle) r.frame_ms = r.device_wait_ms = 1;
    log.add(r, kOneMs);
  }
  return log;
}

TEST(Summarise, ExcludedFramesAreNotInTimingStatistics) {
  const Summary s = summarise(flight_with_pictures(1000), {}, 0.0);
  EXPECT_EQ(s.run.measured_frames, 1000U);
  EXPECT_EQ(s.run.timed_frames, 700U);
  EXPECT_EQ(s.run.apart_frames, (std::array<std::uint64_t, kApartKinds>{700, 100, 200}));
  EXPECT_EQ(*s.frame_ms.mean, 10);
  EXPECT_EQ(*s.frame_ms.p50, 10);
  EXPECT_EQ(*s.frame_ms.p99, 10);
  EXPECT_EQ(*s.frame_ms.max, 10);
  EXPECT_EQ(*s.low1_fps, 100);
  EXPECT_EQ(*s.hitches, 0U);
  EXPECT_EQ(*s.stutter_percent, 0);
  EXPECT_EQ(*s.wait_ms.all.p50, 8);
  EXPECT_EQ(*s.wait_ms.device.p99, 8);
  EXPECT_EQ(*s.gpu_ms.max, 9);
  // Drawing statistics include these frames.
  EXPECT_EQ(*s.draw.triangles_p50, 104.5);
  EXPECT_FALSE(s.synthesis.busy_percent.has_value());
}

TEST(Summarise, HasNoTimesIfEveryFrameIsWritten) {
  FrameLog log({"render"});
  for (int i = 0; i < 200; ++i) {
    FrameRecord r;
    r.time_s = i;
    r.frame_ms = 50;
    r.apart = Apart::kPicture;
    log.add(r);
  }
  const Summary s = summarise(log, {}, 0.0);
  EXPECT_EQ(s.run.timed_frames, 0U);
  EXPECT_FALSE(s.frame_ms.mean.has_value());
  EXPECT_FALSE(s.frame_ms.p50.has_value());
  EXPECT_FALSE(s.hitches.has_value());
  EXPECT_TRUE(s.missing.frames.has_value());
}

TEST(Summarise, TheGpuTimeIsMissingWithTheReason) {
  FrameLog log({});
  for (int i = 0; i < 200; ++i)
    log.add({});
  RunFacts facts;
  EXPECT_EQ(summarise(log, facts, 0.0).gpu_ms.p50.reason, "the GPU has no timestamps");
  facts.device.timestamps = true;
  EXPECT_EQ(summarise(log, facts, 0.0).gpu_ms.p50.reason, "needs at least 2 values, there are 0");
}

TEST(Summarise, AFrameIsTooCoarseByTheLargerMeasure) {
  FrameLog log({});
  for (int i = 0; i < 200; ++i) {
    FrameRecord r;
    r.time_s = 0.1 * i;
    r.frame_ms = 10;
    if (i % 20 == 0) r.missing_pixels_percent = 3;
    if (i % 20 == 1) r.too_coarse_percent = 20;
    if (i % 20 == 2) r.too_coarse_percent = kCoarsePercent;  // not above
    log.add(r);
  }
  const Summary s = summarise(log, {}, 0.0);
  EXPECT_EQ(*s.missing.coarse_frames, 20U);
  EXPECT_NEAR(*s.missing.coarse_seconds, 2.0, 1e-9);
  EXPECT_EQ(*s.missing.coarse_p99_percent, 20);
  EXPECT_EQ(*s.missing.coarse_max_percent, 20);
  EXPECT_NEAR(s.run.measured_seconds, 19.91, 1e-9);
  EXPECT_NEAR(*s.run.real_seconds, 2.0, 1e-9);
}

TEST(Summarise, ReportsWhyTheErrorOfLodsWasRaised) {
  FrameLog log({});
  for (int i = 0; i < 100; ++i) {
    FrameRecord r;
    r.error_pixels = i < 10 ? 8 : i < 40 ? 6 : 4;  // for time; for memory; as requested
    r.memory_factor = i >= 10 && i < 40 ? 1.5 : 1;
    r.resolution = i >= 98 ? 0.75 : 1;
    r.requests_refused = i == 12 ? 3 : 0;
    log.add(r);
  }
  RunFacts facts;
  facts.run.error_pixels = 4;
  const Summary s = summarise(log, facts, 0.0);
  EXPECT_EQ(*s.detail.p50_pixels, 4);
  EXPECT_EQ(*s.detail.max_pixels, 8);
  EXPECT_EQ(*s.detail.raised_by_memory, 30U);
  EXPECT_EQ(*s.detail.raised_for_target, 12U);
  EXPECT_EQ(*s.detail.resolution_p50, 1);
  EXPECT_EQ(*s.detail.resolution_min, 0.75);
  EXPECT_EQ(*s.detail.refused_frames, 1U);
}

TEST(Summarise, ModelersBusyIsTheirFractionOfTheProcessorsRealTime) {
  FrameLog log({});
  for (int i = 0; i < 100; ++i) {
    FrameRecord r;
    r.time_s = i;  // a fixed step: the flight's clock does not count
    r.frame_ms = 20;
    r.synthesis_seconds = i < 50 ? 0.02 : 0.004;
    r.too_coarse_percent = i < 50 ? 0 : 5;
    log.add(r);
  }
  RunFacts facts;
  facts.run.modelers = 2;
  const Summary s = summarise(log, facts, 0.0);
  EXPECT_NEAR(*s.synthesis.busy_percent, 30, 1e-9);
  EXPECT_NEAR(*s.synthesis.coarse_busy_percent, 10, 1e-9);
  EXPECT_FALSE(summarise(log, facts, 90.5).synthesis.coarse_busy_percent.has_value())
      << "a fifth of a second is too short";
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

TEST(Summarise, CachePeakIncludesTheWarmUpAndPrefersTheCachesCount) {
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

TEST(Summarise, HasReasonsInsteadOfValuesWithoutFrames) {
  const Summary s = summarise(FrameLog(tick_systems()), {}, 1.0);
  EXPECT_FALSE(s.frame_ms.p50.has_value());
  EXPECT_FALSE(s.frame_ms.p50.reason.empty());
  EXPECT_FALSE(s.hitches.has_value());
  EXPECT_EQ(s.cache.hits.reason, "no frames after the warm-up");
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
