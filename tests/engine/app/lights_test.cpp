// A lantern at night, smoke and snow in a session, on both paths. To accept new images after
// inspecting them: PSYGEN_GOLDEN_UPDATE=1
#include <array>
#include <fstream>
#include <ostream>

#include "ecs/ecs.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/render/preset.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/objects/assets.hpp"
#include "engine/scene/objects/particle_kinds.hpp"
#include "engine/world/world.hpp"
#include "tests/engine/app/golden.hpp"

namespace psygen::app {
namespace {

using render::Preset;
using render::RenderPath;

// The paper's world at an hour of its day.
std::unique_ptr<Session> open(RenderPath path, Preset preset, double hour, unsigned modelers = 1) {
  const TemporaryFolder folder;
  SessionOptions options = short_session();
  options.world_file = folder / "day.toml";
  std::ifstream paper(source_file("game/worlds/paper.toml"));
  std::ofstream(options.world_file)
      << paper.rdbuf() << "\n[sky]\ncloud_cover = 0.3\nday_length_s = 86400\n";
  options.size = {480, 270};
  options.render_path = path;
  options.preset = preset;
  options.start_hour = hour;
  options.scene.modelers = modelers;
  auto session = Session::create(options);
  EXPECT_TRUE(session) << session.error().message;
  return session ? std::move(*session) : nullptr;
}

core::CameraPose low_pose(const Session& session) {
  core::CameraPose pose = session.home();
  pose.position.local.y -= 22;
  pose.pitch = -0.12;
  return pose;
}

// A position to the right and ahead of the camera, at a height above the ground.
scene::Transform at(Session& session, const core::CameraPose& pose, double right_m, double ahead_m,
                    double up_m) {
  const scene::Scene& scene = session.scene();
  scene::Transform transform;
  transform.position = pose.position;
  transform.position.local += glm::dvec3(right_m, 0, -ahead_m);
  transform.position = core::normalised(transform.position, scene.world().block_size_m());
  const core::WorldPosition& p = transform.position;
  transform.position.local.y =
      up_m + models::ground_height_m(scene.world().terrain, p.block, p.local.x, p.local.z);
  return transform;
}

// A post of half a metre with a lantern on it.
void put_lantern(Session& session, const scene::Transform& transform) {
  scene::Scene& scene = session.scene();
  core::MeshData box;
  for (int corner = 0; corner < 8; ++corner)
    box.positions.push_back(
        {corner & 1 ? 0.5F : -0.5F, corner & 2 ? 0.5F : -0.5F, corner & 4 ? 0.5F : -0.5F});
  box.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  const auto mesh = scene.assets().add_mesh(box, "box");
  const auto glass = scene.assets().add_material({.emissive = {3, 2, 1}});
  ASSERT_TRUE(mesh && glass);
  scene::Transform part = transform;
  part.scale = glm::vec3(0.3F);
  scene::spawn(scene.entities(), {.mesh = *mesh, .material = *glass}, part);
  part.position.local += glm::dvec3(1.5, -1, 0);
  part.scale = {1, 3, 1};
  scene::spawn(scene.entities(), {.mesh = *mesh}, part);
  scene::spawn_light(scene.entities(), {.intensity = 6, .range_m = 25}, transform);
}

void furnish_night(Session& session, const core::CameraPose& pose) {
  put_lantern(session, at(session, pose, -2, 12, 2.5));
  scene::spawn_light(session.scene().entities(),
                     {.colour = {0.7F, 0.85F, 1}, .intensity = 14, .range_m = 40},
                     at(session, pose, 13, 33, 4));
  scene::spawn_emitter(session.scene().entities(), {.kind = scene::fire()},
                       at(session, pose, 4, 14, 0.1));
  scene::spawn_light(session.scene().entities(), {.colour = {1, 0.45F, 0.15F}, .intensity = 3},
                     at(session, pose, 4, 14, 0.8));
}

void furnish_day(Session& session, const core::CameraPose& pose) {
  ecs::World& entities = session.scene().entities();
  scene::spawn_emitter(entities, {.kind = scene::smoke()}, at(session, pose, -3, 22, 0));
  scene::spawn_emitter(entities, {.kind = scene::snow()}, {});
  scene::spawn_emitter(entities, {.kind = scene::leaves(), .seed = 3}, at(session, pose, 4, 12, 3));
}

image::Image picture(Session& session, const core::CameraPose& pose) {
  session.scene().settle(pose);
  session.scene().set_now(20);
  for (int frame = 0; frame < 3; ++frame)
    EXPECT_TRUE(session.tick(pose, 1.0 / 60.0));
  EXPECT_THAT(session.renderer().validation_messages(), testing::IsEmpty());
  return captured(session);
}

struct Case {
  const char* name;
  Preset preset;
  double hour;
  void (*furnish)(Session&, const core::CameraPose&);
};

// Name of a test, which would otherwise contain addresses.
void PrintTo(const Case& test_case, std::ostream* out) {
  *out << test_case.name << ' ' << render::to_string(test_case.preset);
}

class EffectPictures : public testing::TestWithParam<Case> {};

TEST_P(EffectPictures, AreTheSameOnBothPathsAndMatchTheStoredImages) {
  std::array<image::Image, 2> images;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto session = open(i == 0 ? RenderPath::kCpu : RenderPath::kGpu, GetParam().preset,
                              GetParam().hour, i == 0 ? 1 : 3);
    ASSERT_TRUE(session);
    const core::CameraPose pose = low_pose(*session);
    GetParam().furnish(*session, pose);
    images[i] = picture(*session, pose);
  }
  const auto difference = image::compare(images[0], images[1]);
  EXPECT_TRUE(image::matches_golden(difference)) << difference.share_over;
  expect_golden(
      std::string(GetParam().name) + "_" + std::string(render::to_string(GetParam().preset)),
      images[0]);
}

INSTANTIATE_TEST_SUITE_P(Cases, EffectPictures,
                         testing::Values(Case{"lantern", Preset::kLow, 23, furnish_night},
                                         Case{"lantern", Preset::kHigh, 23, furnish_night},
                                         Case{"particles", Preset::kLow, 10, furnish_day},
                                         Case{"particles", Preset::kHigh, 10, furnish_day}));

}  // namespace
}  // namespace psygen::app
