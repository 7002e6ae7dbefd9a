// The frame-time tests: flies through the game as the test files define, and compares the
// measurements with their budgets (docs/frame-tests.md in the package).
//   my_game_frame_test FILE... [--junit FILE] [--markdown FILE] [--annotations github] [--out DIR]
// Exit codes: 0 within the budgets, 1 failure, 2 usage error, 3 over a budget, 5 too busy to judge,
// 77 no device.
#include "engine/frametest/run.hpp"
#include "game.hpp"

using namespace psygen;

int main(int argc, char** argv) {
  Game game;
  frametest::Hooks hooks;
  hooks.prepare = [&game](app::SessionOptions& options) -> core::Result<void> {
    const auto own = game.options();
    if (!own) return tl::unexpected(own.error());
    options.plugins = own->plugins;
    return {};
  };
  hooks.start = [&game](app::Session& session) { return game.start(session); };
  return frametest::frame_test_main(argc, argv, hooks);
}
