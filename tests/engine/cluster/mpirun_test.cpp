// Tests real ranks: psygen under mpirun, started as users start it. Processes die at calls that
// write, at moments chosen by a seed (tests/faults.hpp).
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <utility>
#include <vector>

#include "tests/engine/cli/amplify_fixture.hpp"

namespace psygen::cli {
namespace {

// Allows containers, root and fewer processors than ranks (Open MPI 4 and 5); messages go through
// shared memory.
constexpr const char* kMpi =
    "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
    "PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe "
    "OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_btl=self,vader "
    "OMPI_MCA_odls_base_sigkill_timeout=0 mpirun";

constexpr const char* kFly =
    "fly --headless --size 64x36 --world rocks.toml --view-distance 500 --frames 1 --images 1 "
    "--modelers 1 --lod off --json ";

// Each rock takes about a millisecond.
constexpr const char* kRocks = R"(format = 1

[world]
name = "rocks"
seed = 4
blocks = [16, 16]

[[scatter]]
model = "rock"
count = 10
subdivisions = 6
)";

class Mpirun : public AmplifyFixture {
 protected:
  // Open MPI fails if two jobs that start at once share a session folder, so each test has one. It
  // lies outside folder_, where tests count files.
  Mpirun()
      : sessions_(std::filesystem::temp_directory_path() / fmt::format("psygen_mpi_{}", getpid())) {
    std::filesystem::create_directory(sessions_);
  }
  ~Mpirun() override {
    std::error_code ignored;
    std::filesystem::remove_all(sessions_, ignored);
  }
  // So many ranks with this command. `setting` precedes it in the shell.
  struct Ranks {
    int count = 1;
    std::string command;
    std::string setting = {};
  };
  // Runs all ranks in one job. PSYGEN stands for the command `psygen amplify`, and FLY for a short
  // `psygen fly`. Each rank finds its command in a script, because mpirun of Open MPI 5.0.7 crashes
  // if it is given several commands.
  Outcome run(const std::vector<Ranks>& ranks) const {
    const auto out = folder_ / "stdout", err = folder_ / "stderr", script = sessions_ / "rank";
    std::ofstream file(script);
    int count = 0;
    for (const Ranks& group : ranks) {
      count += group.count;
      file << fmt::format("if [ $OMPI_COMM_WORLD_RANK -lt {} ]; then {} exec {}; fi\n", count,
                          group.setting, expanded(group.command));
    }
    file.close();
    const std::string command = fmt::format("cd {} && TMPDIR={} {} -n {} sh {} >{} 2>{} </dev/null",
                                            folder_.path().string(), sessions_.string(), kMpi,
                                            count, script.string(), out.string(), err.string());
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(out), read(err)};
  }

 private:
  static std::string expanded(std::string command) {
    for (std::size_t at; (at = command.find("PSYGEN ")) != std::string::npos;)
      command.replace(at, 7, PSYGEN_EXECUTABLE " amplify ");
    for (std::size_t at; (at = command.find("FLY ")) != std::string::npos;)
      command.replace(at, 4, std::string(PSYGEN_EXECUTABLE " ") + kFly);
    return command;
  }

  const std::filesystem::path sessions_;
};

TEST_F(Mpirun, OneTwoAndFourRanksHaveTheHashAndTheFilesOfOneThread) {
  const std::string hash = hash_in(amplify("--threads 1 --json --out alone"));
  for (const int ranks : {1, 2, 4}) {
    const Outcome job =
        run({{ranks, fmt::format("PSYGEN --world small.toml --json --out r{}", ranks)}});
    EXPECT_EQ(hash_in(job), hash);
    EXPECT_TRUE(blocks_in(fmt::format("r{}", ranks)) == blocks_in("alone"));
    EXPECT_EQ(nlohmann::json::parse(job.out)["ranks"], ranks);
  }
  EXPECT_EQ(hash_in(run({{2, "PSYGEN --world small.toml --json"}})), hash);
}

