// Opens a window with a shipped world and turns the camera slowly. With the name of a PNG file, it
// saves an image instead of opening a window.
//   example_window [picture.png]
#include <chrono>
#include <utility>

#include "engine/app/session.hpp"
#include "engine/core/data_file.hpp"
#include "engine/program/program.hpp"

using namespace psygen;

namespace {

// Seconds since the last call.
double elapsed_s() {
  using Clock = std::chrono::steady_clock;
  static Clock::time_point last = Clock::now();
  const Clock::time_point now = Clock::now();
  return std::chrono::duration<double>(now - std::exchange(last, now)).count();
}

core::Result<void> play(int argc, char** argv) {
  const auto world = core::data_file("worlds/silver_combe.toml");
  if (!world) return tl::unexpected(world.error());

  app::SessionOptions options;
  options.world_file = *world;
  options.headless = argc > 1;
  options.stop = &program::stop_at_interrupt();  // Ctrl+C ends the loop below
  auto session = app::Session::create(options);
  if (!session) return tl::unexpected(session.error());

  core::CameraPose pose = (*session)->home();  // above the centre of the world
  if (auto ok = (*session)->prepare(pose); !ok) return tl::unexpected(ok.error());
  if (argc > 1) {
    if (auto ok = (*session)->tick(pose, 1.0 / 60); !ok) return tl::unexpected(ok.error());
    if (auto ok = (*session)->save_picture(argv[1]); !ok) return tl::unexpected(ok.error());
    return {};
  }
  elapsed_s();
  double dt_s = 1.0 / 60;
  while ((*session)->poll()) {  // until the user closes the window
    pose.yaw += 0.1 * dt_s;     // radians
    if (auto ok = (*session)->tick(pose, dt_s); !ok) return tl::unexpected(ok.error());
    dt_s = elapsed_s();
  }
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  return program::run("example_window", [&] { return play(argc, argv); });
}
