// An object from a glTF file: a windmill with textures, a glowing lamp, turning sails and a door
// that opens. With the name of a PNG file, it saves an image instead of opening a window.
//   example_gltf [picture.png]
#include <chrono>

#include "ecs/ecs.hpp"
#include "engine/app/session.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/data_file.hpp"
#include "engine/models/registry.hpp"
#include "engine/prefab/prefab.hpp"
#include "engine/program/program.hpp"
#include "engine/query/world.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/objects/assets.hpp"
#include "engine/scene/objects/components.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/systems.hpp"
#include "engine/world/world.hpp"

using namespace psygen;

namespace {

core::Result<void> build(app::Session& session, prefab::Library& prefabs,
                         const core::CameraPose& pose) {
  scene::Scene& scene = session.scene();
  const auto file = core::data_file("windmill.glb");
  if (!file) return tl::unexpected(file.error());
  const auto mill = prefabs.load(scene.assets(), *file);
  if (!mill) return tl::unexpected(mill.error());
  query::World query(scene.world(), scene.registry());
  for (int i = 0; i < 2; ++i) {
    scene::Transform where{.position = pose.position};
    where.position.local += glm::dvec3(-3 + 26 * i, 0, -22 - 34 * i);
    const auto ground = query.ground(where.position);
    if (!ground) return tl::unexpected(ground.error());
    where.position.local.y = ground->height_m;
    where.rotation = glm::angleAxis(0.5F - 0.9F * static_cast<float>(i), glm::vec3(0, 1, 0));
    const ecs::Entity entity = prefabs.spawn(scene.entities(), *mill, where);
    auto* instance = scene.entities().get<prefab::Instance>(entity);
    const prefab::Playback how{.from_s = 0.7 + i, .speed = 1.0F - 0.3F * static_cast<float>(i)};
    if (auto ok = prefabs.play(*instance, "turn", scene.step(), how); !ok) return ok;
  }
  return {};
}

core::Result<void> run(const char* picture) {
  const auto world = core::data_file("worlds/five_species.toml");
  if (!world) return tl::unexpected(world.error());
  prefab::Library prefabs;  // must outlive the session
  app::Plugin plugin;
  plugin.name = "mills";
  plugin.add_systems = [&](scene::Systems& systems) { return prefabs.add_systems(systems); };
  app::SessionOptions options;
  options.world_file = *world;
  options.headless = picture != nullptr;
  options.plugins.push_back(plugin);
  auto session = app::Session::create(options);
  if (!session) return tl::unexpected(session.error());
  core::CameraPose pose = (*session)->home();
  pose.position.local.y -= 14;
  if (auto ok = build(**session, prefabs, pose); !ok) return ok;
  if (auto ok = (*session)->prepare(pose); !ok) return ok;

  double dt_s = 1.0 / 60;
  for (int frame = 0; (*session)->poll() && (picture == nullptr || frame < 30); ++frame) {
    const auto start = std::chrono::steady_clock::now();
    if (auto ok = (*session)->tick(pose, dt_s); !ok) return tl::unexpected(ok.error());
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    if (picture == nullptr) dt_s = passed.count();
  }
  return picture ? (*session)->save_picture(picture) : core::Result<void>();
}

}  // namespace

int main(int argc, char** argv) {
  return program::run("example_gltf", [&] { return run(argc > 1 ? argv[1] : nullptr); });
}
