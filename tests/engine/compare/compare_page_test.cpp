#include "engine/compare/compare_page.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/compare/fixture.hpp"

namespace psygen::compare {
namespace {

using testing::HasSubstr;
using testing::Not;

const Sides kSides{"old/psygen test", "new/<b>psygen</b> test", "walk.toml"};

std::string page_of(const Sets& sets, const FalseAlarms* alarms = nullptr) {
  return to_html(judged(sets), sets.a, sets.b, kSides, alarms);
}

// In every frame, B misses `missing_percent` more of the image and is correspondingly faster.
Sets sets_that_skip_work(double missing_percent) {
  return make_sets(
      16,
      [=](RecordedRun& run, std::mt19937&) {
        run.missing_percent += missing_percent;
        for (double& percent : run.lacking)
          percent += missing_percent;
      },
      0.8);
}

TEST(ComparePage, SaysThatBIsFasterOnlyBecauseItDrawsLess) {
  const Sets sets = sets_that_skip_work(2);
  EXPECT_EQ(judged(sets).verdict, Verdict::kWorse);
  EXPECT_THAT(page_of(sets), HasSubstr("faster only because it draws less"));
  EXPECT_THAT(page_of(sets_that_skip_work(0)),
              HasSubstr("B is better: faster, and it shows as much"));
}

TEST(ComparePage, HasAHeadlineForEachVerdict) {
  EXPECT_EQ(headline(judged(make_sets(16, kNothing))), "B is the same as A");
  EXPECT_EQ(headline(judged(make_sets(16, kNothing, 1.1))), "B is worse: it is slower");
  EXPECT_THAT(headline(judged(make_sets(7, kNothing, 1.1))), HasSubstr("Inconclusive"));
  const auto rare = [](RecordedRun& run, std::mt19937&) {
    for (const std::size_t k : {7U, 50U, 90U})
      run.frame_ms[k] *= 2;
  };
  EXPECT_EQ(headline(judged(make_sets(16, rare))), "B is worse: some of its frames are slower");
}

TEST(ComparePage, ShowsEffectsIntervalsOfBothBatchesAndFalseAlarms) {
  const Sets sets = make_sets(16, kNothing, 1.1);
  const Comparison comparison = judged(sets);
  const FalseAlarms alarms{100, 1, 0, 3};
  const std::string page = page_of(sets, &alarms);
  for (const Batch& batch : comparison.batches)
    EXPECT_THAT(page, HasSubstr(fmt::format("× {:.3f} ({:.3f} to {:.3f})", batch.minima.ratio,
                                            batch.minima.low, batch.minima.high)));
  EXPECT_THAT(page, HasSubstr("A compared with itself 100 times: 1 worse"));
  EXPECT_THAT(page, HasSubstr("second batch (confirms the first): 8 pairs"));
}

TEST(ComparePage, OverlaysTheShortestTimesOfBothSidesWithoutExcludedFrames) {
  Sets sets = make_sets(16, kNothing, 1.1, 0);
  sets.b[3].left_out[4] = true;
  const std::string page = page_of(sets);
  EXPECT_THAT(page, HasSubstr(R"("name":"A","colour":1,"v":[10,11,12,13,null,10,)"));
  EXPECT_THAT(page, HasSubstr(R"("name":"B","colour":2,"v":[11,12.1,13.2,14.3,null,11,)"));
  EXPECT_THAT(page, HasSubstr(R"("name":"B / A","colour":5,"v":[1.1,1.1,)"));
  EXPECT_THAT(page, HasSubstr(R"("apart":{"4":"excluded from all runs"})"));
}

TEST(ComparePage, UsesTheNearestFrameForOtherTimes) {
  Sets sets = make_sets(1, kNothing, 1, 0);
  for (auto* run : {&sets.a[0], &sets.b[0]})
    run->virtual_clock = true, run->fixed_step.reset();
  for (double& time : sets.b[0].time_s)
    time *= 2;
  EXPECT_THAT(page_of(sets), HasSubstr(R"("name":"B","colour":2,"v":[10,11,11,)"));
}

TEST(ComparePage, EscapesCommandsAndNeedsNoExternalResources) {
  const std::string page = page_of(make_sets(16, kNothing));
  EXPECT_THAT(page, HasSubstr("new/&lt;b&gt;psygen"));
  for (const char* part : {"http:", "https:", "src=", "href=", "@import", "url("})
    EXPECT_THAT(page, Not(HasSubstr(part)));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace psygen::compare
