// Work before the first frame reports its progress, even while modelers work, and stops on request.
#include "tests/engine/scene/gate.hpp"

namespace psygen::scene {
namespace {

class Prefilling : public ::testing::TestWithParam<const char*> {
 protected:
  static void prefill(Scene& scene, const Progress& progress) {
    if (std::string(GetParam()) == "settle") {
      scene.settle(pose_at(256, 256), progress);
    } else {
      const auto amplified = scene.amplify(pose_at(256, 256), progress);
      EXPECT_TRUE(amplified) << amplified.error().message;
    }
  }
  static SceneSettings settings() {
    SceneSettings settings = gated_settings();
    settings.view_distance_m = 100;
    settings.budget_bytes = 512ull << 20;
    return settings;
  }
};

TEST_P(Prefilling, ReportsProgressWhileModelersWork) {
  GatedScene gated(settings(), true);
  gated.gate.set_open(false);
  int waiting = 0;
  double last = 0;
  prefill(*gated.scene, [&](std::string_view label, double fraction) {
    EXPECT_FALSE(label.empty());
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    last = fraction;
    if (gated.gate.blocks() && ++waiting == 5) gated.gate.set_open(true);
    return true;
  });
  EXPECT_EQ(waiting, 5) << "nothing but the progress opens the gate";
  EXPECT_GT(last, 0.9);
}

TEST_P(Prefilling, StopsOnRequestWhileModelersWork) {
  GatedScene gated(settings(), true);
  gated.gate.set_open(false);
  prefill(*gated.scene, [&](std::string_view, double) { return !gated.gate.blocks(); });
  EXPECT_TRUE(gated.gate.blocks());
  EXPECT_GT(state_of(*gated.scene).supply.outstanding(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Ways, Prefilling, ::testing::Values("settle", "amplify"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace psygen::scene
