#include "engine/cli/commands.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "engine/core/log.hpp"

namespace psygen::cli {

int fail_with(const core::Error& error) {
  core::log_error(error.message);
  return exit_code_of(error);
}

int print(const std::string& text) {
  errno = 0;
  if (std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0) return kOk;
  if (errno != EPIPE)
    core::log_error(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
  return kFailed;
}

std::vector<std::unique_ptr<Command>> make_commands(CLI::App& cli) {
  std::vector<std::unique_ptr<Command>> commands;
  for (const auto make :
       {make_fly_command, make_picture_command, make_models_command, make_amplify_command,
        make_merge_command, make_export_command, make_calibrate_command, make_schedule_command,
        make_test_command, make_compare_command, make_convert_command})
    commands.push_back(make(cli));
  return commands;
}

}  // namespace psygen::cli
