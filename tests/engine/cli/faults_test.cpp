// Tests psygen on machines that lack a resource: its messages, its exit code, and the files it
// leaves.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/engine/cli/psygen_process.hpp"
#include "tests/full_disk.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::cli {
namespace {

const std::string kFlight = "fly --headless --size 64x36 --view-distance 64 --budget 64M ";

std::string full_disk(const std::filesystem::path& folder, int calls_left = 0) {
  return "LD_PRELOAD=" PSYGEN_FAULTS " PSYGEN_FULL_DISK=" + folder.string() +
         " PSYGEN_CALLS_LEFT=" + std::to_string(calls_left);
}

// Starts psygen, waits until the flight has written its second image, and runs `then` with its
// process id in $p.
std::string once_it_flies(const std::filesystem::path& folder, const std::string& then) {
  return "run() { \"$@\" & p=$!; until [ -e " + (folder / "frame_00001.png").string() +
         " ]; do kill -0 $p || break; done; " + then + "; wait $p; }; run";
}

bool is_json(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return nlohmann::json::accept(stream);
}

TEST(Faults, AFlightOntoAFullDiskNamesEveryFileAndStillPrintsItsSummary) {
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

TEST(Faults, EveryCommandNamesTheFileThatTheDiskIsTooFullFor) {
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

TEST(Faults, AFileSizeLimitIsAnErrorAndNoSignal) {
  const TemporaryFolder folder;
  const std::string file = (folder / "block.glb").string();
  const Outcome outcome = run_psygen("export --block 5,6 --out " + file, "ulimit -f 20;");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(mentions(outcome.err, file + ": cannot write: File too large")) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(Faults, AClosedTerminalEndsAFlightWithAllItsOutputs) {
  const TemporaryFolder folder;
  // Both the kernel and the shell send the signal.
  const Outcome flight =
      run_psygen(kFlight + "--seconds 3600 --images 1 --out " + folder.path().string(),
                 once_it_flies(folder.path(), "kill -HUP $p; kill -HUP $p"));
  EXPECT_EQ(flight.code, 0) << flight.err;
  EXPECT_TRUE(is_json(folder / "summary.json"));
  EXPECT_TRUE(is_json(folder / "trace.json"));
}

TEST(Faults, AFlightWithNohupContinuesAfterTheTerminalCloses) {
  const TemporaryFolder folder;
  const Outcome flight =
      run_psygen(kFlight + "--frames 20 --images 1 --json --out " + folder.path().string(),
                 "trap '' HUP; " + once_it_flies(folder.path(), "kill -HUP $p"));
  EXPECT_EQ(flight.code, 0) << flight.err;
  EXPECT_EQ(nlohmann::json::parse(flight.out)["run"]["frames"], 20) << flight.out;
}

// Descriptor 9 is a pipe without a reader.
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

TEST(Faults, AFlightWithoutAReaderOfItsMessagesStillWritesItsOutputs) {
  const TemporaryFolder folder;
  const ClosedPipe pipe;
  const Outcome flight = run_psygen(kFlight + "--frames 3 --out " + folder.path().string() +
                                    " 2>&9 >&9; exit $?; true");
  EXPECT_EQ(flight.code, 1);
  EXPECT_TRUE(is_json(folder / "summary.json"));
  EXPECT_TRUE(is_json(folder / "trace.json"));
}

TEST(Faults, TheProgramStartsWithoutTheImageLibraries) {
  const Outcome libraries = run_psygen("models", "LD_TRACE_LOADED_OBJECTS=1");
  EXPECT_TRUE(mentions(libraries.out, "libstdc++")) << libraries.out;
  EXPECT_FALSE(mentions(libraries.out, "OpenImageIO")) << libraries.out;
}

std::string few_threads(int left) {
  return "LD_PRELOAD=" PSYGEN_FAULTS " PSYGEN_THREADS_LEFT=" + std::to_string(left);
}

TEST(Faults, AmplifyContinuesWithFewerThreadsAndWarns) {
  const std::string command = "amplify --region 3,4,5,6 --threads 8 --json";
  const Outcome all = run_psygen(command);
  const Outcome some = run_psygen(command, few_threads(2));
  EXPECT_EQ(some.code, 0) << some.err;
  EXPECT_TRUE(mentions(some.err, "warning: only 2 of 4 threads can be started")) << some.err;
  const auto hash = [](const Outcome& outcome) {
    return nlohmann::json::parse(outcome.out)["hash"].get<std::string>();
  };
  EXPECT_EQ(hash(some), hash(all));
  const Outcome none = run_psygen(command, few_threads(0));
  EXPECT_EQ(none.code, 1);
  EXPECT_EQ(none.err.find("psygen: error: the system gives no more threads"), 0u) << none.err;
}

TEST(Faults, AFlightContinuesWithFewerModelersIfThreadsAreLimited) {
  const std::string command = kFlight + "--frames 3 --modelers 64 --json";
  // The driver takes 5 to 36 of them.
  const Outcome some = run_psygen(command, few_threads(40));
  EXPECT_EQ(some.code, 0) << some.err;
  EXPECT_TRUE(mentions(some.err, " of 64 modelers can be started: ")) << some.err;
  EXPECT_LT(nlohmann::json::parse(some.out)["run"]["modelers"], 64);
  const Outcome none = run_psygen(command, few_threads(0));
  EXPECT_EQ(none.code, 1);
  EXPECT_TRUE(mentions(none.err, "drawing needs at least 2 threads")) << none.err;
}

#ifdef PSYGEN_LIMITS_OF_MEMORY

// The limit that suffices differs from machine to machine. The end of a run must be orderly under
// any limit: success, or exit code 1 with a message, and complete files.
void expect_orderly(const Outcome& outcome, const std::string& what) {
  EXPECT_TRUE(outcome.code == 0 || outcome.code == 1) << what << " " << outcome.code << outcome.err;
  if (outcome.code == 1) {
    EXPECT_TRUE(mentions(outcome.err, "psygen: error: ")) << what << "\n" << outcome.err;
  }
}

// Uses the same number of threads on every machine, because their stacks and heaps count.
std::string limit(char which, int mib) {
  return std::string("ulimit -") + which + " " + std::to_string(mib * 1024) + "; LP_NUM_THREADS=2";
}
const std::string kTwoModelers = kFlight + "--modelers 2 --frames 5 ";

TEST(Faults, UnderAnyMemoryLimitEveryCommandEndsOrderly) {
  const TemporaryFolder folder;
  const std::string out = (folder / "out").string(), requests = (folder / "requests").string();
  ASSERT_EQ(run_psygen(kFlight + "--frames 3 --record-requests " + requests).code, 0);
  for (const std::string& arguments :
       {std::string("models"), "amplify --threads 2 --region 3,4,5,6 --out " + out,
        "export --block 5,6 --out " + (folder / "a.glb").string(),
        "calibrate --samples 4 --out " + out, "schedule --requests " + requests}) {
    for (const int mib : {2, 4, 8, 12, 16, 24, 40}) {
      std::filesystem::remove_all(out);
      expect_orderly(run_psygen(arguments, limit('d', mib)), arguments + std::to_string(mib));
      std::filesystem::remove_all(out);
      expect_orderly(run_psygen(arguments, limit('v', mib + 32)), arguments + std::to_string(mib));
    }
  }
}

TEST(Faults, UnderAnyMemoryLimitAnExportIsCompleteOrAbsent) {
  const TemporaryFolder folder;
  const std::filesystem::path glb = folder / "a.glb";
  int whole = 0, refused = 0;
  for (int mib = 14; mib <= 44; mib += 2) {
    std::filesystem::remove(glb);
    const Outcome made = run_psygen("export --block 3,4 --out " + glb.string(), limit('d', mib));
    expect_orderly(made, std::to_string(mib));
    ++(made.code == 0 ? whole : refused);
    ASSERT_EQ(std::filesystem::exists(glb), made.code == 0) << mib;
    if (made.code != 0) continue;
    std::array<unsigned char, 12> header{};
    std::ifstream(glb, std::ios::binary).read(reinterpret_cast<char*>(header.data()), 12);
    const std::size_t length = header[8] | header[9] << 8 | header[10] << 16;  // below 16 MiB
    EXPECT_EQ(std::filesystem::file_size(glb), length) << mib;
  }
  EXPECT_GT(whole, 0);
  EXPECT_GT(refused, 0);
}

TEST(Faults, UnderAnyMemoryLimitAFlightEndsOrderlyWithCompleteFiles) {
  for (const int mib : {8, 60, 80, 90, 100, 130, 150, 180, 220, 260, 300}) {
    const TemporaryFolder folder;
    const Outcome flight =
        run_psygen(kTwoModelers + "--out " + folder.path().string(), limit('d', mib));
    expect_orderly(flight, std::to_string(mib));
    for (const char* name : {"summary.json", "trace.json"})
      EXPECT_EQ(is_json(folder / name), std::filesystem::exists(folder / name)) << name;
    if (flight.code == 0) {
      EXPECT_TRUE(is_json(folder / "trace.json"));
    }
  }
}

TEST(Faults, OutOfMemoryReportsTheAllocationAndTheLimit) {
  const Outcome models = run_psygen("models", limit('d', 1));
  EXPECT_EQ(models.code, 1);
  EXPECT_TRUE(mentions(models.err, "psygen: error: memory ran out (")) << models.err;
  EXPECT_TRUE(mentions(models.err, " bytes more were wanted; ")) << models.err;
  EXPECT_TRUE(mentions(models.err, "ulimit -d allows 1 MiB)")) << models.err;
}

TEST(Faults, AFlightFitsIntoTheAvailableAddressSpace) {
  const Outcome flight = run_psygen(kTwoModelers + "--json", limit('v', 3 * 1024));
  EXPECT_EQ(flight.code, 0) << flight.err;
}

#endif

}  // namespace
}  // namespace psygen::cli
