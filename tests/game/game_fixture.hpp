// Runs a game in a session frame by frame, with a temporary folder.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <functional>

#include "engine/render/renderer.hpp"
#include "engine/scene/scene.hpp"
#include "game/game.hpp"
#include "tests/source_file.hpp"

namespace cairns {

inline std::filesystem::path test_folder(const std::string& name) {
  return std::filesystem::temp_directory_path() /
         ("psygen_" + name + "_" + std::to_string(::getpid()));
}

struct Running {
  explicit Running(GameOptions options) : game(std::move(options)) {}
  core::Result<void> open(bool validation = false) {
    auto session_options = game.session_options();
    if (!session_options) return tl::unexpected(session_options.error());
    session_options->validation = validation;
    session_options->scene.view_distance_m = 2000;
    session_options->scene.watchdog_seconds = 1e6;
    auto made = app::Session::create(std::move(*session_options));
    if (!made) return tl::unexpected(made.error());
    session = std::move(*made);
    return game.start(*session);
  }
  bool frame() {
    if (!session->poll()) return false;
    const auto ticked = session->tick(game.frame(*session, kFrameS), kFrameS);
    EXPECT_TRUE(ticked) << ticked.error().message;
    return ticked.has_value();
  }
  void frames(int count) {
    for (int i = 0; i < count && frame(); ++i) {
    }
  }
  // Runs frames until `is_so()` holds. Returns false if it never does.
  bool frames_until(const std::function<bool()>& is_so, int most = 3'000) {
    for (int i = 0; i < most; ++i) {
      if (is_so()) return true;
      if (!frame()) return is_so();
    }
    return false;
  }

  static constexpr double kFrameS = 1.0 / 60;
  Game game;
  std::unique_ptr<app::Session> session;  // destroyed before the game
};

}  // namespace cairns
