// Starts another program. The caller waits for it (waitpid). Linux. Any thread.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::core {

// A descriptor of this process, and its number in the child. Of several, no `there` is the `here`
// of a later one.
struct PassedDescriptor {
  int here = -1, there = -1;
};

struct ChildOptions {
  std::filesystem::path in = {};        // standard input; empty: that of this process
  std::filesystem::path out = {};       // standard output, written anew; empty: likewise
  std::filesystem::path messages = {};  // standard error; may be `out`
  std::vector<PassedDescriptor> passed = {};
  bool own_group = false;  // signals of the terminal do not reach it
};

// Starts words[0], found in PATH, with the other words as arguments, unchanged. Fails with kIo;
// the message names the program.
Result<pid_t> start_child(std::vector<std::string> words, const ChildOptions& options = {});

}  // namespace psygen::core
