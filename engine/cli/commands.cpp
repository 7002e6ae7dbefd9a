#include "engine/cli/commands.hpp"

namespace psygen::cli {

std::vector<std::unique_ptr<Command>> make_commands(CLI::App& cli) {
  std::vector<std::unique_ptr<Command>> commands;
  for (const auto make : {
#ifdef PSYGEN_HAS_RENDERER
           make_fly_command, make_picture_command,
#endif
           make_models_command, make_amplify_command, make_merge_command, make_export_command,
           make_calibrate_command, make_schedule_command,
#ifdef PSYGEN_HAS_RENDERER
           make_test_command, make_compare_command, make_devices_command,
#endif
#ifdef PSYGEN_HAS_HISTORY
           make_history_command,
#endif
#ifdef PSYGEN_HAS_RENDERER
           make_doctor_command,
#endif
           make_convert_command})
    commands.push_back(make(cli));
#ifndef PSYGEN_HAS_RENDERER
  add_absent_commands(cli, commands);
#endif
  return commands;
}

}  // namespace psygen::cli
