// Objects of a game in a session, on both paths: code adds them to the world, and its light applies
// to them. To accept a new image after inspecting it: PSYGEN_GOLDEN_UPDATE=1
#include <array>

#include "ecs/ecs.hpp"
#include "engine/image/compare.hpp"
#include "engine/models/registry.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/render/preset.hpp"
#include "engine/scene/objects/assets.hpp"
#include "engine/scene/settings.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/world/world.hpp"
#include "tests/engine/app/golden.hpp"

namespace psygen::app {
namespace {

using scene::MeshId;

// A box of two metres with the whole texture on each side, on the ground.
core::MeshData crate() {
  core::MeshData mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0F, 1.0F}) {
      glm::vec3 n(0.0F), u(0.0F), v(0.0F);
      n[axis] = sign;
      u[(axis + 1) % 3] = 1.0F;
      v[(axis + 2) % 3] = sign;
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const glm::vec3& p : {n - u - v, n + u - v, n + u + v, n - u + v}) {
        mesh.positions.push_back(p + glm::vec3(0, 1, 0));
        mesh.normals.push_back(n);
      }
      mesh.uvs.insert(mesh.uvs.end(), {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
      for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U})
        mesh.indices.push_back(first + i);
    }
  }
  return mesh;
}

// Planks.
image::Image planks() {
  image::Image picture = image::make_image(64, 64, 0, 0, 0, 255);
  for (std::uint32_t y = 0; y < 64; ++y) {
    for (std::uint32_t x = 0; x < 64; ++x) {
      const bool gap = y % 16 == 0 || x < 3 || x > 60;
      const auto shade = static_cast<std::uint8_t>(gap ? 60 : 150 + (x * 7 + y / 16 * 31) % 23);
      const auto pixel = picture.pixel(x, y);
      pixel[0] = shade;
      pixel[1] = static_cast<std::uint8_t>(shade * 3 / 4);
      pixel[2] = static_cast<std::uint8_t>(shade / 2);
    }
  }
  return picture;
}

// Two square metres of a fence, with gaps between its posts.
core::MeshData panel() {
  core::MeshData mesh;
  mesh.positions = {{-1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

image::Image fence() {
  image::Image picture = planks();
  for (std::uint32_t y = 0; y < 64; ++y) {
    for (std::uint32_t x = 0; x < 64; ++x) {
      const bool there = x % 16 < 7 || (y + 20) % 32 < 7;
      picture.pixel(x, y)[3] = there ? 255 : 0;
    }
  }
  return picture;
}

std::unique_ptr<Session> open(render::RenderPath path, render::Preset preset) {
  SessionOptions options = short_session();
  options.size = {480, 270};
  options.render_path = path;
  options.preset = preset;
  auto session = Session::create(options);
  EXPECT_TRUE(session) << session.error().message;
  return session ? std::move(*session) : nullptr;
}

void put(Session& session, const core::CameraPose& pose, glm::dvec2 at, const scene::Object& object,
         float yaw, glm::vec3 scale = glm::vec3(1.0F)) {
  scene::Scene& scene = session.scene();
  scene::Transform transform;
  transform.position = pose.position;
  transform.position.local += glm::dvec3(at.x, 0, at.y);
  transform.position = core::normalised(transform.position, scene.world().block_size_m());
  const core::WorldPosition& p = transform.position;
  transform.position.local.y =
      models::ground_height_m(scene.world().terrain, p.block, p.local.x, p.local.z);
  transform.rotation = glm::angleAxis(yaw, glm::vec3(0, 1, 0));
  transform.scale = scale;
  scene::spawn(scene.entities(), object, transform);
}

// A row of crates, one of which glows, a rock of the game, a fence with gaps, and a tower beyond
// the view distance.
void furnish(Session& session, const core::CameraPose& pose) {
  scene::Assets& assets = session.scene().assets();
  const auto mesh = assets.add_mesh(crate(), "crate");
  const auto texture = assets.add_texture(planks());
  ASSERT_TRUE(mesh && texture);
  const auto wood = assets.add_material({.base_texture = *texture});
  const auto lamp = assets.add_material({.base_colour = {0.2F, 0.2F, 0.2F}, .emissive = {3, 2, 1}});
  const models::Registry& registry = session.scene().registry();
  const auto& rock = registry[static_cast<models::ModelIndex>(registry.find("rock"))];
  const auto boulder = assets.add_model("rock", models::default_parameters(rock));
  const auto board = assets.add_mesh(panel(), "fence");
  const auto slats = assets.add_texture(fence());
  ASSERT_TRUE(wood && lamp && boulder && board && slats);
  const auto holes = assets.add_material({.min_opacity = 0.5F, .base_texture = *slats});
  ASSERT_TRUE(holes);
  for (int i = 0; i < 5; ++i)
    put(session, pose, {-8.0 + 4.0 * i, -18.0 - i}, {.mesh = *mesh, .material = *wood},
        0.3F * static_cast<float>(i));
  put(session, pose, {3, -11}, {.mesh = *mesh, .material = *lamp}, 0.5F, glm::vec3(0.4F));
  put(session, pose, {-4, -11}, {.mesh = *boulder}, 0, glm::vec3(1.5F));
  put(session, pose, {0, -10}, {.mesh = *board, .material = *holes}, 0.2F);
  const double beyond_m = session.scene().settings().view_distance_m + 60;
  put(session, pose, {0, -beyond_m}, {.mesh = *mesh}, 0, glm::vec3(4, 40, 4));
}

class ObjectPictures : public testing::TestWithParam<render::Preset> {};

TEST_P(ObjectPictures, AreTheSameOnBothPathsAndMatchTheStoredImages) {
  std::array<image::Image, 2> images;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto session =
        open(i == 0 ? render::RenderPath::kCpu : render::RenderPath::kGpu, GetParam());
    ASSERT_TRUE(session);
    core::CameraPose pose = session->home();
    pose.position.local.y -= 20;
    pose.pitch = -0.2;
    furnish(*session, pose);
    session->scene().settle(pose);
    for (int frame = 0; frame < 3; ++frame)
      ASSERT_TRUE(session->tick(pose, 1.0 / 60.0));
    EXPECT_EQ(session->scene().statistics().objects.drawn, 8u);
    images[i] = captured(*session);
    EXPECT_THAT(session->renderer().validation_messages(), testing::IsEmpty());
  }
  const auto difference = image::compare(images[0], images[1]);
  EXPECT_TRUE(image::matches_golden(difference)) << difference.share_over;
  expect_golden(std::string("objects_") + std::string(render::to_string(GetParam())), images[0]);
}

INSTANTIATE_TEST_SUITE_P(Presets, ObjectPictures,
                         testing::Values(render::Preset::kLow, render::Preset::kHigh));

}  // namespace
}  // namespace psygen::app
