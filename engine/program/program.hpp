// The frame of main() for every program of the engine: psygen, the editor, and games. It turns what
// ends a process without a word into messages and exit codes: closed standard streams, broken
// pipes, `ulimit -f`, `ulimit -s`, signals, a lack of memory or threads, exceptions. A crash leaves
// a report (crash_report.hpp). Replaces operator new, to name the size of a failed allocation. Not
// the command line (CLI11, Qt). Linux. Main thread.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::program {

// Exit codes. 3 and 5 are left to commands that judge (`psygen test`, `psygen compare`).
enum ExitCode : int { kOk = 0, kFailed = 1, kUsage = 2, kNoDevice = 4 };

// Sets the process up, calls `body`, and returns its exit code, or kFailed after a message if an
// exception leaves it. Messages of the process begin with `name`. Call it first in main(), once:
// int main(int argc, char** argv) { return program::run("my_game", [&] { return play(argv); }); }
int run(std::string_view name, const std::function<int()>& body);
// Returns exit_code(body()).
int run(std::string_view name, const std::function<core::Result<void>()>& body);

// kNoDevice for an error of that code, else kFailed.
int exit_code_of(const core::Error& error);
// Logs an error and returns its exit code.
int fail_with(const core::Error& error);
// kOk for success and kInterrupted, which a user causes; fail_with() other errors.
int exit_code(const core::Result<void>& result);

// Installs handlers for SIGINT, SIGTERM and, unless it is ignored, SIGHUP; the flag becomes true
// after the first signal. A second SIGINT or SIGTERM ends the program at once. For
// app::SessionOptions::stop.
const std::atomic<bool>& stop_at_interrupt();

// Writes data to stdout. Returns kFailed if it cannot be written, with a message unless the reader
// has closed the pipe.
int print(const std::string& text);

}  // namespace psygen::program
