// Tests psygen without the renderer (PSYGEN_RENDER=OFF).
#include "tests/engine/cli/psygen_process.hpp"

namespace psygen::cli {
namespace {

TEST(AbsentCommands, FailWithAMessageAndAreNotInTheHelp) {
  const Outcome help = run_psygen("--help");
  EXPECT_EQ(help.code, 0) << help.err;
  for (const std::string command :
       {"fly", "picture", "test", "compare", "devices", "history", "doctor"}) {
    for (const char* arguments : {"", " --help", " --world paper --out nowhere a b"}) {
      const Outcome outcome = run_psygen(command + arguments);
      EXPECT_EQ(outcome.code, 4) << command << arguments;
      EXPECT_EQ(outcome.err, "psygen: error: " + command +
                                 ": this build has no renderer (PSYGEN_RENDER is OFF)\n");
    }
    EXPECT_FALSE(mentions(help.out, "\n  " + command + " ")) << help.out;
  }
  for (const char* command : {"amplify", "merge", "models", "export", "schedule"})
    EXPECT_TRUE(mentions(help.out, std::string("\n  ") + command + " ")) << help.out;
}

TEST(AbsentCommands, OthersWork) {
  const Outcome amplified = run_psygen("amplify --world paper --region 200,200,202,202");
  EXPECT_EQ(amplified.code, 0) << amplified.err;
  EXPECT_TRUE(mentions(amplified.out, "hash")) << amplified.out;
  EXPECT_EQ(run_psygen("models --world five_species").code, 0);
}

}  // namespace
}  // namespace psygen::cli
