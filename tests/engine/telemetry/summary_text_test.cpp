#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "engine/telemetry/summary.hpp"
#include "tests/engine/telemetry/synthetic_flight.hpp"

namespace psygen::telemetry {
namespace {

TEST(SummaryText, ShowsTheMostImportantNumbers) {
  const std::string text = to_text(summarise(synthetic_flight(), synthetic_facts(), 1.0));
  for (const char* part : {"paper", "512 x 512 blocks", "32.8 billion triangles", "8.40 TB",
                           "llvmpipe", "frames/s", "frames with holes", "505 MiB of 512 MiB",
                           "visibility", "triangles per busy second", "740 MiB"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

// Counts bytes that begin a character: some characters take several bytes.
std::ptrdiff_t columns_of(const std::string& line) {
  return std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
}

TEST(SummaryText, FitsAnEightyColumnTerminal) {
  RunFacts endless = synthetic_facts();
  endless.world.blocks = {0, 0};
  endless.world.triangles = endless.world.bytes = endless.world.bytes_paper = Count::missing("x");
  for (const RunFacts& facts : {synthetic_facts(), endless}) {
    std::istringstream lines(to_text(summarise(synthetic_flight(), facts, 0.0)));
    for (std::string line; std::getline(lines, line);)
      EXPECT_LE(columns_of(line), 78) << line;
  }
}

TEST(SummaryText, AnEndlessWorldHasValuesPerAreaInsteadOfDashes) {
  RunFacts facts = synthetic_facts();
  facts.world.blocks = {0, 0};
  facts.world.triangles = facts.world.bytes = facts.world.bytes_paper = Count::missing("no end");
  const std::string text = to_text(summarise(synthetic_flight(), facts, 1.0));
  EXPECT_NE(text.find("if generated       31.5 million triangles, 680 MB per square\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find(" kilometre, endless\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("– triangles"), std::string::npos) << text;
}

TEST(SummaryText, ShowsTheVerdictAndTheExcludedFrames) {
  FrameLog log = synthetic_flight();
  const std::string good = to_text(summarise(log, synthetic_facts(), 3.0));
  EXPECT_NE(good.find("picture    verdict            as requested\n"), std::string::npos) << good;
  EXPECT_EQ(good.find("excluded"), std::string::npos);
  FrameRecord picture = log.frames().back();
  picture.time_s += 0.02;
  picture.apart = Apart::kPicture;
  picture.holes = 1;
  log.add(picture);
  const std::string poor = to_text(summarise(log, synthetic_facts(), 3.0));
  EXPECT_NE(poor.find("verdict            incomplete\n"), std::string::npos) << poor;
  EXPECT_NE(poor.find("excluded           1 of "), std::string::npos) << poor;
}

TEST(SummaryText, ShowsADashForAMissingValue) {
  const std::string text = to_text(summarise(FrameLog({}), {}, 0.0));
  EXPECT_NE(text.find("median             – (– frames/s)"), std::string::npos) << text;
  EXPECT_NE(text.find("endless"), std::string::npos);
}

}  // namespace
}  // namespace psygen::telemetry
