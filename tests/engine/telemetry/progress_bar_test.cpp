#include "engine/telemetry/progress_bar.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace psygen::telemetry {
namespace {

struct Recorder {
  std::vector<std::string> writes;
  Terminal terminal(bool interactive, int columns = 80) {
    return {interactive, columns, [this](std::string_view text) { writes.emplace_back(text); }};
  }
};

TEST(ProgressBar, WritesNothingWithoutATerminal) {
  Recorder recorder;
  {
    ProgressBar bar(recorder.terminal(false), "calibrating", 10);
    for (int i = 0; i <= 10; ++i)
      bar.update(i, i);
  }
  EXPECT_TRUE(recorder.writes.empty());
}

TEST(ProgressBar, ShowsFractionAndTimeLeftAndRemovesItselfAtTheEnd) {
  Recorder recorder;
  {
    ProgressBar bar(recorder.terminal(true), "prefill", 200);
    bar.update(0, 100.0);
    bar.update(50, 110.0);
  }
  ASSERT_EQ(recorder.writes.size(), 3U);
  EXPECT_NE(recorder.writes[0].find("prefill"), std::string::npos);
  EXPECT_NE(recorder.writes[0].find("0 %"), std::string::npos);
  EXPECT_NE(recorder.writes[1].find(" 25 %  0:30 left"), std::string::npos);
  EXPECT_NE(recorder.writes[1].find("[#######" + std::string(23, '.') + "]"), std::string::npos);
  EXPECT_EQ(recorder.writes[2], "\r\x1B[K");
}

TEST(ProgressBar, DrawsAtMostTenTimesASecond) {
  Recorder recorder;
  ProgressBar bar(recorder.terminal(true), "flying", 1000);
  for (int i = 0; i < 1000; ++i)
    bar.update(i, 5.0 + 0.001 * i);
  EXPECT_GE(recorder.writes.size(), 9U);
  EXPECT_LE(recorder.writes.size(), 10U);
}

TEST(ProgressBar, NeverWrapsOnANarrowTerminal) {
  Recorder recorder;
  ProgressBar bar(recorder.terminal(true, 20), "a label that is long already", 10);
  bar.update(5, 0.0);
  EXPECT_LE(recorder.writes.at(0).size(), 20 + std::string("\r\x1B[K").size() - 1);
}

TEST(ProgressBar, StaysBetweenZeroAndAHundredAndWorksWithoutATotal) {
  Recorder recorder;
  ProgressBar bar(recorder.terminal(true), "odd", 10);
  bar.update(25, 0.0);
  bar.update(-5, 1.0);
  EXPECT_NE(recorder.writes.at(0).find("100 %"), std::string::npos);
  EXPECT_NE(recorder.writes.at(1).find("  0 %"), std::string::npos);
  ProgressBar endless(recorder.terminal(true), "endless", 0);
  endless.update(25, 0.0);
  endless.update(26, 61.0);
  EXPECT_NE(recorder.writes.at(3).find("endless  1:01"), std::string::npos);
}

TEST(ProgressBar, DoesNothingAfterItHasFinished) {
  Recorder recorder;
  ProgressBar bar(recorder.terminal(true), "done", 10);
  bar.finish();
  bar.update(1, 0.0);
  bar.finish();
  EXPECT_TRUE(recorder.writes.empty());
}

}  // namespace
}  // namespace psygen::telemetry
