// Objects: windmills with meshes from code, a texture with holes, and sails that turn in fixed
// steps. Saves an image to a file instead of opening a window: example_objects [picture.png]
#include <chrono>
#include <cmath>

#include "engine/app/session.hpp"
#include "engine/core/data_file.hpp"
#include "engine/program/program.hpp"
#include "engine/query/world.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/objects/assets.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/systems.hpp"

using namespace psygen;

namespace {

// Component of the sails. It keeps the previous angle, because frames interpolate between steps.
struct Sails {
  double speed = 1, angle = 0, angle_before = 0;  // radians per second, radians
};

void turn(const scene::FixedStep& step, ecs::Query<Sails> mills) {
  mills.each([&](auto, std::span<Sails> all) {
    for (Sails& sails : all)
      sails.angle_before = std::exchange(sails.angle, sails.angle + sails.speed * step.step_s);
  });
}

// Runs before the engine draws objects: writes the sails' rotation of this frame.
void pose_sails(const scene::FixedStep& step, ecs::Query<const Sails, scene::Transform> mills) {
  mills.each([&](auto, std::span<const Sails> all, std::span<scene::Transform> transforms) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double angle = std::lerp(all[i].angle_before, all[i].angle, step.share);
      transforms[i].rotation = glm::angleAxis(static_cast<float>(angle), glm::vec3(0, 0, 1));
    }
  });
}

void add_quad(core::MeshData& mesh, std::initializer_list<glm::vec3> corners) {
  const auto n = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), corners);
  mesh.indices.insert(mesh.indices.end(), {n, n + 1, n + 2, n, n + 2, n + 3});
}

// An eight-sided tower with its roof, in metres. Front faces are counter-clockwise.
core::MeshData tower() {
  constexpr float kRadius[] = {4, 2.6F, 3.2F, 0.05F}, kHeight[] = {-2, 10, 10, 14};
  const glm::vec3 wall(0.42F, 0.38F, 0.31F), roof(0.06F, 0.025F, 0.018F);
  core::MeshData mesh;
  for (int ring = 0; ring < 4; ring += 2) {
    for (int side = 0; side < 8; ++side) {
      const auto corner = [&](int aside, int up) {
        const float a = static_cast<float>(side + aside) * 0.7854F;
        const float r = kRadius[ring + up], y = kHeight[ring + up];
        return glm::vec3(r * std::sin(a), y, r * std::cos(a));
      };
      add_quad(mesh, {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});
      mesh.colours.insert(mesh.colours.end(), 4, ring == 0 ? wall : roof);
    }
  }
  return mesh;
}

// Four sails around their hub. Each shows the whole texture.
core::MeshData cross() {
  core::MeshData mesh;
  for (int sail = 0; sail < 4; ++sail) {
    const glm::quat q = glm::angleAxis(static_cast<float>(sail) * 1.5708F, glm::vec3(0, 0, 1));
    const auto at = [&](float x, float y, float z) { return q * glm::vec3(x, y, z); };
    add_quad(mesh, {at(-0.3F, 0.3F, 0), at(1.5F, 0.3F, 0.3F), at(1.5F, 8, 0.3F), at(-0.3F, 8, 0)});
    mesh.uvs.insert(mesh.uvs.end(), {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  }
  return mesh;
}

// A wooden lattice. Its holes have alpha 0.
image::Image lattice() {
  image::Image picture = image::make_image(64, 256, 78, 58, 42, 0);
  for (std::uint32_t i = 0; i < 64 * 256; ++i)
    picture.rgba[4 * i + 3] = i % 64 < 10 || i % 64 % 27 < 4 || i / 64 % 32 < 6 ? 255 : 0;
  return picture;
}

core::Result<void> build(app::Session& session, const core::CameraPose& pose) {
  scene::Scene& scene = session.scene();
  const auto texture = scene.assets().add_texture(lattice());
  if (!texture) return tl::unexpected(texture.error());
  const auto wood = scene.assets().add_material({.min_opacity = 0.5F, .base_texture = *texture});
  const auto walls = scene.assets().add_mesh(tower(), "tower");
  const auto sails = scene.assets().add_mesh(cross(), "sails");
  if (!wood) return tl::unexpected(wood.error());
  if (!walls) return tl::unexpected(walls.error());
  if (!sails) return tl::unexpected(sails.error());
  query::World query(scene.world(), scene.registry());
  for (int i = 0; i < 3; ++i) {
    core::WorldPosition at = pose.position;
    at.local += glm::dvec3(-14 + 20 * i, 0, -38 - 24 * i);
    const auto ground = query.ground(at);
    if (!ground) return tl::unexpected(ground.error());
    at.local.y = ground->height_m;
    scene::spawn(scene.entities(), {.mesh = *walls}, {.position = at});
    at.local += glm::dvec3(0, 11, 3.6);  // the hub, in front of the tower
    const auto mill = scene.entities().create<Sails, scene::Transform, scene::Object>(1);
    mill.column<Sails>()[0] = {.speed = 0.9 - 0.2 * i, .angle = 0.3 * i, .angle_before = 0.3 * i};
    mill.column<scene::Transform>()[0] = {.position = at};
    mill.column<scene::Object>()[0] = {.mesh = *sails, .material = *wood};
  }
  return {};
}

core::Result<void> run(const char* picture) {
  const auto world = core::data_file("worlds/five_species.toml");
  if (!world) return tl::unexpected(world.error());
  app::Plugin plugin;
  plugin.name = "mills";
  plugin.add_systems = [](scene::Systems& systems) -> core::Result<void> {
    systems.step.add("turn", turn);
    systems.frame.add("pose_sails", pose_sails, ecs::before("objects"));
    return {};
  };
  app::SessionOptions options;
  options.world_file = *world;
  options.headless = picture != nullptr;
  options.plugins.push_back(plugin);
  auto session = app::Session::create(options);
  if (!session) return tl::unexpected(session.error());
  core::CameraPose pose = (*session)->home();
  pose.position.local.y -= 14;
  if (auto ok = build(**session, pose); !ok) return ok;
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
  return program::run("example_objects", [&] { return run(argc > 1 ? argv[1] : nullptr); });
}
