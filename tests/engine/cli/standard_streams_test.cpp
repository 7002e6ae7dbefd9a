#include <gtest/gtest.h>

#include "tests/engine/cli/psygen_process.hpp"
#include "tests/source_file.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::cli {
namespace {

constexpr const char* kFull = ">/dev/full";
constexpr const char* kClosed = ">&-";

Outcome run_with(const std::string& redirection, const std::string& arguments) {
  return run_psygen(arguments, "", source_file(""), redirection);
}

TEST(StandardStreams, AFullOrClosedStdoutFailsEveryCommandWithAMessage) {
  const TemporaryFolder folder;
  const std::string requests = (folder / "requests").string();
  std::ofstream(requests) << "psygen requests 2\n0 0.001 - 0\n";
  for (const std::string arguments :
       {"--help", "--version", "fly --help", "schedule --help", "models", "models --json",
        "amplify --sample 1,1", "amplify --region 3,4,4,5 --json", "calibrate --samples 4",
        "fly --headless --frames 2 --size 64x36 --view-distance 64", "schedule --requests FILE"}) {
    std::string command = arguments;
    if (const auto at = command.find("FILE"); at != std::string::npos)
      command.replace(at, 4, requests);
    for (const char* redirection : {kFull, kClosed}) {
      const Outcome outcome = run_with(redirection, command);
      EXPECT_EQ(outcome.code, 1) << command << redirection << "\n" << outcome.err;
      EXPECT_TRUE(mentions(outcome.err, "psygen: error: cannot write to standard output: "))
          << command << redirection << "\n"
          << outcome.err;
    }
  }
}

TEST(StandardStreams, OutputForAClosedStdoutIsNotWrittenToAnotherFile) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_with(">&- 2>&-", "fly --headless --frames 2 --size 64x36 --view-distance 64 --out " +
                               folder.path().string());
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(read(folder / "frames.csv").find("frame"), 0u);
  EXPECT_EQ(read(folder / "summary.json").front(), '{');
  for (const auto& file : std::filesystem::directory_iterator(folder.path()))
    EXPECT_FALSE(mentions(read(file.path()), "psygen: info")) << file.path();
}

TEST(StandardStreams, ACommandWithoutOutputNeedsNoStdout) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_with(kClosed, "export --model rock --out " + (folder / "a.glb").string());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(read(folder / "a.glb").substr(0, 4), "glTF");
}

}  // namespace
}  // namespace psygen::cli
