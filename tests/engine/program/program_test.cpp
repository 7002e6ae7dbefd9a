// Programs that meet a fault end with a message and an exit code, never by a signal.
#include "engine/program/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>

#include "tests/temporary_folder.hpp"

namespace psygen::program {
namespace {

using ::testing::HasSubstr;

struct Outcome {
  int status = -1;  // of waitpid()
  std::string err;
};

class ProgramTest : public ::testing::Test {
 protected:
  // `limits` precedes the program in the shell, `redirection` follows its arguments.
  Outcome meet(const std::string& fault, const std::string& limits = "",
               const std::string& redirection = "") {
    const std::string err = (folder_ / "err").string();
    const std::string command = "export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1;" +
                                limits + " " PSYGEN_GUARDED " " + fault + " 2>" + err + " " +
                                redirection;
    const int status = std::system(command.c_str());
    return {status, content(err)};
  }
  static std::string content(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void expect_failure(const Outcome& outcome, const std::string& message, int code = kFailed) {
    EXPECT_TRUE(WIFEXITED(outcome.status)) << "ended by signal " << WTERMSIG(outcome.status);
    EXPECT_EQ(WEXITSTATUS(outcome.status), code) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("guarded: error: " + message));
  }

  const TemporaryFolder folder_;
};

TEST_F(ProgramTest, ErrorsAreMessagesWithTheProgramsNameAndAnExitCode) {
  expect_failure(meet("fail sentence"), "sentence\n");
  expect_failure(meet("'no device'"), "no device\n", kNoDevice);
  const Outcome interrupted = meet("interrupted");
  EXPECT_EQ(interrupted.status, 0);
  EXPECT_EQ(interrupted.err, "");
}

TEST_F(ProgramTest, MessagesDoNotReachTheTerminalAsEscapes) {
  const Outcome outcome = meet("fail \"$(printf 'a\\033]0;b\\007')\"");
  expect_failure(outcome, "a");
  EXPECT_EQ(outcome.err.find('\033'), std::string::npos);
}

TEST_F(ProgramTest, ExceptionsAreMessages) {
  expect_failure(meet("throw reason"), "reason\n");
  expect_failure(meet("'throw a number'"), "an exception that is not a std::exception\n");
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(ProgramTest, AFailedAllocationNamesItsSizeInAnyThread) {
  for (const char* fault : {"allocate", "'allocate in a thread'"})
    expect_failure(meet(fault), "memory ran out (67108864 MiB more were wanted");
}
#endif

TEST_F(ProgramTest, BrokenPipesFullDisksAndLimitsOfFilesAreErrors) {
  expect_failure(meet("print", "", ">/dev/full"), "cannot write to standard output: No space left");
  expect_failure(meet("print", "", ">&-"), "cannot write to standard output");
  const Outcome piped =
      meet("print", "{", "; echo $? >" + (folder_ / "code").string() + "; } | true");
  EXPECT_EQ(content(folder_ / "code"), "1\n") << piped.err;
  const std::string file = (folder_ / "large").string();
  expect_failure(meet("write " + file, "ulimit -f 8;"), file + ": cannot be written");
}

TEST_F(ProgramTest, ASmallStackIsWidenedOrAnError) {
  EXPECT_EQ(meet("'use 4 MiB of stack'", "ulimit -S -s 128;").status, 0);
  expect_failure(meet("print", "ulimit -s 128;"),
                 "ulimit -s allows 128 KiB of stack; at least 256 KiB are needed\n");
}

TEST_F(ProgramTest, ClosedStreamsAreNotReusedForFiles) {
  const std::string file = (folder_ / "small").string();
  EXPECT_EQ(meet("write " + file, "", ">&- <&-").status, 0);
  EXPECT_EQ(content(file).substr(0, 1), "x");
}

TEST_F(ProgramTest, ASignalSetsTheFlag) {
  EXPECT_EQ(meet("signal").status, 0);
}

}  // namespace
}  // namespace psygen::program
