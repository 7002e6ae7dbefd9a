// Loads its own world, valley.toml beside the program, and saves an image.
//   example_world picture.png
#include <cstdio>

#include "engine/app/session.hpp"
#include "engine/core/data_file.hpp"
#include "engine/program/program.hpp"

using namespace psygen;

namespace {

core::Result<void> take_picture(const char* file) {
  const auto world = core::data_file("valley.toml");
  if (!world) return tl::unexpected(world.error());
  app::SessionOptions options;
  options.world_file = *world;
  options.headless = true;
  options.start_hour = 17;  // low sun
  auto session = app::Session::create(options);
  if (!session) return tl::unexpected(session.error());
  const core::CameraPose pose = (*session)->home();
  if (auto ok = (*session)->prepare(pose); !ok) return tl::unexpected(ok.error());
  if (auto ok = (*session)->tick(pose, 1.0 / 60); !ok) return tl::unexpected(ok.error());
  if (auto ok = (*session)->save_picture(file); !ok) return tl::unexpected(ok.error());
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: example_world picture.png\n");
    return 2;
  }
  return program::run("example_world", [&] { return take_picture(argv[1]); });
}
