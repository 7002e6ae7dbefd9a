// The game in its window.
//   my_game [picture.png]      with a file name: runs two seconds without a window, saves an image
#include <chrono>

#include "engine/program/program.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/scene.hpp"
#include "game.hpp"

using namespace psygen;

namespace {

core::Result<void> play(const char* picture) {
  Game game;  // must outlive the session
  auto options = game.options();
  if (!options) return tl::unexpected(options.error());
  options->headless = picture != nullptr;
  options->stop = &program::stop_at_interrupt();
  auto made = app::Session::create(std::move(*options));
  if (!made) return tl::unexpected(made.error());
  app::Session& session = **made;
  if (auto ok = game.start(session); !ok) return ok;
  if (auto ok = session.prepare(game.eyes(1)); !ok) return ok;

  using Clock = std::chrono::steady_clock;
  Clock::time_point last = Clock::now();
  double dt_s = 1.0 / 60;
  while (session.poll() && (picture == nullptr || session.now_s() < 2)) {
    game.write_hud(session);
    const double share = session.scene().step().share;
    if (auto ok = session.tick(game.eyes(share), dt_s); !ok) return ok;
    const Clock::time_point now = Clock::now();
    if (picture == nullptr) dt_s = std::chrono::duration<double>(now - last).count();
    last = now;
  }
  return picture != nullptr ? session.save_picture(picture) : core::Result<void>{};
}

}  // namespace

int main(int argc, char** argv) {
  return program::run("my_game", [&] { return play(argc > 1 ? argv[1] : nullptr); });
}
