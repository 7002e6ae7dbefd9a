#include "tests/engine/app/fixture.hpp"

namespace psygen::app {
namespace {

TEST(Plugin, IsCalledAtTheStartAndAfterEveryFrame) {
  int starts = 0, frames = 0;
  double time_s = 0;
  Options options = short_flight();
  options.frames = 5;
  options.plugins.push_back({"counter",
                             {},
                             [&](App&) { ++starts; },
                             [&](App&, double dt_s) {
                               ++frames;
                               time_s += dt_s;
                             }});
  auto app = App::create(options);
  ASSERT_TRUE(app) << app.error().message;
  ASSERT_TRUE((*app)->run());
  EXPECT_EQ(starts, 1);
  EXPECT_EQ(frames, 5);
  EXPECT_NEAR(time_s, 5.0 / 30.0, 1e-9);
}

TEST(Plugin, ThatCannotRegisterItsModelsIsNamed) {
  Options options = short_flight();
  options.plugins.push_back({"broken",
                             [](models::Registry&) {
                               return core::Result<void>(core::fail(
                                   core::ErrorCode::kInvalidArgument, "no models today"));
                             },
                             {},
                             {}});
  const auto app = App::create(options);
  ASSERT_FALSE(app);
  EXPECT_EQ(app.error().message, "plugin broken: no models today");
}

}  // namespace
}  // namespace psygen::app
