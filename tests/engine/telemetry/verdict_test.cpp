#include "engine/telemetry/verdict.hpp"

#include <gtest/gtest.h>

#include "tests/engine/telemetry/synthetic_flight.hpp"

namespace psygen::telemetry {
namespace {

// 200 frames, 20 s of flight in 10 s; `change` modifies each frame.
template <class Change>
Summary flight(const Change& change, RunFacts facts = synthetic_facts()) {
  FrameLog log({});
  for (std::uint64_t i = 0; i < 200; ++i) {
    FrameRecord r;
    r.index = i;
    r.time_s = 0.1 * static_cast<double>(i);
    r.frame_ms = 50;
    r.error_pixels = 4;
    r.synthesis_seconds = 0.04;
    change(r);
    log.add(r);
  }
  return summarise(log, facts, 0.0);
}

std::string text_of(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences)
    text += sentence + "\n";
  return text;
}

TEST(Verdict, IsGoodOnlyWithoutAnyFault) {
  const Verdict verdict = judge_quality(flight([](FrameRecord&) {}));
  EXPECT_EQ(verdict.grade, Grade::kGood);
  EXPECT_EQ(verdict.headline, "as requested");
  EXPECT_TRUE(verdict.advice.empty());
  // All frames may be slightly too coarse, and one of a hundred much too coarse.
  EXPECT_EQ(judge_quality(flight([](FrameRecord& r) { r.missing_pixels_percent = 0.9; })).grade,
            Grade::kGood);
  EXPECT_EQ(judge_quality(flight([](FrameRecord& r) {
              if (r.index == 7) r.too_coarse_percent = 100;
            })).grade,
            Grade::kGood);
}

TEST(Verdict, OneHoleIsPoor) {
  const Verdict verdict =
      judge_quality(flight([](FrameRecord& r) { r.holes = r.index == 50 ? 1 : 0; }));
  EXPECT_EQ(verdict.grade, Grade::kPoor);
  EXPECT_EQ(verdict.headline, "incomplete");
  EXPECT_NE(text_of(verdict.reasons).find("1 of 200 frames had a hole"), std::string::npos);
  EXPECT_FALSE(verdict.advice.empty());
}

TEST(Verdict, ACoarseImageWithoutHolesIsNotGood) {
  const auto coarse = [](double percent) {
    return judge_quality(flight([percent](FrameRecord& r) {
      if (r.index < 100) r.missing_pixels_percent = percent;
    }));
  };
  EXPECT_EQ(coarse(5).grade, Grade::kFair);
  EXPECT_EQ(coarse(5).headline, "too coarse at times");
  const Verdict poor = coarse(100);
  EXPECT_EQ(poor.grade, Grade::kPoor);
  EXPECT_EQ(poor.headline, "much too coarse at times");
  EXPECT_NE(text_of(poor.reasons).find("In 100 of 200 frames (10.0 s of 20.0 s of flight)"),
            std::string::npos)
      << text_of(poor.reasons);
  EXPECT_NE(text_of(poor.reasons).find("at worst 100 %"), std::string::npos);
}

TEST(Verdict, TheWorstOfFewFramesDecides) {
  FrameLog log({});
  FrameRecord r;
  r.frame_ms = 50;
  r.too_coarse_percent = 60;
  log.add(r);
  const Verdict verdict = judge_quality(summarise(log, synthetic_facts(), 0.0));
  EXPECT_EQ(verdict.grade, Grade::kPoor);
  EXPECT_EQ(verdict.headline, "much too coarse");
}

TEST(Verdict, ReportsThatAFixedStepOutranTheModelers) {
  RunFacts facts = synthetic_facts();
  facts.run.fixed_step = 10;
  const auto all_coarse = [](FrameRecord& r) {
    r.frame_ms = 20;
    r.too_coarse_percent = 50;
    r.synthesis_seconds = 0.019;
  };
  const std::string advice = text_of(judge_quality(flight(all_coarse, facts)).advice);
  EXPECT_NE(advice.find("the flight ran 4.98 times as fast as real time"), std::string::npos)
      << advice;
  EXPECT_NE(advice.find("--fixed-step above 10 Hz"), std::string::npos) << advice;
  EXPECT_EQ(advice.find("processor"), std::string::npos) << "modelers were busy";
  facts.run.fixed_step = Figure::missing("none");
  EXPECT_EQ(text_of(judge_quality(flight(all_coarse, facts)).advice).find("real time"),
            std::string::npos);
}

TEST(Verdict, ReportsThatModelersGotNoProcessor) {
  const std::string advice = text_of(judge_quality(flight([](FrameRecord& r) {
                                       r.too_coarse_percent = 50;
                                       r.synthesis_seconds = 0.001;
                                     })).advice);
  EXPECT_NE(advice.find("modelers used 2.00 % of the time of 1 processor"), std::string::npos)
      << advice;
}

TEST(Verdict, DoesNotBlameTheProcessorIfMemoryIsShort) {
  const Verdict verdict = judge_quality(flight([](FrameRecord& r) {
    r.too_coarse_percent = 50;
    r.synthesis_seconds = 0.001;
    r.requests_refused = 3;
  }));
  ASSERT_EQ(verdict.advice.size(), 1u) << text_of(verdict.advice);
  EXPECT_EQ(verdict.advice[0], "Raise --budget above 512 MiB.");
}

TEST(Verdict, ErrorsRaisedForMemoryOrTimeAreNotAsRequested) {
  const Verdict memory = judge_quality(flight([](FrameRecord& r) {
    r.error_pixels = 12;
    r.memory_factor = 3;
    r.requests_refused = 5;
  }));
  EXPECT_EQ(memory.grade, Grade::kFair);
  EXPECT_NE(text_of(memory.reasons).find("The geometry budget was too small in 200 of 200 frames"),
            std::string::npos)
      << text_of(memory.reasons);
  EXPECT_NE(text_of(memory.reasons).find("12.0 at most, instead of 4"), std::string::npos);
  EXPECT_NE(text_of(memory.advice).find("--budget above 512 MiB"), std::string::npos);
  RunFacts facts = synthetic_facts();
  facts.run.target_fps = 60;
  const Verdict target = judge_quality(flight([](FrameRecord& r) { r.error_pixels = 16; }, facts));
  EXPECT_EQ(target.grade, Grade::kFair);
  EXPECT_NE(
      text_of(target.reasons).find("To hold 60 frames/s, detail was reduced in 200 of 200 frames"),
      std::string::npos)
      << text_of(target.reasons);
  const Verdict pixels =
      judge_quality(flight([](FrameRecord& r) { r.resolution = r.index < 50 ? 0.6 : 0.8; }, facts));
  EXPECT_EQ(pixels.grade, Grade::kFair);
  EXPECT_NE(
      text_of(pixels.reasons).find("the render scale was 80.0 % in the median and 60.0 % at worst"),
      std::string::npos)
      << text_of(pixels.reasons);
  // While it still refines, in the first frames, the image counts as requested.
  EXPECT_EQ(
      judge_quality(flight([](FrameRecord& r) { r.error_pixels = r.index < 2 ? 16 : 4; }, facts))
          .grade,
      Grade::kGood);
}

TEST(Verdict, FailedModelsArePoor) {
  const Verdict verdict =
      judge_quality(flight([](FrameRecord& r) { r.models_failed = r.index == 3 ? 2 : 0; }));
  EXPECT_EQ(verdict.grade, Grade::kPoor);
  EXPECT_NE(text_of(verdict.reasons).find("2 models could not be synthesised"), std::string::npos);
}

TEST(Verdict, TheWorstGradeCountsAndAllReasonsAreGiven) {
  const Verdict verdict = judge_quality(flight([](FrameRecord& r) {
    r.holes = 1;
    r.too_coarse_percent = 5;
    r.error_pixels = 8;
    r.memory_factor = 2;
  }));
  EXPECT_EQ(verdict.grade, Grade::kPoor);
  EXPECT_EQ(verdict.headline, "incomplete");
  EXPECT_EQ(verdict.reasons.size(), 3u);
}

TEST(Verdict, IsUnknownWithoutMeasuredFrames) {
  const Verdict none = judge_quality(summarise(FrameLog({}), {}, 1.0));
  EXPECT_EQ(none.grade, Grade::kUnknown);
  EXPECT_TRUE(none.advice.empty());
  FrameLog log({});
  log.add({});
  const Verdict warm_up = judge_quality(summarise(log, {}, 1.0));
  EXPECT_EQ(warm_up.grade, Grade::kUnknown);
  EXPECT_NE(text_of(warm_up.advice).find("--warmup"), std::string::npos);
}

TEST(LeftOut, ListsTheReasonsOfExclusion) {
  Summary s;
  EXPECT_EQ(left_out_text(s), "");
  s.run.measured_frames = 100;
  s.run.timed_frames = 93;
  s.run.apart_frames = {93, 2, 4, 1, 0};
  EXPECT_EQ(
      left_out_text(s),
      "7 of 100 measured frames are excluded from timing statistics: 2 written as images, 4 after "
      "the GPU was idle, 1 while the window was resized.");
}

}  // namespace
}  // namespace psygen::telemetry
