// The frame test of Cairns: the autopilot plays, and its frames are compared with the budgets of a
// file (docs/frame-tests.md).
//   cairns_frame_test FILE... [--junit FILE] [--out DIR] [--device NAME]
// Exit codes: 0 within the budgets, 1 failure, 2 usage error, 3 over a budget, 77 no device.
#include <unistd.h>

#include <memory>

#include "engine/frametest/run.hpp"
#include "game/game.hpp"

namespace {

constexpr int kLand = 3;

}  // namespace

int main(int argc, char** argv) {
  using namespace psygen;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("cairns_frame_test_" + std::to_string(::getpid()));
  std::unique_ptr<cairns::Game> game;
  frametest::Hooks hooks;
  // Each flight is a new game. The file sets size, clock and preset.
  hooks.prepare = [&](app::SessionOptions& options) -> core::Result<void> {
    game.reset();
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    cairns::GameOptions wanted;
    wanted.seed = std::to_string(kLand);
    wanted.folder = folder;
    wanted.autoplay = wanted.headless = true;
    wanted.sound = false;
    wanted.preset = options.preset;
    game = std::make_unique<cairns::Game>(wanted);
    auto own = game->session_options();
    if (!own) return tl::unexpected(own.error());
    options.world_file = own->world_file;
    options.world_text = std::move(own->world_text);
    options.plugins = std::move(own->plugins);
    return {};
  };
  hooks.start = [&](app::Session& session) { return game->start(session); };
  hooks.camera = [&](app::Session& session, double dt_s) { return game->frame(session, dt_s); };
  const int code = frametest::frame_test_main(argc, argv, hooks);
  game.reset();
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  return code;
}
