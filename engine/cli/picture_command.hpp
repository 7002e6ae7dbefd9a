// `psygen picture`. Main thread.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "engine/app/session.hpp"
#include "engine/cli/commands.hpp"

namespace psygen::cli {

// The command.
class PictureCommand final : public Command {
 public:
  explicit PictureCommand(CLI::App& cli);
  int run() override;

 private:
  core::Result<void> take(app::Session& session) const;

  app::SessionOptions options_;
  std::string out_;
  std::optional<glm::dvec2> at_;  // metres; none: the centre of the world
  double height_m_ = 1.7, yaw_deg_ = 0, pitch_deg_ = 0;
};

}  // namespace psygen::cli
