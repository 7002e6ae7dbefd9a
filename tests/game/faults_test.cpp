// psygen on machines that are short of something: what it says, how it ends, what it leaves behind.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/full_disk.hpp"
#include "tests/game/run_psygen.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen {
namespace {

const std::string kFlight = "fly --headless --size 64x36 --view-distance 64 --budget 64M ";

std::string full_disk(const std::filesystem::path& folder, int calls_left = 0) {
  return "LD_PRELOAD=" PSYGEN_FAULTS " PSYGEN_FULL_DISK=" + folder.string() +
         " PSYGEN_CALLS_LEFT=" + std::to_string(calls_left);
}

// Starts psygen, waits until the flight has written its second picture, and runs `then` with its
// process in $p.
std::string once_it_flies(const std::filesystem::path& folder, const std::string& then) {
  return "run() { \"$@\" & p=$!; until [ -e " + (folder / "frame_00001.png").string() +
         " ]; do kill -0 $p || break; done; " + then + "; wait $p; }; run";
}

bool is_json(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return nlohmann::json::accept(stream);
}

TEST(Faults, AFlightOntoAFullDiskNamesEveryFileAndStillPrintsItsFigures) {
  const TemporaryFolder folder;
  const Outcome flight =
      run_psygen(kFlight + "--frames 3 --images 1 --json --record-requests " +
                     (folder / "requests").string() + " --out " + folder.path().string(),
                 full_disk(folder.path()));
  EXPECT_EQ(flight.code, 1) << flight.err;
  for (const char* name :
       {"frame_00000.png", "summary.json", "report.html", "frames.csv", "trace.json", "requests"}) {
    EXPECT_TRUE(mentions(flight.err, "error: " + (folder / name).string() + ": cannot ")) << name;
  }
  EXPECT_FALSE(mentions(flight.err, "frame_00001.png")) << flight.err;
  EXPECT_TRUE(nlohmann::json::accept(flight.out)) << flight.out;
  EXPECT_EQ(folder.file_count(), 0u);
}

TEST(Faults, EveryCommandThatWritesNamesTheFileForWhichThereIsNoRoom) {
  const TemporaryFolder folder;
  const std::string out = folder.path().string();
  for (const std::string& arguments :
       {"amplify --region 3,4,5,5 --out " + out, "export --model rock --out " + out + "/a.glb",
        "export --model rock --out " + out + "/a.obj", "calibrate --samples 4 --out " + out}) {
    const Outcome outcome = run_psygen(arguments, full_disk(folder.path(), 2));
    EXPECT_EQ(outcome.code, 1) << arguments << "\n" << outcome.err;
    EXPECT_TRUE(mentions(outcome.err, "No space left on device")) << outcome.err;
    EXPECT_TRUE(mentions(outcome.err, out + "/")) << outcome.err;
    EXPECT_EQ(folder.file_count(), 0u) << arguments;
  }
}

TEST(Faults, AFileThatMayNotBecomeSoLargeIsAnErrorAndNoSignal) {
  const TemporaryFolder folder;
  const std::string file = (folder / "block.glb").string();
  const Outcome outcome = run_psygen("export --block 5,6 --out " + file, "ulimit -f 20;");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(mentions(outcome.err, file + ": cannot write: File too large")) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(Faults, TheEndOfTheTerminalEndsAFlightWithAllItsOutputs) {
  const TemporaryFolder folder;
  // The kernel and the shell both say so.
  const Outcome flight =
      run_psygen(kFlight + "--seconds 3600 --images 1 --out " + folder.path().string(),
                 once_it_flies(folder.path(), "kill -HUP $p; kill -HUP $p"));
  EXPECT_EQ(flight.code, 0) << flight.err;
  EXPECT_TRUE(is_json(folder / "summary.json"));
  EXPECT_TRUE(is_json(folder / "trace.json"));
}

TEST(Faults, AFlightWithNohupGoesOnAfterTheEndOfTheTerminal) {
  const TemporaryFolder folder;
  const Outcome flight =
      run_psygen(kFlight + "--frames 20 --images 1 --json --out " + folder.path().string(),
                 "trap '' HUP; " + once_it_flies(folder.path(), "kill -HUP $p"));
  EXPECT_EQ(flight.code, 0) << flight.err;
  EXPECT_EQ(nlohmann::json::parse(flight.out)["run"]["frames"], 20) << flight.out;
}

// Descriptor 9 is a pipe that nobody reads.
class ClosedPipe {
 public:
  ClosedPipe() {
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    EXPECT_EQ(dup2(ends[1], 9), 9);
    close(ends[0]);
    close(ends[1]);
  }
  ~ClosedPipe() { close(9); }
};

TEST(Faults, AFlightWhoseMessagesNobodyReadsStillWritesItsOutputs) {
  const TemporaryFolder folder;
  const ClosedPipe pipe;
  const Outcome flight = run_psygen(kFlight + "--frames 3 --out " + folder.path().string() +
                                    " 2>&9 >&9; exit $?; true");
  EXPECT_EQ(flight.code, 1);
  EXPECT_TRUE(is_json(folder / "summary.json"));
  EXPECT_TRUE(is_json(folder / "trace.json"));
}

TEST(Faults, TheProgramStartsWithoutTheLibrariesOfPictures) {
  const Outcome libraries = run_psygen("models", "LD_TRACE_LOADED_OBJECTS=1");
  EXPECT_TRUE(mentions(libraries.out, "libstdc++")) << libraries.out;
  EXPECT_FALSE(mentions(libraries.out, "OpenImageIO")) << libraries.out;
}

}  // namespace
}  // namespace psygen
