// Opens a window with a shipped world and turns the camera slowly. With the name of a PNG file, it
// saves an image instead of opening a window.
//   example_window [picture.png]
#include <chrono>
#include <cstdio>
#include <utility>

#include "engine/app/session.hpp"
#include "engine/core/data_file.hpp"

using namespace psygen;

namespace {

int failed(const core::Error& error) {
  if (error.code == core::ErrorCode::kInterrupted) return 0;  // the user closed the window
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 1;
}

// Seconds since the last call.
double elapsed_s() {
  using Clock = std::chrono::steady_clock;
  static Clock::time_point last = Clock::now();
  const Clock::time_point now = Clock::now();
  return std::chrono::duration<double>(now - std::exchange(last, now)).count();
}

}  // namespace

int main(int argc, char** argv) {
  const auto world = core::data_file("worlds/silver_combe.toml");
  if (!world) return failed(world.error());

  app::SessionOptions options;
  options.world_file = *world;
  options.headless = argc > 1;
  auto session = app::Session::create(options);
  if (!session) return failed(session.error());

  core::CameraPose pose = (*session)->home();  // above the centre of the world
  if (auto ok = (*session)->prepare(pose); !ok) return failed(ok.error());
  if (argc > 1) {
    if (auto ok = (*session)->tick(pose, 1.0 / 60); !ok) return failed(ok.error());
    if (auto ok = (*session)->save_picture(argv[1]); !ok) return failed(ok.error());
    return 0;
  }
  elapsed_s();
  double dt_s = 1.0 / 60;
  while ((*session)->poll()) {  // until the user closes the window
    pose.yaw += 0.1 * dt_s;     // radians
    if (auto ok = (*session)->tick(pose, dt_s); !ok) return failed(ok.error());
    dt_s = elapsed_s();
  }
  return 0;
}
