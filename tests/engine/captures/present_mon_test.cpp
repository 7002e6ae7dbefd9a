#include <fmt/format.h>

#include "tests/engine/captures/fixture.hpp"

namespace psygen::captures {
namespace {

using testing::HasSubstr;

const std::string kHeader1 =
    "Application,ProcessID,SwapChainAddress,Runtime,SyncInterval,PresentFlags,Dropped,"
    "TimeInSeconds,msInPresentAPI,msBetweenPresents\n";
std::string row1(const char* chain, double ms, int dropped = 0, double at = 0) {
  return fmt::format("{},DXGI,1,0,{},{},0.1,{}\n", chain, dropped, at, ms);
}
constexpr const char *kGame = "hill.exe,7,0xA0", *kOther = "hill.exe,7,0xB0",
                     *kDesktop = "dwm.exe,2,0xC0";

TEST(PresentMon, OneLeavesOutDroppedFramesAndCountsThem) {
  const Capture capture =
      read_text(kHeader1 + row1(kGame, 16) + row1(kGame, 17, 1) + row1(kGame, 18));
  EXPECT_THAT(capture, times_are({16, 18}));
  EXPECT_EQ(capture.tool, "PresentMon 1.7 to 1.10");
  EXPECT_EQ(capture.meaning, Meaning::kPresents);
  EXPECT_THAT(capture, notes_with("not displayed: 1"));
}

TEST(PresentMon, OneHasCapitalLettersUpTo16) {
  EXPECT_EQ(read_text("Application,ProcessID,SwapChainAddress,MsBetweenPresents\na,1,0x0,5\n").tool,
            "PresentMon 1.0 to 1.6");
}

TEST(PresentMon, ReadsTheSwapChainWithTheMostRowsButNotTheDesktop) {
  std::string text = kHeader1;
  for (int i = 0; i < 4; ++i)
    text += row1(kDesktop, 8);
  text += row1(kOther, 90) + row1(kGame, 10) + row1(kOther, 91) + row1(kGame, 11) + row1(kGame, 12);
  const Capture capture = read_text(text);
  EXPECT_THAT(capture, times_are({10, 11, 12}));
  EXPECT_THAT(capture, notes_with("rows of dwm.exe (process 2), swap chain 0xC0: 4"));
  EXPECT_THAT(capture, notes_with("rows of hill.exe (process 7), swap chain 0xB0: 2"));
  EXPECT_THAT(error_of(kHeader1 + row1(kDesktop, 8)), HasSubstr("dwm.exe, the desktop's"));
}

TEST(PresentMon, FindsColumnsInAnyOrderAndCase) {
  const Capture capture = read_text(
      "DROPPED,MSBETWEENPRESENTS,application,PROCESSID,swapchainaddress\n1,3,a,1,0\n0,4,a,1,0\n");
  EXPECT_THAT(capture, times_are({4}));
}

TEST(PresentMon, TwoPointZeroAddsBusyAndWaiting) {
  const Capture capture = read_text(
      "Application,ProcessID,SwapChainAddress,Runtime,CPUStartTime,CPUBusy,CPUWait,DisplayedTime\n"
      "a,1,0x0,DXGI,0,9.5,2,11.5\na,1,0x0,DXGI,11.5,8,1.25,0.000000\n"
      "a,1,0x0,DXGI,20.75,NA,3,9\n");
  EXPECT_THAT(capture, times_are({11.5, 3}));
  EXPECT_EQ(capture.column, "CPUBusy + CPUWait");
  EXPECT_EQ(capture.meaning, Meaning::kStarts);
  EXPECT_EQ(capture.tool, "PresentMon 2.0");
  EXPECT_THAT(capture, notes_with("not displayed: 1"));
}

const std::string kHeader22 =
    "Application,ProcessID,SwapChainAddress,PresentRuntime,FrameType,FrameTime,DisplayedTime\n";

TEST(PresentMon, TwoPointTwoLeavesOutGeneratedAndUndisplayedFrames) {
  const Capture capture =
      read_text(kHeader22 +
                "a,1,0,DXGI,Application,20,10\na,1,0,DXGI,Intel XeSS-FG,0.0000,10\n"
                "a,1,0,DXGI,Application,21,10\na,1,0,DXGI,Application,22,NA\n");
  EXPECT_THAT(capture, times_are({20, 21}));
  EXPECT_THAT(capture, notes_with("generated frames: 1"));
  EXPECT_THAT(capture, notes_with("not displayed: 1"));
}

TEST(PresentMon, KeepsFramesOfADisplayThatIsNotTracked) {
  EXPECT_THAT(read_text(kHeader22 + "a,1,0,DXGI,NA,20,NA\na,1,0,DXGI,NA,21,NA\n"),
              times_are({20, 21}));
}

const std::string kHeader24 =
    "Application,ProcessID,SwapChainAddress,PresentRuntime,TimeInMs,MsBetweenAppStart,"
    "MsBetweenPresents,MsBetweenDisplayChange,MsUntilDisplayed\n";

TEST(PresentMon, TwoPointFourReadsPresentsAndNotStarts) {
  const Capture capture =
      read_text(kHeader24 + "a,1,0,DXGI,0,5,6,6,9\na,1,0,DXGI,7,8,7,NA,9\na,1,0,DXGI,15,8,8,8,9\n");
  EXPECT_THAT(capture, times_are({6, 8}));
  EXPECT_EQ(capture.meaning, Meaning::kPresents);
  EXPECT_EQ(capture.tool, "PresentMon 2.3.1 or later");
}

TEST(PresentMon, TakesTheNextColumnIfTheFirstIsEmptyThroughout) {
  const Capture capture = read_text(kHeader24 + "a,1,0,DXGI,0,5,NA,6,9\na,1,0,DXGI,7,8,NA,7,9\n");
  EXPECT_THAT(capture, times_are({5, 8}));
  EXPECT_EQ(capture.meaning, Meaning::kStarts);
  EXPECT_THAT(capture, notes_with("MsBetweenPresents has no value throughout"));
  const Capture displayed =
      read_text("Application,ProcessID,DisplayedTime\na,1,16\na,1,NA\na,1,17\n");
  EXPECT_THAT(displayed, times_are({16, 17}));
  EXPECT_EQ(displayed.meaning, Meaning::kDisplayed);
}

TEST(PresentMon, WarnsOfTimesThatDoNotAddUpToTheClock) {
  std::string mixed = kHeader1, whole = kHeader1;
  for (int i = 0; i < 20; ++i) {
    mixed += row1(kGame, 10, 0, 0.005 * i);
    whole += row1(kGame, 10, 0, 0.010 * i);
  }
  EXPECT_THAT(read_text(mixed), notes_with("several swap chains are mixed"));
  EXPECT_TRUE(read_text(whole).notes.empty());
}

TEST(PresentMon, CountsLostEvents) {
  EXPECT_THAT(read_text("Application,MsBetweenPresents,EtwEventsLost\na,5,0\na,6,12\n"),
              notes_with("12 events were lost"));
}

const std::string kOcat =
    "Application,ProcessID,SwapChainAddress,Dropped,MsBetweenPresents,MsEstimatedDriverLag,"
    "Motherboard,OS,GPU\n";

TEST(Ocat, HasSystemColumnsOnlyInItsFirstRow) {
  const Capture capture =
      read_text(kOcat +
                "a,1,0,0,10,1,\"Board, two\",X,One GPU,Another GPU,9\na,1,0,1,11,1\n"
                "a,1,0,0,12,1\n");
  EXPECT_THAT(capture, times_are({10, 12}));
  EXPECT_EQ(capture.tool, "OCAT");
  EXPECT_THAT(error_of(kOcat + "a,1,0,0,10,1\na,1,0,0,11\na,1,0,0,12,1\n"),
              HasSubstr("log.csv:3: the line has 5 cells"));
}

TEST(Ocat, ReadsTheFramesOfAHeadset) {
  EXPECT_THAT(read_text("Application,ProcessID,MsBetweenAppPresents,AppMissed\na,1,11,0\n"
                        "a,1,12,1\na,1,13,0\n"),
              times_are({11, 13}));
}

TEST(CapFrameX, CsvHasAPreambleAndSurvivesASpreadsheet) {
  const Capture plain = read_text(
      "//GameName=Hills, part=2\r\n//Comment=\r\n"
      "Application,ProcessID,Dropped,MsBetweenPresents\r\na,1,0,4.5\r\na,1,1,4\r\n");
  EXPECT_THAT(plain, times_are({4.5}));
  EXPECT_EQ(plain.tool, "CapFrameX");
  EXPECT_THAT(read_text("//GameName=Hills;;;\nApplication;ProcessID;Dropped;MsBetweenPresents\n"
                        "a;1;0;4,5\na;1;0;12,25\n;;;\n"),
              times_are({4.5, 12.25}));
}

TEST(FrameView, HasCellsThatAreNotMeasured) {
  const Capture capture = read_text(
      "Application,GPU,CPU,Resolution,Dropped,MsBetweenPresents,GPU0Util(%)\n"
      "a,G,C,1x1,0,14,NA\na,G,C,1x1,1,13,NA\na,G,C,1x1,0,N/A,NA\na,G,C,1x1,0,15,3\n");
  EXPECT_THAT(capture, times_are({14, 15}));
  EXPECT_EQ(capture.tool, "FrameView");
  EXPECT_THAT(capture, notes_with("rows without a time: 1"));
  EXPECT_THAT(error_of("Application,Resolution,Avg FPS,1% FPS\na,1x1,60,50\n"),
              HasSubstr("a summary, no frames"));
}

TEST(PresentMon, RefusesDecimalCommasBetweenCommas) {
  EXPECT_THAT(error_of("Application,ProcessID,MsBetweenPresents\na,1,16,5\na,1,17\n"),
              HasSubstr("log.csv:2: the line has 4 cells (line 3 has 3) under a header of 3: "
                        "decimal commas"));
}

TEST(PresentMon, RefusesTimesThatAreNone) {
  for (const char* time : {"-1", "1e300", "sixteen", "16.5ms", "0x10", "1,000"}) {
    const std::string text = fmt::format("Application;MsBetweenPresents\na;5\na;{}\n", time);
    if (std::string_view(time) == "1,000") {
      EXPECT_THAT(read_text(text), times_are({5, 1}));
    } else {
      EXPECT_THAT(error_of(text), HasSubstr("log.csv:3: '")) << time;
    }
  }
  EXPECT_THAT(read_text("Application,MsBetweenPresents\na,5\na,NaN\na,-inf\na,\na,1.#QNAN\n"),
              notes_with("rows without a time: 4"));
}

}  // namespace
}  // namespace psygen::captures
