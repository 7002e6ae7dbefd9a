// The program of the game, as users start it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>

#include "tests/temporary_folder.hpp"

namespace cairns {
namespace {

struct Outcome {
  int code = -1;
  std::string err;
};

// `setting` precedes the program in the shell.
Outcome run_game(const std::string& arguments, const std::string& setting = "") {
  const psygen::TemporaryFolder folder;
  const std::string err = (folder / "err").string();
  // Leaks of drivers, which the game has unloaded when the leak checker looks, have no names.
  const int status = std::system(("export ASAN_OPTIONS=\"$ASAN_OPTIONS:detect_leaks=0\"; " +
                                  setting + PSYGEN_GAME " " + arguments + " 2>" + err)
                                     .c_str());
  std::ifstream file(err);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, {std::istreambuf_iterator<char>(file), {}}};
}

TEST(Program, AWrongOptionIsAMessageWithoutEscapes) {
  const Outcome outcome = run_game("\"--seeed$(printf '\\033]0;x\\007')\"");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err.find('\033'), std::string::npos);
  EXPECT_THAT(outcome.err, testing::StartsWith("psygen-game: error: psygen-game has no option"));
  EXPECT_THAT(run_game("--preset best").err, testing::HasSubstr("--preset: "));
}

TEST(Program, AFullOutputIsAnError) {
  EXPECT_EQ(run_game("--help >/dev/full").code, 1);
}

TEST(Program, OutputsAreCheckedBeforeTheGame) {
  const std::string game = "--headless --autoplay 1000000 --seed 3 --no-sound ";
  const auto expect = [&](const std::string& option, const char* message) {
    const Outcome outcome = run_game(game + option);
    EXPECT_EQ(outcome.code, 1) << option;
    EXPECT_THAT(outcome.err, testing::HasSubstr(message));
  };
  expect("--picture last.txt", "last.txt: the name of an image must end in .png");
  expect("--picture /nowhere/last.png", "/nowhere/last.png: its folder is missing");
  expect("--record /dev/full", "/dev/full: is not a regular file, and is not replaced");
}

TEST(Program, AHomeThatCannotBeWrittenIsAnErrorThatNamesARemedy) {
  const Outcome outcome = run_game("--headless --autoplay 1 --no-sound",
                                   "unset XDG_DATA_HOME; export HOME=/proc/none; ");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, testing::HasSubstr("/proc/none/.local/share/cairns: "));
  EXPECT_THAT(outcome.err, testing::HasSubstr("(--folder names another one)"));
}

TEST(Program, SignalsDuringALoadEndItWithSuccess) {
  const psygen::TemporaryFolder folder;
  const Outcome outcome =
      run_game("--headless --autoplay 1000000 --seed 3 --no-sound --folder " +
               folder.path().string() + " --width 64 --height 36 --preset low & p=$!; until [ -e " +
               (folder / "saves/3.cairns").string() + " -o -e " + (folder / "3.cairns").string() +
               " ]; do kill -0 $p || break; done; kill -TERM $p; wait $p");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

}  // namespace
}  // namespace cairns