TEST_F(Mpirun, AJobWhoseRanksAreKilledAtAnyMomentCanBeResumed) {
  const std::string region = " --region 1,1,4,4";
  const std::string hash = hash_in(amplify("--threads 1 --json --out alone" + region));
  const FileContents whole = blocks_in("alone");
  std::mt19937 random(31);
  const std::string mortal = fmt::format(
      "export LD_PRELOAD={} PSYGEN_FULL_DISK={} PSYGEN_DIES=1 PSYGEN_CALLS_LEFT=", PSYGEN_FAULTS,
      folder_.path().string());
  int killed = 0;
  for (int round = 0; killed < 20; ++round) {
    // In the first round every rank dies early, even one that claims little work.
    ASSERT_LT(round, 21) << "too few rounds kill a rank";
    const std::string out = fmt::format("job{}", round);
    for (int lives = 0; lives < 6 && killed < 20; ++lives) {
      // Kills one rank of three, or all ranks.
      const bool all = random() % 4 == 0;
      const unsigned calls = static_cast<unsigned>(random() % (lives == 0 ? 6 : 40));
      const std::string command = "PSYGEN --world small.toml" + region + " --out " + out;
      Ranks victim{1, command, fmt::format("{}{};", mortal, calls)};
      const Ranks others{1 + static_cast<int>(random() % 2), command};
      std::vector<Ranks> ranks{victim, others};
      if (all) {
        victim.count = 2;
        ranks = {victim};
      } else if (random() % 2 == 0) {
        std::swap(ranks[0], ranks[1]);
      }
      const Outcome dead = run(ranks);
      if (dead.code == 0) break;  // it survived
      ++killed;
      EXPECT_EQ(dead.code, 128 + SIGKILL) << dead.err;
      for (const auto& [name, content] : blocks_in(out))
        if (!name.ends_with(".partial") && name != ".psygen_shared") {
          EXPECT_TRUE(whole.contains(name) && whole.at(name) == content) << name;
        }
    }
    EXPECT_EQ(hash_in(run({{2, "PSYGEN --world small.toml --json --out " + out + region}})), hash);
    EXPECT_TRUE(blocks_in(out) == whole) << round;
  }
}

TEST_F(Mpirun, RanksThatDisagreeSayWhy) {
  const Outcome worlds =
      run({{1, "PSYGEN --world small.toml"}, {1, "PSYGEN --world paper --region 0,0,8,4"}});
  EXPECT_NE(worlds.code, 0);
  EXPECT_TRUE(mentions(worlds.err, "it has the world paper instead of small")) << worlds.err;
  std::filesystem::create_directory(folder_ / "a");
  std::filesystem::create_directory(folder_ / "b");
  const std::string where = "PSYGEN --world " + (folder_ / "small.toml").string() + " --out job";
  const Outcome folders = run({{1, where, "cd a;"}, {1, where, "cd b;"}});
  EXPECT_NE(folders.code, 0);
  EXPECT_TRUE(mentions(folders.err, "--out must be a folder that all ranks share")) << folders.err;
  const Outcome sets = run({{1, "PSYGEN --world small.toml --simd scalar --json"},
                            {1, "PSYGEN --world small.toml --json"}});
  EXPECT_EQ(hash_in(sets), hash_in(amplify("--json"))) << "instruction sets agree on every bit";
}

// The fixed share of rank 1 needs more calls than this limit.
TEST_F(Mpirun, AFullDiskEndsTheJobWithTheFileAndTheReason) {
  const std::string command = "PSYGEN --world small.toml --out job";
  const std::string limit =
      fmt::format("export LD_PRELOAD={} PSYGEN_FULL_DISK={} PSYGEN_CALLS_LEFT=20;", PSYGEN_FAULTS,
                  folder_.path().string());
  const Outcome full = run({{1, command}, {1, command, limit}});
  EXPECT_NE(full.code, 0);
  EXPECT_TRUE(mentions(full.err, "psygen: error: rank 1")) << full.err;
  EXPECT_TRUE(mentions(full.err, "No space left on device")) << full.err;
}

