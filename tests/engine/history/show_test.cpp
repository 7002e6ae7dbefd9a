#include "engine/history/show.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/history/corpus.hpp"

namespace psygen::history {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string page_of(const std::vector<Entry>& entries) {
  const auto shown = analyse(entries, {}, {});
  EXPECT_TRUE(shown);
  return shown ? to_html(*shown, "h.sqlite") : "";
}

TEST(Show, TheTableNamesEveryChange) {
  const auto entries = testing::corpus();
  const auto shown = analyse(entries, {"two_steps"}, {});
  ASSERT_TRUE(shown);
  const std::string text = to_text(*shown);
  EXPECT_THAT(text, HasSubstr("two_steps\n  cpu_s (s)"));
  EXPECT_THAT(text, HasSubstr("60 entries"));
  EXPECT_THAT(text,
              ::testing::ContainsRegex("\\+[78]\\.[0-9] % from entry [0-9]+ on, revision r01"));
}

TEST(Show, ThePageHasAPlotOfEachSeriesWithItsChanges) {
  auto entries = testing::series({1, 1, 1, 1, 1, 2, 2, 2, 2, 2}, "instructions", "", 5);
  for (Entry& entry : entries)
    entry.report = "out/walk";
  const std::string page = page_of(entries);
  EXPECT_THAT(page, HasSubstr("<b class=\"worse\">+100.0 %</b> at new, 2023-11-14 22:13"));
  EXPECT_THAT(page, HasSubstr("<a href=\"out/walk/report.html\">"));
  EXPECT_THAT(page, HasSubstr("1 change<"));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
}

TEST(Show, UntrustedTextsStayTexts) {
  auto entries = testing::series({1, 2}, "<script>alert(1)</script>", "", 1);
  entries[0].report = "javascript:alert(1)";
  entries[1].report = "a\"><script>b";
  const std::string page = page_of(entries);
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("javascript:")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;"));
}

TEST(Show, TenThousandRunsMakeAPageOfLessThanTwoMegabytes) {
  std::vector<double> values;
  for (std::size_t run = 0; run < 10'000; ++run)
    values.push_back(8 * (1 + 0.01 * static_cast<double>(run * 7919 % 101) / 101) *
                     (run >= 4000 ? 1.3 : 1));
  std::vector<Entry> entries;
  for (int figure = 0; figure < 18; ++figure) {
    auto each = testing::series(values, "frame_ms.p" + std::to_string(figure), "ms", 4000);
    for (Entry& entry : each)
      entry.report = "out/walk/0123456789ab/report.html";
    entries.insert(entries.end(), each.begin(), each.end());
  }
  const std::string page = page_of(entries);
  EXPECT_LT(page.size(), 2'000'000U);
  EXPECT_THAT(page, HasSubstr("10000 entries"));
  EXPECT_THAT(page, HasSubstr("18 changes"));
}

TEST(Show, SingleAndMissingValuesHaveAPlace) {
  auto one = testing::series({5}, "hitches", "", 1);
  EXPECT_THAT(page_of(one), HasSubstr("1 entry<"));
  one[0].value.reset();
  EXPECT_THAT(page_of(one), HasSubstr("without a usable value"));
  const auto shown = analyse(one, {}, {});
  EXPECT_THAT(to_text(*shown), HasSubstr("no usable value"));
}

TEST(Show, UnknownNamesAreRefused) {
  const auto entries = testing::series({5}, "hitches", "", 1);
  EXPECT_THAT(analyse(entries, {"wlk"}, {}).error().message, HasSubstr("did you mean walk?"));
  EXPECT_THAT(analyse(entries, {}, {"x"}).error().message, HasSubstr("no figure 'x'"));
  EXPECT_FALSE(analyse({}, {}, {}));
}

}  // namespace
}  // namespace psygen::history
