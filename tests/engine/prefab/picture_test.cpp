// The mill of examples/09_gltf in a world, on both render paths. To accept a new image after
// inspecting it: PSYGEN_GOLDEN_UPDATE=1
#include <array>

#include "ecs/ecs.hpp"
#include "engine/image/compare.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/prefab/prefab.hpp"
#include "engine/render/preset.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/objects/assets.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/world/world.hpp"
#include "tests/engine/app/golden.hpp"

namespace psygen::app {
namespace {

TEST(PrefabPicture, IsTheSameOnBothPathsAndMatchesTheStoredImage) {
  std::array<image::Image, 2> images;
  for (std::size_t i = 0; i < 2; ++i) {
    prefab::Library prefabs;
    SessionOptions options = short_session();
    options.size = {480, 270};
    options.render_path = i == 0 ? render::RenderPath::kCpu : render::RenderPath::kGpu;
    options.preset = render::Preset::kHigh;
    Plugin plugin;
    plugin.name = "mill";
    plugin.add_systems = [&](scene::Systems& systems) { return prefabs.add_systems(systems); };
    options.plugins.push_back(plugin);
    const auto session = Session::create(options);
    ASSERT_TRUE(session) << session.error().message;
    scene::Scene& scene = (*session)->scene();
    core::CameraPose pose = (*session)->home();
    pose.position.local.y -= 20;
    const auto mill = prefabs.load(scene.assets(), source_file("examples/09_gltf/windmill.glb"));
    ASSERT_TRUE(mill) << mill.error().message;
    scene::Transform where{.position = pose.position};
    where.position.local += glm::dvec3(-2, 0, -30);
    where.position = core::normalised(where.position, scene.world().block_size_m());
    const core::WorldPosition& at = where.position;
    where.position.local.y =
        models::ground_height_m(scene.world().terrain, at.block, at.local.x, at.local.z);
    where.rotation = glm::angleAxis(0.4F, glm::vec3(0, 1, 0));
    const ecs::Entity entity = prefabs.spawn(scene.entities(), *mill, where);
    (*session)->scene().settle(pose);
    auto* instance = scene.entities().get<prefab::Instance>(entity);
    ASSERT_TRUE(prefabs.play(*instance, "turn", scene.step(), {.from_s = 1}));
    for (int frame = 0; frame < 30; ++frame)
      ASSERT_TRUE((*session)->tick(pose, 1.0 / 60.0));
    EXPECT_GT(scene.statistics().objects.drawn, 10u);
    images[i] = captured(**session);
    EXPECT_THAT((*session)->renderer().validation_messages(), testing::IsEmpty());
  }
  const auto difference = image::compare(images[0], images[1]);
  EXPECT_TRUE(image::matches_golden(difference)) << difference.share_over;
  expect_golden("windmill", images[0]);
}

}  // namespace
}  // namespace psygen::app
