#include "engine/compare/compare.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/compare/fixture.hpp"

namespace psygen::compare {
namespace {

using testing::HasSubstr;

std::string refusal(const Sets& sets) {
  const auto result = compare(sets.a, sets.b);
  return result ? "taken" : result.error().message;
}

TEST(Compare, FindsEqualSetsTheSameAndTenPercentWorseOrBetter) {
  EXPECT_EQ(judged(make_sets(16, kNothing)).verdict, Verdict::kSame);
  const Comparison worse = judged(make_sets(16, kNothing, 1.1));
  EXPECT_EQ(worse.verdict, Verdict::kWorse);
  EXPECT_THAT(worse.reasons.front(), HasSubstr("% more"));
  EXPECT_EQ(judged(make_sets(16, kNothing, 1 / 1.1)).verdict, Verdict::kBetter);
}

TEST(Compare, FindsAFewDoubledFramesFixedOrRandom) {
  const auto same = [](RecordedRun& run, std::mt19937&) {
    for (const std::size_t k : {20u, 50u})
      run.frame_ms[k] *= 2;
  };
  EXPECT_EQ(judged(make_sets(16, same)).verdict, Verdict::kWorse);
  const auto any = [](RecordedRun& run, std::mt19937& random) {
    for (int i = 0; i < 3; ++i)
      run.frame_ms[random() % run.frame_ms.size()] *= 2;
  };
  const Comparison rare = judged(make_sets(16, any));
  EXPECT_EQ(rare.verdict, Verdict::kWorse);
  EXPECT_THAT(rare.reasons, testing::Contains(HasSubstr("times their typical time")));
}

TEST(Compare, FasterWithMoreMissingOrALargerErrorIsNotBetter) {
  const auto skips = [](RecordedRun& run, std::mt19937&) { run.missing_percent = 2; };
  const Comparison missing = judged(make_sets(16, skips, 0.8));
  EXPECT_EQ(missing.verdict, Verdict::kWorse);
  EXPECT_THAT(missing.reasons, testing::Contains(HasSubstr("more geometry is missing")));
  EXPECT_THAT(missing.reasons, testing::Contains(HasSubstr("not better")));
  const auto coarser = [](RecordedRun& run, std::mt19937&) { run.error_pixels = 5; };
  EXPECT_EQ(judged(make_sets(16, coarser, 0.8)).verdict, Verdict::kWorse);
}

TEST(Compare, IsInconclusiveIfNoiseHidesWhetherAsMuchIsShown) {
  const auto varies = [](double percent, double error, double factor = 0.8) {
    Sets sets = make_sets(16, kNothing, factor);
    std::mt19937 random(3);
    for (Runs* runs : {&sets.a, &sets.b}) {
      for (RecordedRun& run : *runs) {
        run.missing_percent = percent * static_cast<double>(random() % 1000) / 1000;
        run.error_pixels = 4 + error * static_cast<double>(random() % 1000) / 1000;
      }
    }
    return judged(sets);
  };
  EXPECT_EQ(varies(0.2, 0).verdict, Verdict::kBetter) << "so little is invisible";
  const Comparison hidden = varies(10, 0);
  EXPECT_EQ(hidden.verdict, Verdict::kInconclusive);
  EXPECT_THAT(hidden.reasons, testing::Contains(HasSubstr("whether B shows as much")));
  EXPECT_EQ(varies(0, 3).verdict, Verdict::kInconclusive);
  EXPECT_EQ(varies(0, 0, 1).verdict, Verdict::kSame);
  EXPECT_EQ(varies(10, 0, 1).verdict, Verdict::kInconclusive);
}

TEST(Compare, FindsMoreProcessorTimeOfTheMainThreadIfFramesAreTooNoisy) {
  const auto costs = [](double factor) {
    return [factor](RecordedRun& run, std::mt19937&) {
      for (double& ms : run.cpu_ms)
        ms *= factor;
    };
  };
  const Comparison worse = judged(make_sets(16, costs(1.1), 1, 40));
  EXPECT_EQ(worse.verdict, Verdict::kWorse);
  EXPECT_THAT(worse.reasons, testing::ElementsAre(HasSubstr("10.0 % more processor time")));
  EXPECT_THAT(to_text(worse, nullptr), HasSubstr("processor time of the main thread 1.1"));
  EXPECT_EQ(judged(make_sets(16, costs(0.9))).verdict, Verdict::kBetter);
  EXPECT_EQ(judged(make_sets(16, costs(0.9), 1.1)).verdict, Verdict::kWorse) << "but slower";
  const auto unknown = [](RecordedRun& run, std::mt19937&) { run.cpu_ms.clear(); };
  EXPECT_EQ(judged(make_sets(16, unknown)).verdict, Verdict::kSame) << "frame time alone";
}

TEST(Compare, ADifferenceWithoutASecondBatchIsNotAVerdict) {
  const Comparison once = judged(make_sets(8, kNothing, 1.1));
  EXPECT_EQ(once.verdict, Verdict::kInconclusive);
  EXPECT_THAT(once.reasons, testing::Contains(HasSubstr("record 14 pairs")));
}

TEST(Compare, ReportsTheSizeOfHiddenChanges) {
  const Comparison loud = judged(make_sets(16, kNothing, 1, 40));
  EXPECT_EQ(loud.verdict, Verdict::kInconclusive);
  EXPECT_GT(loud.noise_percent, 1);
}

TEST(Compare, OnTheVirtualClockEveryDifferenceCounts) {
  const auto exact = [](double factor, double missing) {
    Sets sets = make_sets(1, kNothing, 1, 0);
    for (Runs* runs : {&sets.a, &sets.b})
      runs->front().virtual_clock = true;
    sets.b.front().frame_ms[3] *= factor;
    sets.b.front().missing_percent = missing;
    return judged(sets).verdict;
  };
  EXPECT_EQ(exact(1, 0), Verdict::kSame);
  EXPECT_EQ(exact(1.001, 0), Verdict::kWorse);
  EXPECT_EQ(exact(0.999, 0), Verdict::kBetter);
  EXPECT_EQ(exact(0.5, 0.001), Verdict::kWorse);
}

TEST(Compare, RunsUnderOtherConditionsAreComparedOnRequestAndTheVerdictSaysSo) {
  const Sets sets = make_sets(8, [](RecordedRun& run, std::mt19937&) {
    run.required[1].text = "320x180";
    run.required[2].text = "new";
    run.shown[0].text = "5678";
  });
  EXPECT_THAT(refusal(sets),
              HasSubstr("different size: 640x360 and 320x180, different CPU: old and new"));
  const auto forced = compare(sets.a, sets.b, Conditions::kAcceptOthers);
  ASSERT_TRUE(forced) << forced.error().message;
  EXPECT_THAT(forced->differences, testing::ElementsAre("different size: 640x360 and 320x180",
                                                        "different CPU: old and new"));
  const std::string text = to_text(*forced, nullptr), json = to_json(*forced, nullptr);
  EXPECT_THAT(text, HasSubstr(", although the runs are not comparable\n  different size"));
  EXPECT_THAT(text, HasSubstr("A: revision 1234, load before 0.5\nB: revision 5678"));
  EXPECT_THAT(json, HasSubstr("\"different CPU: old and new\""));
  const auto equal = compare(sets.a, sets.a);
  ASSERT_TRUE(equal);
  EXPECT_THAT(equal->differences, testing::IsEmpty());
  EXPECT_EQ(to_text(*equal, nullptr).find("although"), std::string::npos);
}

TEST(Compare, RejectsRunsThatCannotBeCompared) {
  const auto changed = [](auto change) {
    return make_sets(8, [change](RecordedRun& run, std::mt19937&) { change(run); });
  };
  EXPECT_EQ(
      refusal(changed([](RecordedRun& r) { r.required[0].text = "00ac"; })),
      "run and run are not comparable: different world hash: 00ab and 00ac; --anyway compares "
      "them");
  EXPECT_EQ(refusal(changed([](RecordedRun& r) { r.path_hash = "01"; })), "taken") << "older A";
  EXPECT_THAT(refusal(changed([](RecordedRun& r) { r.fixed_step = 60; })),
              HasSubstr("steps: 30 and 60"));
  EXPECT_THAT(refusal(changed([](RecordedRun& r) { r.time_s[5] += 0.001; })),
              HasSubstr("other paths"));
  EXPECT_THAT(refusal(changed([](RecordedRun& r) { r.frame_ms.pop_back(); })),
              HasSubstr("numbers of frames"));
  EXPECT_THAT(refusal(make_sets(6, kNothing)),
              HasSubstr("6 pairs of runs are too few; with fewer than 7"));
  EXPECT_THAT(refusal({}), HasSubstr("A has 0 and B has 0"));
  Sets sets = make_sets(8, kNothing);
  for (Runs* runs : {&sets.a, &sets.b})
    for (RecordedRun& run : *runs) {
      run.frame_ms.resize(40);
      run.time_s.resize(40);
    }
  EXPECT_THAT(refusal(sets), HasSubstr("40 frames after the warm-up; a comparison needs 50"));
  sets = make_sets(8, kNothing);
  for (RecordedRun& run : sets.a)
    run.path_hash = "01";
  for (RecordedRun& run : sets.b)
    run.path_hash = "02";
  EXPECT_THAT(refusal(sets), HasSubstr("paths: 01 and 02"));
  sets = make_sets(8, kNothing);
  for (Runs* runs : {&sets.a, &sets.b})
    for (RecordedRun& run : *runs)
      run.fixed_step.reset();
  EXPECT_THAT(refusal(sets), HasSubstr("it needs fixed_step"));
}

TEST(FalseAlarms, AreCountedOverComparisonsOfASetWithItself) {
  const Sets sets = make_sets(12, kNothing);
  Runs all = sets.a;
  all.insert(all.end(), sets.b.begin(), sets.b.end());
  const auto alarms = measure_false_alarms(all, 5, 1);
  ASSERT_TRUE(alarms) << alarms.error().message;
  EXPECT_EQ(alarms->comparisons, 5u);
  EXPECT_EQ(alarms->worse, 0u);
  EXPECT_FALSE(measure_false_alarms(sets.a, 5, 1));
}

TEST(Compare, IsFormattedAsTextAndAsJson) {
  const Comparison worse = judged(make_sets(16, kNothing, 1.1));
  const FalseAlarms alarms{100, 1, 0, 3};
  EXPECT_THAT(to_text(worse, &alarms), testing::StartsWith("verdict: worse\n"));
  EXPECT_THAT(to_text(worse, &alarms), HasSubstr("100 comparisons: 1 worse"));
  EXPECT_THAT(to_json(worse, nullptr), HasSubstr("\"verdict\": \"worse\""));
}

TEST(Compare, NamesWhatKeepsFiguresFromBeingCompared) {
  RecordedRun one;
  one.path_hash = "aa";
  one.fixed_step = 30;
  one.measured_frames = 90;
  one.required = {{"size", "640x360"}, {"CPU", "old"}};
  RecordedRun other = one;
  EXPECT_THAT(differences_of(one, other), testing::IsEmpty());
  other.measured_frames = 91;
  other.required[1].text = "new";
  EXPECT_THAT(
      differences_of(one, other),
      testing::ElementsAre("different numbers of frames: 90 and 91", "different CPU: old and new"));
  one.fixed_step = other.fixed_step = std::nullopt;
  EXPECT_THAT(differences_of(one, other), testing::ElementsAre("different CPU: old and new"))
      << "without a step the numbers of frames differ in each run";
  other = one;
  other.path_hash = "bb";
  EXPECT_THAT(differences_of(one, other), testing::ElementsAre("different paths: aa and bb"));
  other = one;
  other.virtual_clock = true;
  EXPECT_THAT(differences_of(one, other),
              testing::ElementsAre("different clocks: wall and virtual"));
}

}  // namespace
}  // namespace psygen::compare
