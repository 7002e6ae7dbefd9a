// psygen as a process, for tests of what it says and how it ends.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace psygen {

struct Outcome {
  int code = -1;  // -1: a signal ended it
  std::string out, err;
};

inline std::string read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

// Runs psygen in the source folder; `environment` is put before the command. Leaks are looked for
// in the tests of the libraries, which keep drivers loaded so that reports have names.
inline Outcome run_psygen(const std::string& arguments, const std::string& environment = "") {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path(testing::TempDir());
  const auto out = folder / (std::string(test->name()) + ".out");
  const auto err = folder / (std::string(test->name()) + ".err");
  const std::string command =
      "cd " PSYGEN_SOURCE_DIR
      " && export ASAN_OPTIONS=detect_leaks=0:verify_asan_link_order=0 && " +
      environment + " " PSYGEN_EXECUTABLE " " + arguments + " >" + out.string() + " 2>" +
      err.string() + " </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(out), read(err)};
}

inline bool mentions(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

}  // namespace psygen
