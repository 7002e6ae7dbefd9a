// `psygen convert` on files of runs.
#include <fstream>

#include "tests/engine/cli/psygen_process.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::cli {
namespace {

void write_run(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "frames.csv")
      << "frame_ms,present_ms,gpu_ms,cache_bytes,apart\n10,0,0,0,\n";
  std::ofstream(folder / "summary.json") << R"({"device": {"name": "paper and pencil"}})";
}

TEST(Convert, WritesTheFramesOfARunForAViewer) {
  const TemporaryFolder folder;
  write_run(folder / "run");
  const std::string run = (folder / "run").string(), out = (folder / "log.csv").string();
  const Outcome done = run_psygen("convert " + run + " --to mangohud --out " + out);
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_TRUE(mentions(read(out), "paper and pencil")) << read(out);
  EXPECT_TRUE(mentions(read(out), "\n100.0000,10.0000,")) << read(out);
  EXPECT_EQ(run_psygen("convert " + run + " --to capframex --out " + out).code, 0);
  EXPECT_TRUE(read(out).starts_with("Application,"));
}

TEST(Convert, SaysWhatItCannotReadWriteOrKnow) {
  const TemporaryFolder folder;
  write_run(folder / "run");
  const std::string run = (folder / "run").string();
  const Outcome none = run_psygen("convert /nowhere --to mangohud --out log.csv");
  EXPECT_EQ(none.code, 1);
  EXPECT_TRUE(mentions(none.err, "/nowhere/frames.csv: cannot be read")) << none.err;
  const Outcome unwritable = run_psygen("convert " + run + " --to mangohud --out /nowhere/log.csv");
  EXPECT_EQ(unwritable.code, 1);
  EXPECT_TRUE(mentions(unwritable.err, "/nowhere/log.csv")) << unwritable.err;
  EXPECT_EQ(run_psygen("convert " + run + " --to excel --out log.csv").code, 2);
}

}  // namespace
}  // namespace psygen::cli
