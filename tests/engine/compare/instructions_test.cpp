#include "engine/compare/instructions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace psygen::compare {
namespace {

TEST(Instructions, AreWorseOrBetterFromOnePercentOn) {
  EXPECT_EQ((Instructions{1'000'000, 1'009'999}.verdict()), Verdict::kSame);
  EXPECT_EQ((Instructions{1'000'000, 1'010'001}.verdict()), Verdict::kWorse);
  EXPECT_EQ((Instructions{1'000'000, 990'001}.verdict()), Verdict::kSame);
  EXPECT_EQ((Instructions{1'000'000, 989'999}.verdict()), Verdict::kBetter);
}

TEST(Instructions, AreReadFromTheFileOfCallgrind) {
  EXPECT_EQ(instructions_in("events: Ir\nfn=(1) totals: 5\ntotals: 43982920\n", "a.callgrind"),
            43'982'920u);
  for (const char* text : {"", "events: Ir\n", "totals:\n", "totals: x\n", "totals: 0\n"})
    EXPECT_EQ(instructions_in(text, "a.callgrind").error().message,
              "a.callgrind: callgrind wrote no instruction count (totals)");
}

TEST(Instructions, FindTheHashOfAmplify) {
  EXPECT_EQ(hash_in("blocks   9\nhash                 3f254f2c46bdb9fc\nmore\n"),
            "3f254f2c46bdb9fc");
  EXPECT_EQ(hash_in("blocks   9\n"), "");
}

TEST(Instructions, AreFormattedAsTextAndAsJson) {
  const Instructions more{1000, 1020};
  EXPECT_EQ(to_text(more), "verdict: worse\n  instructions 1000 and 1020: +2.00 % (limit 1 %)\n");
  EXPECT_THAT(to_json(more), testing::HasSubstr("\"verdict\": \"worse\""));
}

}  // namespace
}  // namespace psygen::compare
