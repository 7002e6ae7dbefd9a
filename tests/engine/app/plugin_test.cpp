#include "tests/engine/app/fixture.hpp"

namespace psygen::app {
namespace {

TEST(Plugin, IsCalledAtTheStartAndAfterEveryFrame) {
  int starts = 0, frames = 0;
  double time_s = 0;
  FlightOptions options = short_flight();
  options.frames = 5;
  options.session.plugins.push_back({.name = "counter",
                                     .on_start = [&](Session&) { ++starts; },
                                     .on_frame =
                                         [&](Session&, double dt_s) {
                                           ++frames;
                                           time_s += dt_s;
                                         }});
  auto flight = Flight::create(options);
  ASSERT_TRUE(flight) << flight.error().message;
  ASSERT_TRUE((*flight)->run());
  EXPECT_EQ(starts, 1);
  EXPECT_EQ(frames, 5);
  EXPECT_NEAR(time_s, 5.0 / 30.0, 1e-9);
}

TEST(Plugin, IsNamedIfItCannotRegisterItsModels) {
  FlightOptions options = short_flight();
  options.session.plugins.push_back(
      {.name = "broken", .register_models = [](models::Registry&) -> core::Result<void> {
         return core::fail(core::ErrorCode::kInvalidArgument, "no models today");
       }});
  const auto flight = Flight::create(options);
  ASSERT_FALSE(flight);
  EXPECT_EQ(flight.error().message, "plugin broken: no models today");
}

}  // namespace
}  // namespace psygen::app