TEST_F(Mpirun, AFlightHasTheSameImagesWhicheverRankMakesItsMeshes) {
  std::ofstream(folder_ / "rocks.toml") << kRocks;
  // The file, because mpirun of Open MPI 5.0.7 repeats parts of a long text on stdout.
  const auto images_in = [this](const Outcome& flight, const char* folder) -> std::string {
    if (flight.code != 0) return flight.err;
    return nlohmann::json::parse(read(folder_ / folder / "summary.json"))["hash"]["images"];
  };
  const Outcome alone = run_psygen(kFly + std::string("--out alone"), "", folder_.path());
  const Outcome one = run({{1, "FLY --cluster --send-above 0 --out one"}});
  EXPECT_EQ(images_in(one, "one"), images_in(alone, "alone"));
  EXPECT_TRUE(mentions(one.err, "remote meshes      0 meshes")) << one.err;
  // Only rank 0 needs a GPU.
  const std::string command = "FLY --cluster --send-above 0 --out three";
  const Outcome three =
      run({{1, command}, {2, command, "export VK_ICD_FILENAMES=/nonexistent.json;"}});
  EXPECT_EQ(images_in(three, "three"), images_in(alone, "alone"));
  EXPECT_TRUE(mentions(three.err, "other ranks        2\n")) << three.err;
  EXPECT_TRUE(mentions(three.err, "remote meshes")) << three.err;
  EXPECT_FALSE(mentions(three.err, "remote meshes      0 meshes")) << three.err;
}

TEST_F(Mpirun, AFlightThatCannotBeDistributedSaysWhyOnce) {
  std::ofstream(folder_ / "rocks.toml") << kRocks;
  const Outcome each = run({{3, "FLY "}});
  EXPECT_NE(each.code, 0);
  const std::string sentence = "each of the 3 processes would start its own flight";
  EXPECT_TRUE(mentions(each.err, sentence)) << each.err;
  EXPECT_EQ(each.err.find(sentence), each.err.rfind(sentence));
  std::ofstream(folder_ / "other.toml") << kRocks << "radius_m = [1, 2]\n";
  const Outcome differ =
      run({{1, "FLY --cluster"},
           {1, PSYGEN_EXECUTABLE " fly --cluster --headless --world other.toml"}});
  EXPECT_NE(differ.code, 0);
  EXPECT_TRUE(mentions(differ.err, "it has a different version of the world rocks")) << differ.err;
}

// The other ranks do not wait for the one that failed.
TEST_F(Mpirun, ARankWithoutTheWorldFailsInTheHandshakeAndOnlyTheFirstNeedsAPath) {
  std::ofstream(folder_ / "rocks.toml") << kRocks;
  const std::string other = PSYGEN_EXECUTABLE " fly --cluster --headless ";
  const Outcome lacks = run({{1, "FLY --cluster"}, {1, other + "--world nowhere.toml"}});
  EXPECT_EQ(lacks.code, 1);
  EXPECT_TRUE(mentions(lacks.err, "psygen: error: rank 1: ")) << lacks.err;
  EXPECT_TRUE(mentions(lacks.err, "nowhere.toml")) << lacks.err;
  const Outcome path = run(
      {{1, "FLY --cluster"}, {1, other + "--modelers 1 --world rocks.toml --path nowhere.toml"}});
  EXPECT_EQ(path.code, 0) << path.err;
}

// The first MPI library that the loader finds is not a library.
TEST_F(Mpirun, WithoutMpiAMessageSaysSoAndThePlainCommandWorks) {
  std::ofstream(folder_ / "libmpi.so.40") << "no library";
  const std::string hidden = "LD_LIBRARY_PATH=" + folder_.path().string();
  const Outcome rank =
      run_psygen("amplify --world small.toml", hidden + " OMPI_COMM_WORLD_SIZE=2", folder_.path());
  EXPECT_EQ(rank.code, 1);
  EXPECT_TRUE(mentions(rank.err, "runs under mpirun, but MPI cannot be loaded")) << rank.err;
  EXPECT_TRUE(mentions(rank.err, "libmpi.so.40")) << rank.err;
  EXPECT_EQ(run_psygen("amplify --world small.toml", hidden, folder_.path()).code, 0);
}

}  // namespace
}  // namespace psygen::cli
