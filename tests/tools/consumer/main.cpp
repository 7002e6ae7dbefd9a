// Prints the ground height in the middle of a world that comes with psygen, and draws a picture of
// it. The program calls Vulkan's loader and uses GLM as it likes.
#include <vulkan/vulkan.h>

#include <cstdio>
#include <glm/vec3.hpp>

#include "engine/app/session.hpp"
#include "engine/core/data_file.hpp"
#include "engine/models/registry.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/world.hpp"

namespace {

int failed(const psygen::core::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 1;
}

// Of the loader, 0 if it cannot say.
std::uint32_t loader_version() {
  std::uint32_t version = 0;
  return vkEnumerateInstanceVersion(&version) == VK_SUCCESS ? version : 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::uint32_t version = loader_version();
  if (version == 0) return 3;
  const auto file = psygen::core::data_file("worlds/paper.toml");
  if (!file) return failed(file.error());
  const auto registry = psygen::models::make_standard_registry();
  const auto world = psygen::world::load_world(*file, registry);
  if (!world) return failed(world.error());
  std::printf("%.6f\n", psygen::models::ground_height_m(world->terrain, {256, 256}, 31.5, 31.5));

  psygen::app::SessionOptions options;
  options.world_file = *file;
  options.headless = true;
  options.size = {64, 36};
  options.scene.view_distance_m = 64;
  auto session = psygen::app::Session::create(options);
  if (!session) return failed(session.error());
  const auto pose = (*session)->home();
  if (auto ok = (*session)->prepare(pose); !ok) return failed(ok.error());
  if (auto ok = (*session)->tick(pose, 1.0 / 60); !ok) return failed(ok.error());
  if (auto ok = (*session)->save_picture(argv[1]); !ok) return failed(ok.error());

  const glm::vec3 colour(0.25F, 0.5F, 0.75F);
  return loader_version() == version && colour.r == 0.25F ? 0 : 4;
}
