// Programs that crash under program::run() leave a report, and end by the same signal as without.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/temporary_folder.hpp"

namespace psygen::program {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

struct Outcome {
  int code = -1;  // of the shell: 128 + a signal
  std::string err;
};

class CrashReport : public testing::Test {
 protected:
  // `setting` precedes the program in the shell.
  Outcome crash(const std::string& fault, const std::string& setting = "") const {
    const std::string command = "ulimit -c 0; export XDG_STATE_HOME='" + state_.string() +
                                "' TMPDIR='" + temporary_.string() + "'; ( " + setting +
                                " exec '" PSYGEN_GUARDED "' " + fault + " 2>'" +
                                (folder_ / "err").string() + "' ); exit $?";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(folder_ / "err")};
  }
  static std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static std::vector<fs::path> files_in(const fs::path& folder) {
    std::error_code none;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder, none))
      files.push_back(entry.path());
    return files;
  }
  // Reads and removes the only report; an empty text if there is no or more than one.
  std::string take_report(const fs::path& folder, const Outcome& outcome) const {
    const std::vector<fs::path> files = files_in(folder);
    EXPECT_EQ(files.size(), 1U) << outcome.err;
    if (files.size() != 1) return {};
    EXPECT_THAT(outcome.err, HasSubstr("; the report is " + files[0].string() + "\n"));
    EXPECT_THAT(files[0].filename().string(),
                ContainsRegex("^guarded-crash-[0-9]{8}T[0-9]{6}Z-[0-9]+\\.txt$"));
    EXPECT_EQ(fs::status(files[0]).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    const std::string text = content(files[0]);
    fs::remove(files[0]);
    return text;
  }

  const TemporaryFolder folder_;
  fs::path state_ = folder_ / "of the user" / "state", temporary_ = folder_.path();
};

TEST_F(CrashReport, NamesProgramMachineSignalAddressStackAndLastLogLines) {
  const Outcome outcome = crash("read 'a word'");
  EXPECT_EQ(outcome.code, 128 + SIGSEGV);
  EXPECT_THAT(outcome.err, HasSubstr("guarded: error: crashed by SIGSEGV; the report is "));
  EXPECT_THAT(
      take_report(state_ / "guarded", outcome),
      AllOf(HasSubstr("\nprogram: guarded, psygen "), HasSubstr(", revision "),
            ContainsRegex("\ncommand: [^\n]*psygen_guarded_program read a word"),
            ContainsRegex("\nmachine: [^\n]+, [0-9]+ cores, quota [^\n]+ MiB of memory"),
            ContainsRegex("\ntime: [0-9]{8}T[0-9]{6}Z\nsignal: SIGSEGV\naddress: 0x8\nthread: "),
            ContainsRegex("\nstack:\n([^\n]*psygen_guarded_program\\(\\+0x[0-9a-f]+\\)[^\n]*\n)"),
            HasSubstr("\nlast log lines:\nguarded: info: line 36\n"),
            HasSubstr("\nguarded: info: line 99\n"), Not(HasSubstr("cause:"))));
}

TEST_F(CrashReport, IsLeftByEveryKindOfCrashWhoseSignalStays) {
  const std::tuple<const char*, int, const char*> cases[] = {
      {"abort", SIGABRT, "SIGABRT"},
      {"overflow", SIGSEGV, "SIGSEGV"},
      {"'overflow in a thread'", SIGSEGV, "SIGSEGV"},
      {"'throw in a thread' message", SIGABRT, "SIGABRT\ncause: message"},
      {"raise 4", SIGILL, "SIGILL"},
      {"raise 7", SIGBUS, "SIGBUS"},
      {"raise 8", SIGFPE, "SIGFPE"}};
  for (const auto& [fault, number, text] : cases) {
    const Outcome outcome = crash(fault);
    EXPECT_EQ(outcome.code, 128 + number) << fault;
    EXPECT_THAT(take_report(state_ / "guarded", outcome),
                AllOf(HasSubstr(std::string("\nsignal: ") + text),
                      ContainsRegex("\nstack:\n([^\n]*\n)*[^\n]*psygen_guarded_program\\(\\+0x")))
        << fault;
  }
}

TEST_F(CrashReport, IsOneIfTwoThreadsCrash) {
  for (int i = 0; i < 10; ++i) {
    const Outcome outcome = crash("'abort in two threads'");
    EXPECT_EQ(outcome.code, 128 + SIGABRT);
    EXPECT_THAT(take_report(state_ / "guarded", outcome), HasSubstr("last log lines:"));
  }
}

TEST_F(CrashReport, GoesToTheFolderForTemporaryFilesOrStderrIfTheUsersTakesNone) {
  state_ = "/proc/none";
  temporary_ = folder_ / "temporary";
  fs::create_directory(temporary_);
  Outcome outcome = crash("abort");
  EXPECT_EQ(outcome.code, 128 + SIGABRT);
  EXPECT_THAT(take_report(temporary_, outcome), HasSubstr("signal: SIGABRT"));
  for (const char* setting : {"export TMPDIR=/proc/none;", "ulimit -f 1;"}) {
    outcome = crash("abort", setting);  // ulimit: a file may have 512 bytes
    EXPECT_EQ(outcome.code, 128 + SIGABRT);
    EXPECT_THAT(outcome.err,
                AllOf(HasSubstr("guarded: error: crashed by SIGABRT; no folder takes the report:"),
                      HasSubstr("\nprogram: guarded, ")));
    EXPECT_TRUE(files_in(temporary_).empty());
  }
}

TEST_F(CrashReport, LeavesHandlersAloneThatTheProgramHasSet) {
  EXPECT_EQ(crash("abort", "export OWN_HANDLER=1;").code, 7);
  EXPECT_TRUE(files_in(state_ / "guarded").empty());
}

TEST_F(CrashReport, IsNotLeftByErrors) {
  EXPECT_EQ(crash("fail").code, 1);
  EXPECT_FALSE(fs::exists(state_)) << "no folder is created before a crash";
}

}  // namespace
}  // namespace psygen::program
