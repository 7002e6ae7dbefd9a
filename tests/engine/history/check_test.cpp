#include "engine/history/check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/history/corpus.hpp"

namespace psygen::history {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

JudgedFigure judged(const std::vector<Entry>& entries, const std::string& test) {
  const auto result = check(entries, {.tests = {test}});
  EXPECT_TRUE(result) << test;
  return result && !result->figures.empty() ? result->figures.back() : JudgedFigure();
}

TEST(Check, JudgesTheCorpusRightly) {
  const std::vector<Entry> entries = testing::corpus();
  const std::vector<std::pair<const char*, Outcome>> right = {
      {"cpu_5_percent_20_and_5", Outcome::kWorse},
      {"cpu_5_percent_5_and_5", Outcome::kWorse},
      {"instructions_5_percent_5_and_5", Outcome::kWorse},
      {"wall_15_percent_20_and_20", Outcome::kWorse},
      {"counts_more", Outcome::kWorse},
      {"better_10_percent", Outcome::kBetter},
      {"two_steps", Outcome::kWorse},
      {"up_and_back", Outcome::kBetter},
      {"too_few_4_and_4", Outcome::kTooFew},
      {"only_3_runs_after", Outcome::kTooFew},
      {"missing_values", Outcome::kWorse},
      {"clock_goes_back", Outcome::kWorse},
      {"instructions_half_percent", Outcome::kSame},
      {"wall_15_percent_lost_in_noise", Outcome::kUndecided},
      {"identical_normal", Outcome::kTooFew},  // one revision: nothing before it
  };
  for (const auto& [test, outcome] : right)
    EXPECT_EQ(judged(entries, test).verdict.outcome, outcome)
        << test << ": " << judged(entries, test).verdict.reason;
}

TEST(Check, NoSeriesWithoutAChangeIsWorseAtAnyPlace) {
  const std::vector<Entry> entries = testing::corpus();
  for (const char* test :
       {"identical_normal", "identical_tailed", "identical_two_modes", "three_delayed_runs",
        "machine_slows_with_reference", "two_machines", "machine_replaced", "unit_changes",
        "instructions_constant", "counts_identical"})
    for (const std::size_t last : {5U, 10U, 15U}) {
      const auto result = check(entries, {.tests = {test}, .figures = {}, .last = last});
      ASSERT_TRUE(result) << test;
      for (const JudgedFigure& figure : result->figures)
        EXPECT_NE(figure.verdict.outcome, Outcome::kWorse) << test << figure.verdict.reason;
    }
}

TEST(Check, TheStepThatWouldStayUnseenIsSaid) {
  const JudgedFigure figure = judged(testing::corpus(), "wall_15_percent_lost_in_noise");
  EXPECT_THAT(figure.verdict.reason, HasSubstr("would stay unseen"));
  EXPECT_GT(100 * std::expm1(figure.verdict.unseen), 60) << "4 spreads of runs that differ by 12 %";
}

TEST(Check, OnlyNamedFiguresDecide) {
  const auto slower = testing::series({1, 1, 1, 1, 1, 2, 2, 2, 2, 2}, "frame_ms.p99", "ms", 5);
  const auto usual = check(slower, {});
  ASSERT_TRUE(usual);
  EXPECT_NE(usual->outcome, Outcome::kWorse);
  EXPECT_EQ(usual->figures[0].verdict.outcome, Outcome::kWorse) << "it is shown";
  const auto named = check(slower, {.figures = {"frame_ms.p99"}});
  ASSERT_TRUE(named);
  EXPECT_EQ(named->outcome, Outcome::kWorse);
}

// An old change lies before the entries that are compared.
TEST(Check, ShowsTheMediansOfTheEntriesThatItCompared) {
  std::vector<double> values(15, 1.3);
  values.insert(values.end(), 15, 1.0);
  values.insert(values.end(), 5, 1.1);
  const auto result = check(testing::series(values, "instructions", "", 30), {});
  ASSERT_TRUE(result);
  const JudgedFigure& figure = result->figures.at(0);
  EXPECT_EQ(figure.verdict.outcome, Outcome::kWorse);
  EXPECT_EQ(figure.verdict.before, 15U);
  EXPECT_EQ(figure.before, 1.0);
  EXPECT_EQ(figure.after, 1.1);
}

TEST(Check, OtherMachinesAreNeverComparedAndTheDifferenceIsNamed) {
  auto entries = testing::series({1, 1, 1, 1, 1, 2, 2, 2, 2, 2}, "instructions", "", 5);
  for (Entry& entry : entries)
    if (entry.revision == "new") entry.fingerprint = "CPU: Y; cores: 2";
  const auto result = check(entries, {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->outcome, Outcome::kTooFew);
  EXPECT_THAT(to_text(*result), HasSubstr("not comparable: different CPU: X and Y"));
}

TEST(Check, OtherUnitsAreNeverCompared) {
  auto entries = testing::series({16, 16, 16, 16, 16, 0.016, 0.016, 0.016, 0.016, 0.016},
                                 "frame_ms.p50", "ms", 5);
  for (Entry& entry : entries)
    if (entry.revision == "new") entry.unit = "s";
  const auto result = check(entries, {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->outcome, Outcome::kTooFew);
  EXPECT_THAT(result->notes, Contains(HasSubstr("its unit changes (ms, s)")));
}

TEST(Check, ClocksThatGoBackAreNamedAndTheOrderOfAddingCounts) {
  auto entries = testing::series({1, 1, 1, 1, 1, 2, 2, 2, 2, 2}, "instructions", "", 5);
  for (Entry& entry : entries)
    if (entry.revision == "new") entry.time -= 100'000;
  const auto result = check(entries, {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->outcome, Outcome::kWorse);
  EXPECT_THAT(result->notes, Contains(HasSubstr("the clock goes back by 99999 s at entry 6")));
}

TEST(Check, ValuesThatAreMissingOrNotAboveZeroAreLeftOutAndCounted) {
  auto entries = testing::series({1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2}, "instructions", "", 7);
  entries[1].value.reset();
  entries[2].value = 0;
  const auto result = check(entries, {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->figures[0].verdict.before, 5U);
  EXPECT_THAT(result->notes, Contains(HasSubstr("2 entries are without a usable value")));
}

TEST(Check, ASilentTestMayHaveBeenRenamed) {
  auto entries = testing::series({1, 1}, "instructions", "", 2);
  for (int i = 0; i < 10; ++i) {
    Entry other = entries[0];
    other.test = "stroll";
    other.order = 10 + i;
    other.time += 100 + i;
    other.revision = "r" + std::to_string(i);
    entries.push_back(other);
  }
  const auto result = check(entries, {});
  ASSERT_TRUE(result);
  EXPECT_THAT(result->notes, Contains(HasSubstr("psygen history rename walk NEW")));
}

TEST(Check, ConfirmedChangesNeedASecondLook) {
  const std::vector<double> five = {1, 1, 1, 1, 1, 2, 2, 2, 2, 2};
  std::vector<double> ten = five;
  ten.insert(ten.end(), 5, 2.0);
  const auto once = check(testing::series(five, "instructions", "", 5), {.confirm = true});
  const auto twice = check(testing::series(ten, "instructions", "", 5), {.confirm = true});
  ASSERT_TRUE(once && twice);
  EXPECT_EQ(once->outcome, Outcome::kUndecided);
  EXPECT_THAT(once->figures[0].verdict.reason, HasSubstr("add entries of this revision up to 10"));
  EXPECT_EQ(twice->outcome, Outcome::kWorse);
}

TEST(Check, UnknownNamesAreRefusedWithASuggestion) {
  const auto entries = testing::series({1, 1}, "instructions", "", 1);
  EXPECT_THAT(check(entries, {.tests = {"wlak"}}).error().message,
              HasSubstr("no test 'wlak'; did you mean walk?"));
  EXPECT_THAT(check(entries, {.figures = {"x"}}).error().message, HasSubstr("no figure 'x'"));
  EXPECT_THAT(check(entries, {.revision = "r9"}).error().message, HasSubstr("no revision 'r9'"));
  EXPECT_THAT(check({}, {}).error().message, HasSubstr("no entries"));
}

TEST(Check, IsToldAsTextJsonAndOnPullRequests) {
  const auto result =
      check(testing::series({1, 1, 1, 1, 1, 2, 2, 2, 2, 2}, "instructions", "", 5), {});
  ASSERT_TRUE(result);
  EXPECT_THAT(to_text(*result),
              HasSubstr("verdict: worse\n  walk instructions at new: worse: +100.0 %"));
  EXPECT_THAT(to_json(*result), HasSubstr("\"verdict\": \"worse\""));
  EXPECT_THAT(to_markdown(*result), HasSubstr("| walk | instructions | new |"));
  const auto remarks = remarks_of(*result);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].level, telemetry::RemarkLevel::kError);
}

}  // namespace
}  // namespace psygen::history
