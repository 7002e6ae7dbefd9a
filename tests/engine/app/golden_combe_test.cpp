// Images during changes of models, and of models in the shade of hills: meadows, trees and rocks of
// silver combe.
#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "engine/scene/state.hpp"
#include "engine/world/camera_path.hpp"
#include "tests/engine/app/golden.hpp"
#include "tests/source_file.hpp"

namespace psygen::app {
namespace {

class GoldenCombe : public testing::Test {
 protected:
  void SetUp() override { open(render::Preset::kLow); }
  void open(render::Preset preset, double error_pixels = 4) {
    SessionOptions options = short_session();
    options.world_file = source_file("game/worlds/silver_combe.toml");
    options.preset = preset;
    options.scene.max_error_pixels = error_pixels;
    options.size = {480, 270};
    options.scene.view_distance_m = 16000;
    options.scene.budget_bytes = 512ull << 20;
    auto session = Session::create(options);
    ASSERT_TRUE(session) << session.error().message;
    session_ = std::move(*session);
  }
  void TearDown() override {
    EXPECT_THAT(session_->renderer().validation_messages(), testing::IsEmpty());
  }
  // Over a sunlit slope, with a valley in the shade behind it.
  core::CameraPose pose(double height_m = 24) {
    world::PathPoint point;
    point.at_m = {-3506, 2214};
    point.height_m = height_m;
    point.heading_deg = 262;
    point.pitch_deg = -9;
    return world::CameraPath({}, {point}).pose_at(0, state().facts.world);
  }
  scene::State& state() { return scene::state_of(session_->scene()); }
  template <class Predicate>
  std::ptrdiff_t draws(const Predicate& predicate) {
    return std::ranges::count_if(state().draws.models, predicate);
  }

  std::unique_ptr<Session> session_;
};

TEST_F(GoldenCombe, LiesInTheShadeOfItsHills) {
  const core::CameraPose at = pose();
  session_->scene().settle(at);
  ASSERT_TRUE(session_->tick(at, 1.0 / 60.0));
  EXPECT_GT(draws([](const render::MeshDraw& d) { return d.sun < 0.1F; }), 50);
  EXPECT_GT(draws([](const render::MeshDraw& d) { return d.sun > 0.9F; }), 50);
  expect_golden("combe_shade", captured(*session_));
}

// A merged mesh may be partly in the shade, also where all of it may cast a shadow.
TEST_F(GoldenCombe, MergedMeshesHaveTheLightOfTheirParts) {
  for (const bool with_cascades : {false, true}) {
    if (with_cascades) open(render::Preset::kHigh);
    const core::CameraPose at = pose(160);
    session_->scene().settle(at);
    ASSERT_TRUE(session_->tick(at, 1.0 / 60.0));
    std::map<std::uint32_t, std::set<float>> light;  // of each mesh that is drawn in parts
    for (const render::MeshDraw& d : state().draws.models) {
      if (d.part.count > 0) light[d.range.id].insert(d.sun);
    }
    EXPECT_GT(std::ranges::count_if(light, [](const auto& mesh) { return mesh.second.size() > 1; }),
              10);
  }
}

// Thirty metres farther all meshes are ready: every change of level begins in the first frame.
TEST_F(GoldenCombe, MatchesItsImageHalfwayThroughFades) {
  open(render::Preset::kLow, 3);
  const core::CameraPose from = pose();
  core::CameraPose to = from;
  to.position.local += glm::dvec3(-36, 0, 5);  // forward
  to.position = core::normalised(to.position, state().facts.world.block_size_m());
  for (const core::CameraPose& at : {to, from})
    session_->scene().settle(at);
  const double step_s = state().settings.fade_seconds / 6;
  ASSERT_TRUE(session_->tick(from, step_s));
  const auto name_of = [](const render::MeshDraw& d) {
    return std::tuple(d.range.id, d.part.first, d.part.count);
  };
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, float> light;
  for (const render::MeshDraw& d : state().draws.models)
    light[name_of(d)] = d.sun;
  for (int i = 0; i < 3; ++i)
    ASSERT_TRUE(session_->tick(to, step_s));
  const auto as_before = [&](const render::MeshDraw& d) {
    return d.fade < 0 && light.contains(name_of(d)) && light[name_of(d)] == d.sun;
  };
  const auto coming = [](const render::MeshDraw& d) { return d.fade > 0.4F && d.fade < 0.6F; };
  const auto going = [](const render::MeshDraw& d) { return d.fade < -0.4F && d.fade > -0.6F; };
  EXPECT_GT(draws(coming), 20);
  EXPECT_GT(draws(going), 20);
  EXPECT_GT(draws(as_before), draws(going) / 2) << "disappearing models keep their light";
  expect_golden("combe_fades", captured(*session_));
}

}  // namespace
}  // namespace psygen::app
