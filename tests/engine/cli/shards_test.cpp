// Tests shards as users run them: processes that are killed at any moment and merged by psygen
// merge.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "engine/image/image.hpp"
#include "engine/image/image_io.hpp"
#include "tests/engine/cli/amplify_fixture.hpp"

namespace psygen::cli {
namespace {

class Shards : public AmplifyFixture {
 protected:
  Outcome run(const std::string& arguments, const std::string& environment = "") const {
    return run_psygen(arguments, environment, folder_.path());
  }
};

TEST_F(Shards, MergedShardsHaveTheHashOfOneProcessWithOneThread) {
  const std::string whole = hash_in(amplify("--threads 1 --json"));
  for (int i = 1; i <= 3; ++i) {
    const Outcome shard = amplify(fmt::format("--shard {}/3 --out s --format none", i));
    EXPECT_EQ(shard.code, 0) << shard.err;
    EXPECT_TRUE(mentions(shard.out, fmt::format("shard {} of 3", i))) << shard.out;
  }
  EXPECT_EQ(hash_in(run("merge s --json")), whole);
  EXPECT_TRUE(mentions(run("merge s").out, whole));
  std::filesystem::rename(folder_ / "s/shard_2_of_3.ledger", folder_ / "s/kept");
  const Outcome missing = run("merge s");
  EXPECT_EQ(missing.code, 1);
  EXPECT_TRUE(mentions(missing.err, "are missing: the ledger of their shard")) << missing.err;
  EXPECT_EQ(run("merge nowhere").code, 1);
  EXPECT_EQ(run("merge").code, 2);
  EXPECT_EQ(hash_in(run("merge s s/kept --json")), whole);
}

// The shell of a batch script knows the job's tasks too, and is one process.
TEST_F(Shards, CopiesThatWouldAllMakeTheWholeRegionAreRejected) {
  for (const char* variable : {"SLURM_STEP_NUM_TASKS=4", "PMI_SIZE=4"}) {
    for (const char* work : {"--out s", ""}) {
      const Outcome outcome = amplify(work, variable);
      EXPECT_EQ(outcome.code, 1);
      EXPECT_TRUE(mentions(outcome.err, "4 copies, and each would make the whole region"))
          << outcome.err;
    }
    EXPECT_EQ(amplify("--shard 1/3 --out s --format none", variable).code, 0);
    EXPECT_EQ(run("export --world small.toml --region 0,0,1,1 --out t", variable).code, 1);
  }
  for (const char* variable : {"SLURM_STEP_NUM_TASKS=1", "SLURM_NTASKS=4"})
    EXPECT_EQ(amplify("", variable).code, 0);
}

// The process dies at a call that writes, also inside a write, twenty times, at moments chosen by a
// seed. The files that it leaves are complete, and the same command finishes the shard.
TEST_F(Shards, ShardsKilledAtAnyMomentCanBeResumed) {
  const std::string region = " --region 1,1,4,4";
  ASSERT_EQ(amplify("--out whole" + region).code, 0);
  const FileContents whole = blocks_in("whole");
  const std::string hash = hash_in(amplify("--threads 1 --json" + region));
  std::mt19937 random(23);
  int killed = 0;
  for (int round = 0; killed < 20; ++round) {
    const std::string out = fmt::format("s{}", round);
    for (int lives = 0; lives < 2; ++lives) {
      const Outcome dead = amplify(
          "--shard 1/1 --out " + out + region,
          fmt::format("LD_PRELOAD={} PSYGEN_FULL_DISK={} PSYGEN_CALLS_LEFT={} PSYGEN_DIES=1",
                      PSYGEN_FAULTS, (folder_ / out).string(), random() % 70));
      killed += dead.code == 137 ? 1 : 0;
      for (const auto& [name, content] : blocks_in(out))
        if (!name.ends_with(".partial")) {
          EXPECT_TRUE(whole.contains(name) && whole.at(name) == content) << name;
        }
    }
    EXPECT_EQ(hash_in(amplify("--json --shard 1/1 --out " + out + region)), hash);
    EXPECT_TRUE(blocks_in(out) == whole) << round;
    EXPECT_EQ(hash_in(run("merge --json " + out)), hash);
    ASSERT_LT(round, 60) << "too few rounds kill the process";
  }
}

TEST_F(Shards, ShardsOfOtherWorldsAndRegionsAreNotMixed) {
  ASSERT_EQ(amplify("--shard 1/2 --out s --format none").code, 0);
  const Outcome other = amplify("--shard 1/2 --out s --format none --region 0,0,2,2");
  EXPECT_EQ(other.code, 1);
  EXPECT_TRUE(mentions(other.err, "s/shard_1_of_2.ledger: belongs to the region")) << other.err;
  ASSERT_EQ(run("amplify --world paper --region 0,0,2,2 --shard 2/2 --out p --format none").code,
            0);
  const Outcome mixed = run("merge s p");
  EXPECT_EQ(mixed.code, 1);
  EXPECT_TRUE(mentions(mixed.err, "belongs to another job than")) << mixed.err;
}

// The text of the world is unchanged, but the contents of its mask change.
TEST_F(Shards, ShardsOfWorldsWithChangedFilesAreNotMixed) {
  std::ofstream(folder_ / "masked.toml")
      << world::testing::kSmallWorld << "mask_image = \"mask.png\"\n";
  const auto paint = [&](std::uint8_t grey) {
    const auto picture = image::make_image(8, 8, grey, grey, grey);
    ASSERT_TRUE(image::write_png(folder_ / "mask.png", picture));
  };
  const auto make = [&](const std::string& arguments) {
    return run("amplify --world masked.toml --region 0,0,2,2 " + arguments);
  };
  paint(255);
  ASSERT_EQ(make("--shard 1/2 --out s --format none").code, 0);
  ASSERT_EQ(make("--out blocks").code, 0);
  paint(100);
  const Outcome goes_on = make("--shard 1/2 --out s --format none");
  EXPECT_EQ(goes_on.code, 1);
  EXPECT_TRUE(mentions(goes_on.err, "or of the files that it names")) << goes_on.err;
  const Outcome blocks = make("--out blocks");
  EXPECT_EQ(blocks.code, 1);
  EXPECT_TRUE(mentions(blocks.err, "has blocks of this world with other files")) << blocks.err;
  ASSERT_EQ(make("--shard 2/2 --out s --format none").code, 0);
  EXPECT_EQ(run("merge s").code, 1);
  paint(255);
  EXPECT_EQ(make("--out blocks").code, 0);
}

}  // namespace
}  // namespace psygen::cli
