#include "ecs/ecs.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/systems.hpp"
#include "engine/telemetry/marks.hpp"
#include "engine/telemetry/own_figures.hpp"
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

TEST(Plugin, ReportsFiguresAndMarksOfHooksInTheFrameOfTheHook) {
  FlightOptions options = short_flight();
  options.frames = 6;
  options.warmup_seconds = 0;
  telemetry::OwnFigure count;
  options.session.plugins.push_back(
      {.name = "game",
       .add_systems = [&](scene::Systems& systems) -> core::Result<void> {
         count = *systems.figures.add({.name = "frames", .kind = telemetry::FigureKind::kCounter});
         return {};
       },
       .on_frame =
           [&, frame = 0](Session& session, double) mutable {
             count.report(1);
             if (++frame == 3) session.scene().marks().set("third");
             session.scene().marks().set("Not a name");
           }});
  auto flight = Flight::create(options);
  ASSERT_TRUE(flight) << flight.error().message;
  const auto report = (*flight)->run();
  ASSERT_TRUE(report);
  ASSERT_EQ(report->summary.figures.size(), 1u);
  EXPECT_EQ(*report->summary.figures[0].min, 1);
  EXPECT_EQ(*report->summary.figures[0].max, 1);
  ASSERT_EQ(report->summary.marks.size(), 1u);
  EXPECT_EQ(report->summary.marks[0].frame, 2u);
  EXPECT_EQ(report->summary.ignored_marks, 6u);
}

TEST(Plugin, CannotDeclareAFigureTwiceOrAfterTheStart) {
  FlightOptions options = short_flight();
  const auto declare = [](scene::Systems& systems) -> core::Result<void> {
    const auto added = systems.figures.add({.name = "wolves"});
    return added ? core::Result<void>{} : tl::unexpected(added.error());
  };
  options.session.plugins = {{.name = "one", .add_systems = declare},
                             {.name = "two", .add_systems = declare}};
  const auto twice = Session::create(options.session);
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().message, "plugin two: the figure 'wolves': it is declared twice");
  options.session.plugins.pop_back();
  const auto session = Session::create(options.session);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_FALSE((*session)->scene().figures().add({.name = "late"}));
}

TEST(Plugin, CannotGiveAFigureTheColumnOfASystem) {
  FlightOptions options = short_flight();
  options.session.plugins.push_back(
      {.name = "game", .add_systems = [](scene::Systems& systems) -> core::Result<void> {
         systems.frame.add("figures.hunt", [](scene::Input&) {});
         (void)systems.figures.add({.name = "hunt_ms"});
         return {};
       }});
  const auto session = Session::create(options.session);
  ASSERT_FALSE(session);
  EXPECT_THAT(session.error().message, testing::HasSubstr("have the same column of frames.csv"));
}

}  // namespace
}  // namespace psygen::app
