// Runs psygen as users do: as a process. Returns its exit code and both streams.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/source_file.hpp"

namespace psygen::cli {

struct Outcome {
  int code = -1;
  std::string out, err;
};

inline std::string read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

// `environment` precedes the command; `folder` is its working directory; `redirection` follows it.
// Leak detection is off here. psygen unloads the Vulkan drivers before the leak checker looks, so
// that tools/lsan.supp cannot tell their leaks from psygen's. The tests of the libraries check for
// leaks, and keep the drivers loaded.
inline Outcome run_psygen(const std::string& arguments, const std::string& environment = "",
                          const std::filesystem::path& folder = source_file(""),
                          const std::string& redirection = "") {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const auto outputs = std::filesystem::path(testing::TempDir());
  const std::string name = std::string(test->test_suite_name()) + "_" + test->name() + "_" +
                           // Another build's test may run at the same time.
                           std::to_string(getpid());
  const auto out = outputs / (name + ".out"), err = outputs / (name + ".err");
  const std::string command =
      "cd " + folder.string() +
      " && export ASAN_OPTIONS=detect_leaks=0:verify_asan_link_order=0 && " + environment +
      " " PSYGEN_EXECUTABLE " " + arguments + " >" + out.string() + " 2>" + err.string() +
      " </dev/null " + redirection;
  const int status = std::system(command.c_str());
  Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(out), read(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return outcome;
}

inline bool mentions(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

}  // namespace psygen::cli
