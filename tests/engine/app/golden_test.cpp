// Settled scenes in every preset and every view.
#include "tests/engine/app/golden.hpp"

#include <ostream>

#include "engine/render/preset.hpp"
#include "engine/world/files/path_file.hpp"
#include "engine/world/world.hpp"

namespace psygen::app {
namespace {

struct Look {
  const char* name;
  double seconds;  // position on the walk
  render::Preset preset = render::Preset::kLow;
  render::View view = render::View::kNormal;
};

// Printed in names of tests instead of the bytes.
void PrintTo(const Look& look, std::ostream* out) {
  *out << look.name;
}

class Golden : public testing::TestWithParam<Look> {};

TEST_P(Golden, ASettledSceneMatchesItsStoredImage) {
  const Look& look = GetParam();
  SessionOptions options = short_session();
  options.size = {480, 270};
  options.scene.view_distance_m = 16000;
  options.scene.budget_bytes = 512ull << 20;
  options.preset = look.preset;
  options.view = look.view;
  auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  const auto path = world::load_camera_path(kWalk);
  ASSERT_TRUE(path);
  const core::CameraPose pose = path->pose_at(look.seconds, (*session)->scene().world());
  (*session)->scene().settle(pose);
  ASSERT_TRUE((*session)->tick(pose, 1.0 / 60.0));
  expect_golden(look.name, captured(**session));
  EXPECT_THAT((*session)->renderer().validation_messages(), testing::IsEmpty());
}

using render::Preset;
using render::View;
INSTANTIATE_TEST_SUITE_P(Looks, Golden,
                         testing::Values(Look{"low_start", 0}, Look{"low_middle", 13},
                                         Look{"low_ridge", 20}, Look{"medium", 1, Preset::kMedium},
                                         Look{"high", 1, Preset::kHigh},
                                         Look{"ultra", 1, Preset::kUltra},
                                         Look{"levels", 20, Preset::kLow, View::kLevels},
                                         Look{"layers", 20, Preset::kLow, View::kLayers},
                                         Look{"bounds", 20, Preset::kLow, View::kBounds},
                                         Look{"wireframe", 20, Preset::kLow, View::kWireframe},
                                         Look{"missing", 20, Preset::kLow, View::kMissing},
                                         Look{"cache", 20, Preset::kLow, View::kCache}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace psygen::app
