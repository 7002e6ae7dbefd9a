#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/frametest/failure.hpp"

namespace psygen::frametest {
namespace {

using testing::ElementsAre;

// Frames of a second each, far enough from each other.
telemetry::FrameLog log_of(std::vector<double> frame_ms) {
  telemetry::FrameLog log({"cache"});
  for (std::size_t i = 0; i < frame_ms.size(); ++i) {
    telemetry::FrameRecord record;
    record.index = i;
    record.time_s = static_cast<double>(i);
    record.frame_ms = frame_ms[i];
    record.holes = i == 1 ? 3 : 0;
    const float cache_ms = i == 4 ? 9.0F : 1.0F;
    log.add(record, {&cache_ms, 1});
  }
  return log;
}

BudgetResult missed(std::string field, Relation relation = Relation::kAtMost) {
  return {{std::move(field), relation, 1.0, 1}, "2", false};
}

std::vector<std::uint64_t> indices(std::vector<BudgetResult> budgets,
                                   const telemetry::FrameLog& log, double warmup_s,
                                   std::size_t count) {
  std::vector<std::uint64_t> result;
  for (const WorstFrame& frame : worst_frames(budgets, log, warmup_s, count))
    result.push_back(frame.index);
  return result;
}

TEST(WorstFrames, AreTheLongestIfTheFrameTimeIsMissed) {
  const auto log = log_of({90, 5, 7, 6, 8, 4});
  EXPECT_THAT(indices({missed("frame_ms.p99")}, log, 0, 2), ElementsAre(0, 4));
  EXPECT_THAT(indices({missed("frame_ms.p99")}, log, 1, 2), ElementsAre(2, 4)) << "warm-up";
  EXPECT_THAT(indices({missed("low1_fps", Relation::kAtLeast)}, log, 1, 1), ElementsAre(4));
  const auto worst = worst_frames(std::vector{missed("frame_ms.p99")}, log, 1, 1);
  EXPECT_EQ(worst.at(0).why, "frame_ms.p99: 8 ms");
}

TEST(WorstFrames, ComeFromEachMissedBudgetInTurn) {
  const auto log = log_of({5, 5, 9, 8, 7, 4});
  EXPECT_THAT(
      indices({missed("frame_ms.max"), missed("missing.frames"), missed("system_ms.cache.p99")},
              log, 0, 3),
      ElementsAre(1, 2, 4));
  BudgetResult held = missed("frame_ms.max");
  held.holds = true;
  EXPECT_THAT(indices({held, missed("missing.frames")}, log, 0, 3), ElementsAre(1))
      << "frames without a hole are not reported";
}

TEST(WorstFrames, HaveTheLargestAnimationErrorOrTheLongestPass) {
  telemetry::FrameLog log({}, 10, {}, {"sky"});
  for (std::uint64_t i = 0; i < 3; ++i) {
    telemetry::FrameRecord record;
    record.index = i;
    record.time_s = static_cast<double>(i);
    record.frame_ms = 1;
    record.device_frame = i + 1;
    record.animation_error_ms = i == 1 ? -9 : 2;
    log.add(record);
    log.set_gpu_ms(i + 1, 3, 0, std::array{i == 2 ? 2.5 : 1.0});
  }
  EXPECT_THAT(indices({missed("animation_error_ms.p99")}, log, 0, 1), ElementsAre(1));
  EXPECT_THAT(indices({missed("pass_ms.sky.max")}, log, 0, 1), ElementsAre(2));
}

TEST(WorstFrames, OfASectionOrAFigureAreThoseOfItsFrames) {
  telemetry::FrameLog log({}, 100, {{.name = "ai.paths", .unit = "paths"}});
  for (std::uint64_t i = 0; i < 6; ++i) {
    telemetry::FrameRecord record;
    record.index = i;
    record.time_s = static_cast<double>(i);
    record.frame_ms = 10 - static_cast<double>(i);
    log.add(record, {}, std::array{static_cast<double>(i == 4 ? 7 : 1)});
    if (i == 2) log.add_mark("boss");
    if (i == 4) log.add_mark("dead");
  }
  const std::vector<telemetry::SectionRange> sections{{"fight", "boss", "dead"}};
  const auto first = [&](const char* field) {
    return worst_frames(std::vector{missed(field)}, log, 0, 1, sections).at(0);
  };
  EXPECT_EQ(first("frame_ms.max").index, 0u);
  EXPECT_EQ(first("sections.fight.frame_ms.max").index, 2u);
  EXPECT_EQ(first("figures.ai.paths.max").index, 4u);
  EXPECT_EQ(first("figures.ai.paths.max").why, "figures.ai.paths.max: 7 paths");
  EXPECT_LT(first("sections.fight.figures.ai.paths.max").index, 4u);
}

TEST(WorstFrames, AreNoneIfNoFrameHasTheValue) {
  EXPECT_THAT(
      indices({missed("hash.world"), missed("memory.peak_rss_bytes")}, log_of({5, 6}), 0, 3),
      ElementsAre());
}

TEST(WorstFrames, SkipNeighboursAndExcludedFrames) {
  telemetry::FrameLog log({});
  for (std::uint64_t i = 0; i < 100; ++i) {
    telemetry::FrameRecord record;
    record.index = i;
    record.time_s = 0.1 * static_cast<double>(i);
    record.frame_ms = static_cast<double>(i + 1);
    if (i == 99) record.apart = telemetry::Apart::kPicture;
    log.add(record);
  }
  EXPECT_THAT(indices({missed("frame_ms.p99")}, log, 0, 2), ElementsAre(93, 98));
}

}  // namespace
}  // namespace psygen::frametest
