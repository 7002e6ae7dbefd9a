// Loads its own world, valley.toml beside the program, and saves an image.
//   example_world picture.png
#include <cstdio>

#include "engine/app/session.hpp"
#include "engine/core/data_file.hpp"

using namespace psygen;

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: example_world picture.png\n");
    return 2;
  }
  const auto failed = [](const core::Error& error) {
    if (error.code == core::ErrorCode::kInterrupted) return 0;  // the user closed the window
    // An error in the world file is reported with its line: try one.
    std::fprintf(stderr, "%s\n", error.message.c_str());
    return 1;
  };
  const auto world = core::data_file("valley.toml");
  if (!world) return failed(world.error());
  app::SessionOptions options;
  options.world_file = *world;
  options.headless = true;
  options.start_hour = 17;  // low sun
  auto session = app::Session::create(options);
  if (!session) return failed(session.error());
  const core::CameraPose pose = (*session)->home();
  if (auto ok = (*session)->prepare(pose); !ok) return failed(ok.error());
  if (auto ok = (*session)->tick(pose, 1.0 / 60); !ok) return failed(ok.error());
  if (auto ok = (*session)->save_picture(argv[1]); !ok) return failed(ok.error());
  return 0;
}
