#include <gtest/gtest.h>

#include <sstream>

#include "engine/telemetry/summary.hpp"
#include "tests/engine/telemetry/synthetic_flight.hpp"

namespace psygen::telemetry {
namespace {

TEST(SummaryText, NamesTheFiguresThatPeopleAskForFirst) {
  const std::string text = to_text(summarise(synthetic_flight(), synthetic_facts(), 1.0));
  for (const char* part : {"paper", "512 x 512 blocks", "32.8 billion triangles", "8.40 TB",
                           "llvmpipe", "frames/s", "frames with holes", "505 MiB of 512 MiB",
                           "visibility", "triangles per busy second", "740 MiB"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST(SummaryText, FitsAnEightyColumnTerminal) {
  const std::string text = to_text(summarise(synthetic_flight(), synthetic_facts(), 1.0));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    EXPECT_LE(line.size(), 100U) << line;
}

TEST(SummaryText, ShowsADashWhereAFigureIsMissing) {
  const std::string text = to_text(summarise(FrameLog({}), {}, 0.0));
  EXPECT_NE(text.find("median             – (– frames/s)"), std::string::npos) << text;
  EXPECT_NE(text.find("endless"), std::string::npos);
}

}  // namespace
}  // namespace psygen::telemetry
