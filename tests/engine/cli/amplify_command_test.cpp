// Tests `psygen amplify` as a process: hashes, samples, files, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/engine/cli/psygen_process.hpp"
#include "tests/source_file.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::cli {
namespace {

// The world's hash in the output of amplify --json; empty if there is none.
std::string hash_in(const std::string& json) {
  const std::string name = "\"hash\": \"";
  const std::size_t at = json.find(name);
  return at == std::string::npos ? "" : json.substr(at + name.size(), 16);
}

TEST(CommandLine, AmplifyPrintsTheSameHashForAnyNumberOfThreads) {
  const Outcome text = run_psygen("amplify --region 3,4,5,6 --threads 1");
  EXPECT_EQ(text.code, 0) << text.err;
  for (const char* name : {"blocks", "models", "triangles", "bytes", "seconds",
                           "triangles_per_second_per_core", "hash"}) {
    EXPECT_TRUE(mentions(text.out, name)) << name;
  }
  const Outcome json = run_psygen("amplify --region 3,4,5,6 --threads 3 --json");
  EXPECT_EQ(json.code, 0) << json.err;
  EXPECT_TRUE(mentions(json.out, "\"blocks\": 4,")) << json.out;
  ASSERT_EQ(hash_in(json.out).size(), 16u) << json.out;
  EXPECT_TRUE(mentions(text.out, hash_in(json.out)));
  const Outcome scalar = run_psygen("amplify --region 3,4,5,6 --simd scalar --json");
  EXPECT_EQ(scalar.code, 0) << scalar.err;
  EXPECT_EQ(hash_in(scalar.out), hash_in(json.out));
}

TEST(CommandLine, AmplifyOfAWorldWithSpeciesHasTheSameHashForAnyNumberOfThreads) {
  const std::string command =
      "amplify --world game/worlds/five_species.toml --region=-3,4,-1,6 --json --threads ";
  const Outcome one = run_psygen(command + "1"), two = run_psygen(command + "2");
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_TRUE(mentions(one.out, "\"failed\": 0,")) << one.out;
  EXPECT_EQ(hash_in(one.out).size(), 16u) << one.out;
  EXPECT_EQ(hash_in(one.out), hash_in(two.out));
}

TEST(CommandLine, AmplifyRejectsRegionsOutsideTheWorld) {
  const Outcome region = run_psygen("amplify --region 511,0,513,1");
  EXPECT_EQ(region.code, 1);
  EXPECT_TRUE(mentions(region.err, "0 to 511")) << region.err;
  const Outcome endless = run_psygen("amplify --world game/worlds/silver_combe.toml");
  EXPECT_EQ(endless.code, 1);
  EXPECT_TRUE(mentions(endless.err, "is endless: choose a region")) << endless.err;
  for (const char* place : {"-1,5", "1e300,0", "40000,1"}) {
    const Outcome sample = run_psygen(std::string("amplify --sample=") + place);
    EXPECT_EQ(sample.code, 1) << place;
    EXPECT_TRUE(mentions(sample.err, "outside")) << sample.err;
  }
}

TEST(CommandLine, AmplifySamplesHeightsWithEveryDigit) {
  const Outcome text = run_psygen("amplify --sample 100,200 --sample 3.5,7");
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_EQ(std::count(text.out.begin(), text.out.end(), '\n'), 2);
  const Outcome json = run_psygen("amplify --sample 100,200 --sample 3.5,7 --json");
  EXPECT_TRUE(mentions(json.out, "\"height_m\": " + text.out.substr(0, text.out.find('\n'))))
      << text.out << json.out;
}

TEST(CommandLine, AnInterruptedAmplifyPrintsItsResultsWithoutAHash) {
  // Interrupts the command as soon as one of its threads works.
  const std::string interrupted =
      "run() { \"$@\" & p=$!; until grep -qs ^amplify /proc/$p/task/*/comm; do kill -0 $p || "
      "break; "
      "done; kill -INT $p; wait $p; }; run";
  const Outcome outcome = run_psygen("amplify --threads 2 --json", interrupted);
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_TRUE(mentions(outcome.out, "\"hash\": null")) << outcome.out;
  EXPECT_TRUE(mentions(outcome.err, "interrupted after")) << outcome.err;
}

TEST(CommandLine, AmplifyWritesOneFileForEachBlock) {
  const TemporaryFolder folder;
  const std::string command =
      "amplify --region 3,4,5,5 --format obj --json --out " + (folder / "blocks").string();
  const Outcome first = run_psygen(command);
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_TRUE(mentions(first.out, "\"files_written\": 2")) << first.out;
  EXPECT_TRUE(std::filesystem::exists(folder / "blocks/block_4_4.obj"));
  EXPECT_TRUE(mentions(run_psygen(command).out, "\"files_skipped\": 2"));
  const Outcome unwritable = run_psygen("amplify --region 3,4,4,5 --out /proc/nowhere");
  EXPECT_EQ(unwritable.code, 1);
  EXPECT_TRUE(mentions(unwritable.err, "/proc/nowhere")) << unwritable.err;
}

}  // namespace
}  // namespace psygen::cli
