#include "engine/history/exchange.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/history/corpus.hpp"

namespace psygen::history {
namespace {

using ::testing::HasSubstr;

std::vector<Entry> odd_entries() {
  std::vector<Entry> entries = testing::series({0.1, 1e-300, 123456789.123456789}, "a,b", "ms", 2);
  entries[0].test = "quotes \" and\nlines, too";
  entries[0].report = "out/\xC3\xA4/report.html";
  entries[1].value.reset();
  entries[1].reference = 1.0 / 3;
  entries[2].work = 1017;
  return entries;
}

TEST(Exchange, AllColumnsSurviveBothFormats) {
  const auto entries = odd_entries();
  for (const auto format : {ExchangeFormat::kCsv, ExchangeFormat::kJsonLines}) {
    const std::string text = to_text(entries, format);
    const auto back = parse_entries(text, "file");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->entries, entries);
    EXPECT_EQ(to_text(back->entries, format), text);
  }
}

TEST(Exchange, TheFiguresOfAJobStayTogether) {
  auto entries = testing::series({1, 2}, "a", "", 2);
  entries[1].order = 1;
  entries[1].figure = "b";
  entries[1].time = entries[0].time;
  const auto back = parse_entries(to_text(entries, ExchangeFormat::kCsv), "file");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->entries[1].order, 1);
}

TEST(Exchange, ValuesThatAreNoNumbersAreMissingAndCounted) {
  const auto read = parse_entries("test,figure,value\nt,f,nan\nt,f,\nt,f,inf\nt,f,2\n", "file");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->entries.size(), 4U);
  EXPECT_FALSE(read->entries[2].value);
  EXPECT_EQ(read->entries[3].value, 2);
  EXPECT_THAT(read->notes, ::testing::ElementsAre("t: 3 values are missing or not a number"));
}

TEST(Exchange, ByteOrderMarksAndCarriageReturnsAreRead) {
  const auto read = parse_entries("\xEF\xBB\xBFvalue,series,figure,run\r\n2.5,t,f,7\r\n", "file");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->entries[0].test, "t");
  EXPECT_EQ(read->entries[0].value, 2.5);
}

TEST(Exchange, DamagedTextsAreRefusedWithTheirPlace) {
  const std::string header = "test,figure,value\n";
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"", "file: the file is empty"},
      {"test,figure\n", "file:1: the column value is missing"},
      {"test,figure,valu\n", "file:1: 'valu' is not a column of a history; did you mean value?"},
      {"test,test,value\n", "file:1: the column test is there twice"},
      {header + "t,f,1\nt,f,1", "file:3: the last line has no end: the file is truncated"},
      {header + "t,f\n", "file:2: the row has 2 cells, and the header 3"},
      {header + "t,f,\"1,5\"\n", "file:2: value: '1,5' is not a number"},
      {header + "t,f,1,5\n", "file:2: the row has 4 cells, and the header 3"},
      {header + ",f,1\n", "file:2: a row needs a test and a figure"},
      {header + "\"t,f,1\n", "file:2: a quote is open"},
      {"test,figure,value,time\nt,f,1,noon\n", "file:2: time: 'noon' is not a whole number"},
      {"{\"test\":\"t\"\n", "file:1: the line is not a JSON object"},
      {"{\"test\":\"t\",\"figure\":\"f\",\"value\":[1]}\n",
       "file:1: value: it must be a text, a number or null"},
      {"{\"test\":\"t\",\"figure\":\"f\",\"value\":1}", "file:1: the last line has no end"},
  };
  for (const auto& [text, message] : bad) {
    const auto read = parse_entries(text, "file");
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, core::ErrorCode::kParse);
    EXPECT_THAT(read.error().message, HasSubstr(message));
  }
}

}  // namespace
}  // namespace psygen::history
