// A window over a world that comes with psygen, turning slowly. With the name of a PNG file: a
// picture of it, without a window.
//   example_window [picture.png]
#include <chrono>
#include <cstdio>
#include <utility>

#include "engine/app/session.hpp"
#include "engine/core/data_file.hpp"

using namespace psygen;

namespace {

int failed(const core::Error& error) {
  if (error.code == core::ErrorCode::kInterrupted) return 0;  // the window was closed
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

  core::CameraPose pose = (*session)->home();  // above the middle of the world
  if (auto ok = (*session)->prepare(pose); !ok) return failed(ok.error());
  if (argc > 1) {
    if (auto ok = (*session)->tick(pose, 1.0 / 60); !ok) return failed(ok.error());
    if (auto ok = (*session)->save_picture(argv[1]); !ok) return failed(ok.error());
    return 0;
  }
  elapsed_s();
  double dt_s = 1.0 / 60;
  while ((*session)->poll()) {  // until the window is closed
    pose.yaw += 0.1 * dt_s;     // radians
    if (auto ok = (*session)->tick(pose, dt_s); !ok) return failed(ok.error());
    dt_s = elapsed_s();
  }
  return 0;
}
