// Systems of a game run among the engine's, in any loop, and their errors name them.
#include <cmath>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>

#include "ecs/ecs.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/frame/input.hpp"
#include "tests/engine/app/fixture.hpp"

namespace psygen::app {
namespace {

using scene::FixedStep;
using scene::Systems;

struct Wolf {
  double x_m = 0, speed_m_s = 0;
  std::uint64_t state = 1;
};

void wander(const FixedStep& step, ecs::Query<Wolf> wolves) {
  wolves.each([&](auto, std::span<Wolf> all) {
    for (Wolf& wolf : all) {
      wolf.state = core::combine(wolf.state, step.index);
      wolf.speed_m_s = 0.9 * wolf.speed_m_s + 1e-19 * static_cast<double>(wolf.state);
      wolf.x_m += wolf.speed_m_s * step.step_s;
    }
  });
}

Plugin wolves() {
  Plugin plugin;
  plugin.name = "wolves";
  plugin.add_systems = [](Systems& systems) -> core::Result<void> {
    systems.entities.create<Wolf>(100);
    systems.step.add("wander", wander);
    return {};
  };
  return plugin;
}

std::unique_ptr<Session> session_with(std::vector<Plugin> plugins) {
  SessionOptions options = short_session();
  options.plugins = std::move(plugins);
  auto session = Session::create(std::move(options));
  EXPECT_TRUE(session) << session.error().message;
  return std::move(*session);
}

std::string error_with(Plugin plugin) {
  plugin.name = "wolves";
  SessionOptions options = short_session();
  options.plugins = {std::move(plugin)};
  const auto session = Session::create(std::move(options));
  return session ? std::string() : session.error().message;
}

std::uint64_t hash_of_wolves(Session& session) {
  std::uint64_t hash = 0;
  session.scene().entities().each<const Wolf>([&](auto, std::span<const Wolf> all) {
    for (const Wolf& wolf : all)
      hash = core::combine(hash, std::bit_cast<std::uint64_t>(wolf.x_m));
  });
  return hash;
}

TEST(Systems, TheSimulationIsTheSameForAnyFramesAndModelers) {
  std::mt19937 random(1);
  std::uint64_t first = 0;
  for (const std::uint32_t modelers : {1U, 4U}) {
    for (const bool even : {true, false}) {
      SessionOptions options = short_session();
      options.plugins = {wolves()};
      options.scene.modelers = modelers;
      auto session = Session::create(options);
      ASSERT_TRUE(session) << session.error().message;
      const FixedStep& step = (*session)->scene().step();
      std::uniform_real_distribution<double> dt_s(0.001, 0.03);
      while (step.index < 120)
        ASSERT_TRUE((*session)->tick((*session)->home(), even ? 1.0 / 30 : dt_s(random)));
      if (first == 0) first = hash_of_wolves(**session);
      EXPECT_EQ(step.index, 120U);
      EXPECT_EQ(hash_of_wolves(**session), first);
    }
  }
}

TEST(Systems, RunNextToTheSystemsThatTheyNameAndAreReported) {
  std::vector<std::string> order;
  Plugin plugin = wolves();
  plugin.add_systems = [&](Systems& systems) -> core::Result<void> {
    // Twenty more systems than the engine has.
    for (int i = 0; i < 20; ++i) {
      systems.frame.add(
          "after " + std::to_string(i), [](const scene::View&) {}, ecs::after("visibility"));
    }
    systems.frame.add(
        "follow", [](scene::Input& input) { input.pose.pitch = -0.5; }, ecs::before("input"));
    systems.step.add("wander", wander);
    return {};
  };
  const TemporaryFolder folder;
  FlightOptions options = short_flight();
  options.frames = 10;
  options.out_folder = folder / "out";
  options.session.plugins = {plugin};
  auto flight = Flight::create(options);
  ASSERT_TRUE(flight) << flight.error().message;
  const auto report = (*flight)->run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ((*flight)->session().scene().camera().pose.pitch, -0.5);
  std::vector<std::string> names;
  for (const telemetry::SystemTimes& system : report->summary.system_ms)
    names.push_back(system.name);
  EXPECT_THAT(names, testing::IsSupersetOf({"follow", "after 0", "after 19", "step wander"}));
  EXPECT_EQ(std::ranges::find(names, "follow") + 1, std::ranges::find(names, "input"));
  for (const char* file : {"frames.csv", "trace.json", "report.html", "summary.json"}) {
    std::ifstream stream(options.out_folder / file);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_NE(text.find("wander"), std::string::npos) << file;
  }
}

TEST(Systems, HooksRunInAnyLoop) {
  std::vector<std::string> calls;
  const auto session =
      session_with({{.name = "hooks",
                     .on_start = [&](Session&) { calls.push_back("start"); },
                     .on_step =
                         [&](Session&, double step_s) {
                           EXPECT_EQ(step_s, 1.0 / 60);
                           calls.push_back("step");
                         },
                     .on_frame = [&](Session&, double) { calls.push_back("frame"); }}});
  for (int i = 0; i < 3; ++i)
    ASSERT_TRUE(session->tick(session->home(), 1.0 / 40));
  EXPECT_EQ(calls,
            (std::vector<std::string>{"start", "frame", "step", "frame", "step", "step", "frame"}));
}

TEST(Systems, WrongNamesAndCyclesAreErrorsThatNameThem) {
  const auto with_place = [](ecs::Place place) {
    return error_with({.add_systems = [place](Systems& systems) -> core::Result<void> {
      systems.frame.add(
          "howl", [](const scene::Clock&) {}, place);
      return {};
    }});
  };
  EXPECT_THAT(with_place(ecs::before("rendering")),
              testing::StartsWith("the system 'howl' should run before "
                                  "'rendering', but there is no such system; there are "
                                  "'simulation', 'input'"));
  EXPECT_THAT(with_place({.before = {"input"}, .after = {"render"}}),
              testing::StartsWith("systems wait for each other: 'input' after "
                                  "'howl' after 'render'"));
  EXPECT_EQ(error_with({.add_systems = [](Systems& systems) -> core::Result<void> {
              systems.frame.add("render", [](const scene::Clock&) {});
              return {};
            }}),
            "two systems are called 'render'");
}

TEST(Systems, APluginMayNameSystemsOfLaterPlugins) {
  const auto session =
      session_with({{.name = "sheep",
                     .add_systems = [](Systems& systems) -> core::Result<void> {
                       systems.frame.add(
                           "flee", [](const scene::Clock&) {}, ecs::after("howl"));
                       return {};
                     }},
                    {.name = "wolves", .add_systems = [](Systems& systems) -> core::Result<void> {
                       systems.frame.add(
                           "howl", [](const scene::Clock&) {}, ecs::before("input"));
                       return {};
                     }}});
  const std::vector<std::string> names = session->scene().system_names();
  EXPECT_EQ(std::ranges::find(names, "howl") + 1, std::ranges::find(names, "flee"));
}

struct Thrown {
  void (*thrower)();
  core::ErrorCode code;
  std::string text;  // of the message, after the hook
};
const Thrown kThrown[] = {
    {[] { throw std::runtime_error("no moon"); }, core::ErrorCode::kInternal, " threw: no moon"},
    {[] { throw std::bad_alloc(); }, core::ErrorCode::kOutOfMemory, ": memory ran out ("},
    {[] { throw 7; }, core::ErrorCode::kInternal, " threw: an exception of "}};

TEST(Systems, AnExceptionOfAnyTypeEndsTheSessionWithAnErrorThatNamesPluginAndHook) {
  for (const auto& [thrower, code, text] : kThrown) {
    const auto hook = [thrower = thrower](auto&&...) { thrower(); };
    const std::pair<Plugin, std::string> cases[] = {
        {{.on_start = hook}, "plugin wolves: on_start"},
        {{.on_step = hook}, "the system 'wolves on_step'"},
        {{.on_frame = hook}, "plugin wolves: on_frame"},
        {{.on_gui = hook}, "plugin wolves: on_gui"},
        {{.add_systems = [hook](Systems& systems) -> core::Result<void> {
           systems.frame.add("howl", [hook](const scene::Clock&) { hook(); });
           return {};
         }},
         "plugin wolves: the system 'howl'"},
        {{.add_systems = [hook](Systems& systems) -> core::Result<void> {
           systems.step.add("howl", [hook](const FixedStep&) { hook(); });
           return {};
         }},
         "plugin wolves: the system 'howl'"}};
    for (const auto& [plugin, hook_name] : cases) {
      const std::string expected = hook_name + text;
      std::vector<Plugin> plugins(2, plugin);
      plugins[0] = {.name = "sheep", .on_step = [](Session&, double) {}};
      plugins[1].name = "wolves";
      const auto session = session_with(std::move(plugins));
      auto ticked = session->tick(session->home(), 1.0 / 60);
      if (ticked) ticked = session->tick(session->home(), 1.0 / 60);
      ASSERT_FALSE(ticked) << expected;
      EXPECT_EQ(ticked.error().code, code);
      EXPECT_THAT(ticked.error().message, testing::StartsWith(expected));
      EXPECT_TRUE(session->over()) << expected;
      session->keep_open();
      EXPECT_FALSE(session->poll()) << expected;
      const auto again = session->tick(session->home(), 1.0 / 60);
      ASSERT_FALSE(again) << expected;
      EXPECT_EQ(again.error().message, ticked.error().message);
    }
    EXPECT_THAT(error_with({.register_models = [hook](models::Registry&) -> core::Result<void> {
                  hook();
                  return {};
                }}),
                testing::StartsWith("plugin wolves: register_models" + text));
    EXPECT_THAT(error_with({.add_systems = [hook](Systems&) -> core::Result<void> {
                  hook();
                  return {};
                }}),
                testing::StartsWith("plugin wolves: add_systems" + text));
    FlightOptions options = short_flight();
    options.frames = 1;
    options.session.plugins = {{.name = "wolves", .on_end = hook}};
    auto flight = Flight::create(options);
    ASSERT_TRUE(flight) << flight.error().message;
    const auto flown = (*flight)->run();
    ASSERT_FALSE(flown);
    EXPECT_THAT(flown.error().message, testing::StartsWith("plugin wolves: on_end" + text));
  }
}

TEST(Systems, AMissingResourceIsAnErrorOfCreate) {
  struct Moon {};
  EXPECT_EQ(error_with({.add_systems = [](Systems& systems) -> core::Result<void> {
              systems.step.add("howl", [](const Moon&) {});
              return {};
            }}),
            "the system 'howl' wants a Moon, which was not provided before it");
  EXPECT_EQ(error_with({.add_systems = [](Systems& systems) -> core::Result<void> {
              systems.resource<Moon>();
              systems.resource<Moon>();
              return {};
            }}),
            "a second Moon is provided");
}

TEST(Systems, EventsReachASystemOfAStep) {
  struct Created {
    std::uint64_t models = 0;
  };
  std::uint64_t models = 0;
  const auto session = session_with(
      {{.name = "watch", .add_systems = [&](Systems& systems) {
          Created& created = systems.resource<Created>();
          systems.step.add("watch",
                           [&models](Created& sum, ecs::EventReader<scene::ModelCreated>& e) {
                             models = sum.models += e.drain([](auto) {});
                           });
          (void)created;
          return core::Result<void>();
        }}});
  ASSERT_TRUE(session->prepare(session->home()));
  ASSERT_TRUE(session->tick(session->home(), 1.0 / 60));
  ASSERT_TRUE(session->tick(session->home(), 1.0 / 60));
  EXPECT_GT(models, 63U);
}

}  // namespace
}  // namespace psygen::app
