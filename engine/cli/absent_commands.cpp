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

std::unique_ptr<Command> make_compare_command(CLI::App& cli) {
  return std::make_unique<AbsentCommand>(cli, "compare");
}
std::unique_ptr<Command> make_devices_command(CLI::App& cli) {
  return std::make_unique<AbsentCommand>(cli, "devices");
}
std::unique_ptr<Command> make_doctor_command(CLI::App& cli) {
  return std::make_unique<AbsentCommand>(cli, "doctor");
}
std::unique_ptr<Command> make_fly_command(CLI::App& cli) {
  return std::make_unique<AbsentCommand>(cli, "fly");
}
std::unique_ptr<Command> make_picture_command(CLI::App& cli) {
  return std::make_unique<AbsentCommand>(cli, "picture");
}
std::unique_ptr<Command> make_test_command(CLI::App& cli) {
  return std::make_unique<AbsentCommand>(cli, "test");
}

}  // namespace psygen::cli
