// `psygen convert`: converts the frames of a recorded run for other viewers. Main thread.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace psygen::cli {

class ConvertCommand {
 public:
  explicit ConvertCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run();

 private:
  CLI::App* command_;
  std::string run_, viewer_, out_;
};

}  // namespace psygen::cli
