#include "engine/compare/compare_words.hpp"

#include <gmock/gmock.h>

#include "tests/engine/compare/fixture.hpp"

namespace psygen::compare {
namespace {

using telemetry::RemarkLevel;
using testing::HasSubstr;
using testing::StartsWith;

TEST(CompareWords, AreAnErrorForAWorseBuild) {
  const Sets sets = make_sets(
      16, [](RecordedRun&, std::mt19937&) {}, 1.3, 0.05);
  const auto comparison = compare(sets.a, sets.b);
  ASSERT_TRUE(comparison) << comparison.error().message;
  const Words words = words_of(*comparison, "tests/walk.toml");
  EXPECT_THAT(words.markdown, StartsWith("## Comparison: worse\n\n- frames take "));
  EXPECT_THAT(words.markdown, HasSubstr("\n| pairs | frames | frame time B / A |"));
  EXPECT_THAT(words.markdown, HasSubstr("| revision | 1234 | 1234 |"));
  ASSERT_EQ(words.remarks.size(), 1u);
  EXPECT_EQ(words.remarks[0].level, RemarkLevel::kError);
  EXPECT_EQ(words.remarks[0].title, "psygen compare: worse");
  EXPECT_THAT(words.remarks[0].message, StartsWith("frames take "));
  EXPECT_EQ(words.remarks[0].file, "tests/walk.toml");
}

TEST(CompareWords, NameConditionsThatDiffer) {
  const Sets sets =
      make_sets(8, [](RecordedRun& run, std::mt19937&) { run.required[2].text = "n|w"; });
  const auto comparison = compare(sets.a, sets.b, Conditions::kAcceptOthers);
  ASSERT_TRUE(comparison) << comparison.error().message;
  const Words words = words_of(*comparison, {});
  EXPECT_THAT(words.markdown,
              HasSubstr("The runs are not comparable:\n\n- different CPU: old and n\\|w\n"));
  EXPECT_EQ(words.remarks.back().level, RemarkLevel::kWarning);
  EXPECT_EQ(words.remarks.back().message, "different CPU: old and n|w");
  EXPECT_TRUE(words.remarks.back().file.empty());
}

TEST(CompareWords, TellInstructionsAndTimes) {
  const Words counted = words_of(Instructions{1000, 1100});
  EXPECT_EQ(counted.remarks.at(0).level, RemarkLevel::kError);
  EXPECT_EQ(counted.remarks.at(0).message, "1000 and 1100 instructions: +10.00 % (limit 1 %)");
  EXPECT_THAT(counted.markdown, StartsWith("## Comparison: worse\n\n- 1000 and 1100"));
  TimesComparison times;
  times.warnings = {"the columns differ"};
  TimesFigure& p50 = times.figures.emplace_back();
  p50.name = "p50";
  p50.unit = "ms";
  p50.a = 10;
  p50.b = 11;
  const Words of_times = words_of(times);
  EXPECT_THAT(of_times.markdown, HasSubstr("| p50 ms | 10.000 | 11.000 | – | – |"));
  EXPECT_THAT(of_times.markdown, HasSubstr("Warnings:\n\n- the columns differ\n"));
  ASSERT_EQ(of_times.remarks.size(), 2u);
  EXPECT_EQ(of_times.remarks[0].level, RemarkLevel::kWarning) << "inconclusive";
}

}  // namespace
}  // namespace psygen::compare
