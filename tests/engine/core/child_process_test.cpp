#include "engine/core/child_process.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "tests/file_content.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::core {
namespace {

using testing::HasSubstr;

// The exit code of a shell's command.
int run(const std::string& command, const ChildOptions& options) {
  const auto child = start_child({"sh", "-c", command}, options);
  EXPECT_TRUE(child) << child.error().message;
  int status = 0;
  EXPECT_EQ(waitpid(*child, &status, 0), *child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(ChildProcess, ReadsAndWritesTheGivenFiles) {
  const TemporaryFolder folder;
  std::ofstream(folder / "in") << "word";
  const int code =
      run("cat; echo problem >&2; exit 3",
          {.in = folder / "in", .out = folder / "out", .messages = folder / "messages"});
  EXPECT_EQ(code, 3);
  EXPECT_EQ(file_content(folder / "out"), "word");
  EXPECT_EQ(file_content(folder / "messages"), "problem\n");
}

TEST(ChildProcess, KeepsTheOrderOfBothOutputsInOneFile) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "log";
  std::ofstream(file) << "a longer text of an earlier run";
  EXPECT_EQ(run("echo a; echo b >&2; echo c", {.out = file, .messages = file}), 0);
  EXPECT_EQ(file_content(file), "a\nb\nc\n");
}

TEST(ChildProcess, GetsDescriptorsUnderTheirNumbers) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  EXPECT_EQ(run("echo hello >&9", {.passed = {{ends[1], 9}}}), 0);
  char text[16] = {};
  EXPECT_EQ(read(ends[0], text, sizeof text), 6);
  EXPECT_STREQ(text, "hello\n");
  close(ends[0]);
  close(ends[1]);
}

TEST(ChildProcess, MayHaveAGroupOfItsOwn) {
  const auto group_of = [](bool own) {
    const auto child = start_child({"sleep", "60"}, {.own_group = own});
    EXPECT_TRUE(child) << child.error().message;
    const pid_t group = getpgid(*child);
    kill(*child, SIGKILL);
    waitpid(*child, nullptr, 0);
    return std::pair(group, *child);
  };
  const auto [own, child] = group_of(true);
  EXPECT_EQ(own, child);
  EXPECT_EQ(group_of(false).first, getpgrp());
}

TEST(ChildProcess, DiesOfAClosedPipeAlsoIfThisProcessIgnoresIt) {
  const auto before = signal(SIGPIPE, SIG_IGN);
  const auto child = start_child({"sh", "-c", "kill -PIPE $$; exit 0"});
  ASSERT_TRUE(child) << child.error().message;
  int status = 0;
  EXPECT_EQ(waitpid(*child, &status, 0), *child);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGPIPE);
  signal(SIGPIPE, before);
}

TEST(ChildProcess, ThatCannotRunIsAnErrorWithItsName) {
  const auto child = start_child({"no-such-program-of-psygen", "x"});
  ASSERT_FALSE(child);
  EXPECT_EQ(child.error().code, ErrorCode::kIo);
  EXPECT_THAT(child.error().message, HasSubstr("no-such-program-of-psygen: cannot run: "));
  EXPECT_EQ(start_child({}).error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace psygen::core
