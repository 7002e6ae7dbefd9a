#include "tests/engine/captures/fixture.hpp"

namespace psygen::captures {
namespace {

using testing::HasSubstr;

const std::string kEarly = "EVENTS,FrameTime,GameThreadTime\n";
const std::string kLate = "EVENTS,FrameTime,GameThreadTime,GPUTime,Draws\n";
const std::string kMetadata = "[HasHeaderRowAtEnd],1,[platform],X,[Commandline],\"-a=b,c\"\n";

TEST(Unreal, EarlyRowsLackLateColumns) {
  const Capture capture = read_text(
      kEarly + "Load,400,300\n,16,11\n,17,11,9,1000\nEnd,18,11,9,1000\n" + kLate + kMetadata);
  EXPECT_THAT(capture, times_are({400, 16, 17, 18}));
  EXPECT_EQ(capture.meaning, Meaning::kGameThread);
  EXPECT_TRUE(capture.notes.empty());
}

TEST(Unreal, CommasInEventsShiftTheOtherCells) {
  EXPECT_THAT(read_text(kEarly +
                        ",14,10\nCmd: scale 80,70,15,10\n\"quoted, event\",16,10\n"
                        "Spawn (1,2,3);Next,17,10\n" +
                        kEarly + kMetadata),
              times_are({14, 15, 16, 17}));
}

TEST(Unreal, EventsMayComeWithNewColumns) {
  EXPECT_THAT(
      read_text(kEarly + ",14,10\nJump 1,2,15,10,9,1000\n,16,10,9,1000\n" + kLate + kMetadata),
      times_are({14, 15, 16}));
}

TEST(Unreal, AddsUpAColumnThatOccursTwice) {
  EXPECT_THAT(read_text("FrameTime,GameThreadTime,FrameTime\n10,8,2\n11,8,3\n"),
              times_are({12, 14}));
}

TEST(Unreal, AnUnfinishedCaptureHasANoteAndMayEndInARow) {
  const Capture capture = read_text(kEarly + ",14,10\n,15,11,9\n,1");
  EXPECT_THAT(capture, times_are({14, 15}));
  EXPECT_THAT(capture, notes_with("the capture was cut"));
  EXPECT_THAT(capture, notes_with("the cut last row"));
}

TEST(Unreal, RefusesShortRowsAndDecimalCommas) {
  EXPECT_THAT(error_of(kEarly + ",14,10,9,1\n,15,11\n" + kLate + kMetadata),
              HasSubstr("log.csv:3: the line has 3 cells"));
  EXPECT_THAT(error_of(kEarly + ",14,5,10,5\n" + kEarly + kMetadata),
              HasSubstr("log.csv:2: the line has 5 cells under a header of 3"));
}

TEST(Unreal, NamesTheTextFormOfItsBinary) {
  EXPECT_THAT(error_of(std::string("\x06"
                                   "CSVBIN\x03\0\0\0",
                                   11)),
              HasSubstr("convert it to the text form (.csv)"));
  EXPECT_THAT(error_of("\x1f\x8b\x08"), HasSubstr("-csvCompression=0"));
}

const std::string kUnity =
    "Frame Offset, Frame Index, Frame Time (ms), Time from first frame (ms)\r\n";

TEST(ProfileAnalyzer, ReadsItsExportOfFrameTimes) {
  const Capture capture = read_text(kUnity + "0,301,15.5,0\r\n1,302,16.25,15.5\r\n");
  EXPECT_THAT(capture, times_are({15.5, 16.25}));
  EXPECT_EQ(capture.tool, "Unity Profile Analyzer");
  EXPECT_THAT(read_text("Frame Offset;Frame Index;Frame Time (ms)\n0;1;15,5\n"), times_are({15.5}));
}

TEST(ProfileAnalyzer, RefusesDecimalCommasMarkersAndItsBinary) {
  EXPECT_THAT(error_of(kUnity + "0,301,15,2785,0\r\n1,302,16,2682,15,2785\r\n"),
              HasSubstr("log.csv:2: the line has 5 cells (line 3 has 6) under a header of 4: "
                        "decimal commas"));
  EXPECT_THAT(error_of("Name, Median Time, Min Time\nUpdate, 3, 2\n"),
              HasSubstr("export the frame times of the Profile Analyzer, not its markers"));
  EXPECT_THAT(error_of(std::string("\x07\0\0\0\0\0\0\0\x0a\0\0\0", 12)),
              HasSubstr("export the frame times as CSV"));
}

}  // namespace
}  // namespace psygen::captures
