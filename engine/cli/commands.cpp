#include "engine/cli/commands.hpp"

#include "engine/cli/amplify_command.hpp"
#include "engine/cli/calibrate_command.hpp"
#include "engine/cli/compare_command.hpp"
#include "engine/cli/convert_command.hpp"
#include "engine/cli/export_command.hpp"
#include "engine/cli/fly_command.hpp"
#include "engine/cli/merge_command.hpp"
#include "engine/cli/models_command.hpp"
#include "engine/cli/picture_command.hpp"
#include "engine/cli/schedule_command.hpp"
#include "engine/cli/test_command.hpp"

namespace psygen::cli {
namespace {

template <class... Types>
std::vector<std::unique_ptr<Command>> make(CLI::App& cli) {
  std::vector<std::unique_ptr<Command>> commands;
  (commands.push_back(std::make_unique<Types>(cli)), ...);
  return commands;
}

}  // namespace

std::vector<std::unique_ptr<Command>> make_commands(CLI::App& cli) {
  return make<FlyCommand, PictureCommand, ModelsCommand, AmplifyCommand, MergeCommand,
              ExportCommand, CalibrateCommand, ScheduleCommand, TestCommand, CompareCommand,
              ConvertCommand>(cli);
}

}  // namespace psygen::cli
