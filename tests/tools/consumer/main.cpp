// Prints the ground height in the middle of a world and writes a picture.
#include <cstdio>

#include "engine/image/image_io.hpp"
#include "engine/models/registry.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/world.hpp"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto registry = psygen::models::make_standard_registry();
  const auto world = psygen::world::load_world(argv[1], registry);
  if (!world) {
    std::fprintf(stderr, "%s\n", world.error().message.c_str());
    return 1;
  }
  std::printf("%.6f\n", psygen::models::ground_height_m(world->terrain, {256, 256}, 31.5, 31.5));
  const auto written = psygen::image::write_png(argv[2], psygen::image::make_image(2, 2));
  if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
  return written ? 0 : 1;
}
