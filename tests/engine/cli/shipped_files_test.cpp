#include <gtest/gtest.h>

#include "tests/engine/cli/psygen_process.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::cli {
namespace {

const std::string kShortFlight = "fly --headless --frames 1 --size 64x36 --view-distance 64 ";

Outcome run_in(const TemporaryFolder& folder, const std::string& arguments) {
  return run_psygen(arguments, "", folder.path());
}

TEST(ShippedFiles, EveryCommandFindsItsWorldFromAnyFolder) {
  const TemporaryFolder folder;
  for (const std::string& arguments :
       {kShortFlight, std::string("amplify --region 1,1,2,2"), std::string("calibrate --samples 4"),
        std::string("export --block 1,1 --level 2 --out block.obj")}) {
    const Outcome outcome = run_in(folder, arguments);
    EXPECT_EQ(outcome.code, 0) << arguments << "\n" << outcome.err;
  }
  EXPECT_TRUE(mentions(run_in(folder, kShortFlight).out, "paper"));
}

TEST(ShippedFiles, AreFoundByTheirNames) {
  const TemporaryFolder folder;
  EXPECT_TRUE(mentions(run_in(folder, "models --world five_species").out, "birch"));
  EXPECT_TRUE(mentions(run_in(folder, "models --world five_species.toml").out, "birch"));
  const Outcome flight = run_in(folder, kShortFlight + "--world silver_combe --path combe");
  EXPECT_EQ(flight.code, 0) << flight.err;
  EXPECT_TRUE(mentions(flight.out, "silver combe")) << flight.out;
}

TEST(ShippedFiles, AUsersFileComesFirstAndAFolderIsIgnored) {
  const TemporaryFolder folder;
  std::ofstream(folder / "lakes") << "format = 1\n";
  EXPECT_TRUE(mentions(run_in(folder, "models --world paper").out,
                       "scatter[0] tree            23 instances a block, 23.0 stand"));
  const Outcome own = run_in(folder, "models --world lakes");
  EXPECT_EQ(own.code, 1);
  EXPECT_TRUE(mentions(own.err, "lakes:1: world: this field is missing")) << own.err;
  std::filesystem::create_directory(folder / "paper");
  EXPECT_EQ(run_in(folder, "models --world paper").code, 0);
}

TEST(ShippedFiles, CommandsThatLoadAWorldWarnOfRoadsThroughWater) {
  const TemporaryFolder folder;
  std::ofstream(folder / "own.toml") << R"(format = 1
[world]
name = "own"
seed = 1
blocks = [8, 8]
[[lake]]
centre_m = [200, 200]
radius_m = 40
[[road]]
points_m = [[100, 200], [300, 200]]
)";
  for (const std::string command :
       {"models --world own.toml", "export --world own.toml --block 1,1 --out own.glb"}) {
    const Outcome outcome = run_in(folder, command);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(mentions(outcome.err, "own.toml: road 1: it crosses lake 1 at ")) << outcome.err;
  }
}

TEST(ShippedFiles, AMissingFileIsReportedWithSearchedFoldersAndShippedNames) {
  const TemporaryFolder folder;
  for (const std::string command :
       {"fly --headless", "amplify", "calibrate", "models", "export --block 1,1 --out a.glb"}) {
    const Outcome world = run_in(folder, command + " --world papre");
    EXPECT_EQ(world.code, 1) << command;
    for (const std::string& words :
         {std::string("papre: no such file; looked in ") + folder.path().string(),
          std::string("/share/psygen/worlds"),
          std::string("ember_pass, endless, five_species, frost_isle, lakes, paper, silver_combe, "
                      "thorn_country, watershed"),
          std::string("did you mean paper?")})
      EXPECT_TRUE(mentions(world.err, words)) << command << "\n" << world.err;
  }
  const Outcome path = run_in(folder, kShortFlight + "--path walk");
  EXPECT_EQ(path.code, 1);
  EXPECT_TRUE(mentions(path.err, "the shipped paths are combe, dash")) << path.err;
  EXPECT_TRUE(mentions(path.err, "did you mean walk27?")) << path.err;
  const Outcome elsewhere = run_in(folder, "models --world /no/where/paper.toml");
  EXPECT_EQ(elsewhere.code, 1);
  EXPECT_FALSE(mentions(elsewhere.err, "looked in")) << elsewhere.err;
  EXPECT_TRUE(mentions(elsewhere.err, "did you mean paper?")) << elsewhere.err;
}

}  // namespace
}  // namespace psygen::cli
