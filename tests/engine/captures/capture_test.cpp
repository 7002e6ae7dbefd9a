#include "engine/captures/capture.hpp"

#include <fmt/format.h>

#include <fstream>
#include <random>

#include "tests/engine/captures/fixture.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::captures {
namespace {

using testing::HasSubstr;

const std::string kTable = "Application,ProcessID,MsBetweenPresents\na,1,16.5\na,1,17.5\n";

std::string utf16(std::string_view text, bool little_endian) {
  std::string bytes = little_endian ? "\xff\xfe" : "\xfe\xff";
  for (const char c : text)
    bytes += little_endian ? std::string{c, '\0'} : std::string{'\0', c};
  return bytes;
}

TEST(Captures, AreReadInEveryEncodingAndLineEnd) {
  std::string crlf;
  for (const char c : kTable)
    crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  for (const std::string& text : {kTable, crlf, "\xef\xbb\xbf" + kTable, utf16(kTable, true),
                                  utf16(crlf, false), kTable.substr(0, kTable.size() - 1)})
    EXPECT_THAT(read_text(text), times_are({16.5, 17.5}));
}

TEST(Captures, AreReadFromFiles) {
  const TemporaryFolder folder;
  const auto file = folder / "a.csv";
  std::ofstream(file) << kTable;
  const auto capture = read(file);
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_THAT(*capture, times_are({16.5, 17.5}));
  EXPECT_EQ(capture->name, file.string());
  std::ofstream(folder / "empty.csv");
  EXPECT_THAT(read(folder / "empty.csv").error().message, HasSubstr("the file is empty"));
  EXPECT_EQ(read(folder / "none.csv").error().code, core::ErrorCode::kIo);
  EXPECT_EQ(read(folder / "").error().code, core::ErrorCode::kIo);
}

TEST(Captures, WithoutFrameTimesAreRefusedWithTheToolsName) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"Duration,Total Frames,Average FPS\n1,2,3\n", "give the file without -stats"},
      {"File,Application Name,Compositor,Average FPS\na,b,c,60\n", "a summary of OCAT"},
      {"fps=59.9\nfocus=220\n", "a rate every 300 frames, no frame times; log with mangoapp"},
      {"Engine v4\n\nProject FPS: 60 (16.66 mspf)\n", "a rate each second"},
      {"====\n    glmark2 2023.01\n====\n[build] a=b: FPS: 4 FrameTime: 2.4 ms\n",
       "means of scenes, no frames"},
      {"00, 02-01-2026 10:00:00, Hardware monitoring log v1.6\n", "Afterburner"},
      {"frame,time_s,frame_ms\n0,0,16\n", "give the folder of the run"},
      {"one,two\n1,2\n", "no capture that psygen reads"},
      {" \n\r\n", "the file is empty"},
  };
  for (const auto& [text, sentence] : cases) {
    EXPECT_THAT(error_of(text), HasSubstr(sentence));
    EXPECT_EQ(parse(text, "x").error().code, core::ErrorCode::kInvalidArgument) << text;
  }
}

TEST(Captures, WithoutFramesAreRefused) {
  EXPECT_THAT(error_of("Application,MsBetweenPresents\n"), HasSubstr("no rows"));
  EXPECT_THAT(error_of("Application,Dropped,MsBetweenPresents\na,1,16\n"),
              HasSubstr("the capture has no frames; left out: frames that were not displayed: 1"));
}

// Readers must neither crash nor hang; sanitizers watch.
TEST(Captures, ThatAreDamagedAreReadOrRefused) {
  const std::vector<std::string> texts = {
      kTable,
      "os,cpu,gpu\na,b,c\nfps,frametime,elapsed\n100,10,0\n100,10,10000000\n",
      "EVENTS,FrameTime,GameThreadTime\nA 1,2,16,3\n,15,2\nEVENTS,FrameTime,GameThreadTime\n"
      "[HasHeaderRowAtEnd],1\n",
      R"({"Runs": [{"CaptureData": {"MsBetweenPresents": [8], "Dropped": [false]}}]})",
      R"([{"name": "Frame", "ph": "X", "ts": 1, "dur": 11000}])",
      utf16(kTable, true)};
  std::mt19937 random(1);
  std::size_t taken = 0, refused = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string text = texts[static_cast<std::size_t>(round) % texts.size()];
    for (auto changes = 1 + random() % 4; changes > 0; --changes)
      text[random() % text.size()] = static_cast<char>(random());
    if (round % 5 == 0) text.resize(random() % text.size());
    const auto capture = parse(text, "x");
    ++(capture ? taken : refused);
    if (!capture) {
      EXPECT_THAT(capture.error().message, HasSubstr("x:"));
    }
  }
  EXPECT_GT(taken, 100U);
  EXPECT_GT(refused, 100U);
}

TEST(Captures, OfHostileLinesAreRefused) {
  EXPECT_THAT(error_of(std::string(2 << 20, ',')), HasSubstr("longer than 1 MiB"));
  const std::string quotes(900'000, '"');
  std::string cells, event = "Text";
  for (int i = 0; i < 400'000; ++i) {
    cells += ",\"";
    event += ",1";
  }
  for (const std::string& line : {quotes, cells, event})
    for (const char* header :
         {"Application,MsBetweenPresents\na,5\n", "EVENTS,FrameTime,GameThreadTime\n,16,3\n"})
      EXPECT_FALSE(parse(header + line + "x\n", "log.csv")) << line.substr(0, 10);
  std::string chains = "Application,ProcessID,MsBetweenPresents\n";
  for (int i = 0; i < 5000; ++i)
    chains += fmt::format("a,{},5\n", i);
  EXPECT_THAT(error_of(chains), HasSubstr("over 4096 swap chains"));
}

}  // namespace
}  // namespace psygen::captures
