// docs/add-a-model.md quotes this test and fence.hpp: a user's model type.
#include <fstream>

#include "engine/models/registry.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/synthesis/cost_model.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "tests/engine/app/fence.hpp"
#include "tests/engine/app/fixture.hpp"
#include "tests/temporary_folder.hpp"

namespace my_game {
namespace {

constexpr const char* kWorld = R"(
format = 1

[world]
name = "fenced"
seed = 3
blocks = [32, 32]

[[scatter]]
model = "fence"
count = 12
posts = [8, 20]
height_m = [0.8, 1.6]
)";

app::Plugin fence_plugin() {
  app::Plugin plugin;
  plugin.name = "fences";
  plugin.register_models = [](models::Registry& registry) -> core::Result<void> {
    const auto added = registry.add(std::make_unique<FenceType>());
    if (!added) return tl::unexpected(added.error());
    return {};
  };
  return plugin;
}

app::SessionOptions fenced_flight(const TemporaryFolder& folder) {
  std::ofstream(folder / "fenced.toml") << kWorld;
  app::SessionOptions options;
  options.world_file = folder / "fenced.toml";
  options.headless = true;
  options.validation = true;
  options.size = {320, 180};
  options.scene.view_distance_m = 200;
  options.scene.calibration_seconds = 300;  // a busy machine must not change the outcome
  options.plugins.push_back(fence_plugin());
  return options;
}

TEST(AddAModel, TheTypeFliesIsCostModelledAndListed) {
  const TemporaryFolder folder;
  auto session = app::Session::create(fenced_flight(folder));
  ASSERT_TRUE(session) << session.error().message;

  // Listed with its parameters, as in `psygen models` and editors.
  const models::Registry& registry = (*session)->scene().registry();
  const int fence = registry.find("fence");
  ASSERT_GE(fence, 0);
  EXPECT_EQ(registry[static_cast<models::ModelIndex>(fence)].parameters()[kPosts].name, "posts");

  // Cost-modelled: calibrated at start-up like the engine's own types.
  std::uint32_t levels = 0;
  for (const synthesis::LevelCalibration& level : (*session)->scene().calibration().levels) {
    if (level.model == fence && level.samples > 0) ++levels;
  }
  EXPECT_EQ(levels, 2u);

  // It flies: after the cache is filled no mesh is missing, and there are fences to draw.
  const core::CameraPose pose = (*session)->home();
  (*session)->scene().settle(pose);
  ASSERT_TRUE((*session)->tick(pose, 1.0 / 60.0));
  EXPECT_EQ((*session)->scene().statistics().drawn.holes, 0u);
  EXPECT_GT((*session)->scene().statistics().models_drawn, 5u);
  EXPECT_EQ((*session)->scene().statistics().failed_in_all, 0u);
}

// Promises of docs/add-a-model.md that every type must keep.
TEST(AddAModel, TheTypeKeepsItsPromises) {
  const FenceType type;
  for (int i = 0; i < 200; ++i) {
    models::Parameters p = models::default_parameters(type);
    p.set_integer(kSeed, i);
    p.set_integer(kPosts, 2 + i % 60);
    ASSERT_TRUE(models::validate(type, p));
    const core::Bounds box = type.bounds(p);
    for (int level = 0; level < type.level_count(); ++level) {
      const auto mesh = synthesis::HeapDestination::make(type, p, level);
      const auto again = synthesis::HeapDestination::make(type, p, level);
      ASSERT_TRUE(mesh && again);
      const core::Bounds tight = type.synthesise(p, level, mesh->view());
      type.synthesise(p, level, again->view());
      EXPECT_TRUE(std::ranges::equal(mesh->view().vertices, again->view().vertices));
      EXPECT_LE(std::log2(mesh->size().triangle_count()), type.log2_cost(p) + 1e-9);
      for (const std::uint16_t index : mesh->view().indices)
        ASSERT_LT(index, mesh->size().vertex_count);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(tight.min[axis], box.min[axis] - 1e-5F);
        EXPECT_LE(tight.max[axis], box.max[axis] + 1e-5F);
      }
    }
  }
}

}  // namespace
}  // namespace my_game
