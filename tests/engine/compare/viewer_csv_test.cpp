#include "engine/compare/viewer_csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "engine/compare/csv_rows.hpp"

namespace psygen::compare {
namespace {

const std::string kFrames =
    "frame,time_s,frame_ms,present_ms,gpu_ms,apart,cache_bytes\n0,0.0,10.0000,1.5,5.0,,1073741824\n"
    "1,0.1,20.0000,,,not_drawn,0\n";
const std::string kViewerSummary =
    R"j({"device": {"name": "llvmpipe (LLVM 15.0.6, 256 bits)", "driver": "Mesa 22"},
        "world": {"name": "a \"wood\""}})j";

std::string converted(std::string_view viewer, const std::string& frames = kFrames) {
  const auto text = viewer_csv(viewer, frames, kViewerSummary, "dir");
  return text ? *text : text.error().message;
}

// Columns by name, as viewers find them. The first `lines` lines precede the header.
std::map<std::string, std::vector<std::string>> columns_of(std::string text, int lines) {
  for (; lines > 0; --lines)
    text.erase(0, text.find('\n') + 1);
  const std::string header = text.substr(0, text.find('\n'));
  std::vector<std::string_view> names;
  for (std::size_t begin = 0; begin <= header.size();) {
    const std::size_t end = std::min(header.find(',', begin), header.size());
    names.push_back(std::string_view(header).substr(begin, end - begin));
    begin = end + 1;
  }
  std::map<std::string, std::vector<std::string>> columns;
  const auto read =
      read_csv(text, "file", names, [&](CsvCells cells, const std::string&) -> core::Result<void> {
        for (std::size_t i = 0; i < cells.size(); ++i)
          columns[std::string(names[i])].emplace_back(cells[i]);
        return {};
      });
  EXPECT_TRUE(read) << read.error().message;
  return columns;
}

TEST(ViewerCsv, ForMangoHudHasItsColumnsInItsUnits) {
  const std::string text = converted("mangohud");
  auto system = columns_of(text.substr(0, text.find("\nfps,") + 1), 0);
  EXPECT_THAT(system["gpu"], testing::ElementsAre("llvmpipe (LLVM 15.0.6  256 bits)"));
  EXPECT_THAT(system["driver"], testing::ElementsAre("Mesa 22"));
  auto columns = columns_of(text, 2);
  EXPECT_EQ(columns.size(), 16u);
  EXPECT_THAT(columns["fps"], testing::ElementsAre("100.0000", "50.0000"));
  EXPECT_THAT(columns["frametime"], testing::ElementsAre("10.0000", "20.0000")) << "ms";
  EXPECT_THAT(columns["gpu_load"], testing::ElementsAre("50", "0")) << "percent";
  EXPECT_THAT(columns["gpu_vram_used"], testing::ElementsAre("1.0000", "0.0000")) << "GiB";
  EXPECT_THAT(columns["elapsed"], testing::ElementsAre("10000000", "30000000")) << "ns";
}

TEST(ViewerCsv, ForCapFrameXIsACaptureOfPresentMon) {
  const std::string text = converted("capframex");
  EXPECT_THAT(text, testing::StartsWith("Application,")) << "by which viewers detect the format";
  auto columns = columns_of(text, 0);
  EXPECT_THAT(columns["TimeInSeconds"], testing::ElementsAre("0.010000", "0.030000"));
  EXPECT_THAT(columns["MsBetweenPresents"], testing::ElementsAre("10.0000", "20.0000"));
  EXPECT_THAT(columns["MsBetweenDisplayChange"], testing::ElementsAre("10.0000", "0.0000"));
  EXPECT_THAT(columns["MsInPresentAPI"], testing::ElementsAre("1.5000", "0.0000"));
  EXPECT_THAT(columns["Dropped"], testing::ElementsAre("0", "1"));
  EXPECT_THAT(columns["Comment"], testing::ElementsAre("a  wood ", "a  wood "));
}

TEST(ViewerCsv, NamesAreNoFormulasOfSpreadsheets) {
  for (const char* name : {"=cmd|' /C calc'!A0", "+1", "-1", "@SUM(1)", "\\t=1"}) {
    const auto text = viewer_csv("capframex", kFrames,
                                 std::string(R"({"world": {"name": ")") + name + "\"}}", "dir");
    ASSERT_TRUE(text);
    EXPECT_EQ(columns_of(*text, 0)["Comment"][0].front(), '\'') << name;
  }
}

TEST(ViewerCsv, RejectsFilesThatNoRunWrites) {
  EXPECT_EQ(converted("mangohud", "frame_ms,apart\n"),
            "dir/frames.csv:1: the column present_ms is missing");
  EXPECT_EQ(converted("mangohud", kFrames + "2,0.2,x,,,,0\n"),
            "dir/frames.csv:4: frame_ms: 'x' is not a number from 0 on");
  EXPECT_EQ(converted("capframex", kFrames.substr(0, kFrames.size() - 1)),
            "dir/frames.csv: the file is truncated: its last line has no end");
  EXPECT_EQ(viewer_csv("mangohud", kFrames, "{", "dir").error().message,
            "dir/summary.json: it is not JSON, or is truncated");
  EXPECT_EQ(viewer_csv("mangohud", "no such folder").error().code, core::ErrorCode::kIo);
  EXPECT_FALSE(viewer_csv("excel", kFrames, kViewerSummary, "dir"));
}

}  // namespace
}  // namespace psygen::compare
