// The commands that draw, in a build without the renderer (PSYGEN_RENDER=OFF): each fails with a
// message. They are not in the help.
#include <fmt/format.h>

#include "engine/cli/commands.hpp"
#include "engine/core/log.hpp"

namespace psygen::cli {
namespace {

class AbsentCommand : public Command {
 public:
  AbsentCommand(CLI::App& cli, const char* name) : Command(cli, name, "") {
    command_->group("")->set_help_flag();
    command_->prefix_command();  // takes all arguments
  }

  int run() override {
    core::log_error(
        fmt::format("{}: this build has no renderer (PSYGEN_RENDER is OFF)", command_->get_name()));
    return kNoDevice;
  }
};

}  // namespace

void add_absent_commands(CLI::App& cli, std::vector<std::unique_ptr<Command>>& commands) {
  for (const char* name : {"fly", "picture", "test", "compare", "devices", "history", "doctor"})
    commands.push_back(std::make_unique<AbsentCommand>(cli, name));
}

}  // namespace psygen::cli
