// Components and systems: a camera that glides on springs in fixed steps, and a counter of the
// trees that are created around it. Flies for some seconds and prints the counter.
//   example_systems [seconds]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "ecs/ecs.hpp"
#include "engine/app/session.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/data_file.hpp"
#include "engine/program/program.hpp"
#include "engine/scene/events.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/systems.hpp"

using namespace psygen;

namespace {

// A component. It keeps the state of the previous step, because frames interpolate between both.
struct Glider {
  double x_m = 0, x_before_m = 0;  // metres east of the start
  double speed_m_s = 0;
};

// A resource: a single value that all systems can use.
struct Trip {
  core::CameraPose start;
  std::size_t models_seen = 0;
};

// Runs once per fixed step: the same on every machine and at every frame rate.
void glide(const scene::FixedStep& step, ecs::Query<Glider> gliders) {
  gliders.each([&](auto, std::span<Glider> all) {
    for (Glider& glider : all) {
      const double wanted_m_s = 20 + 10 * std::sin(step.now_s());
      glider.speed_m_s += 2 * (wanted_m_s - glider.speed_m_s) * step.step_s;
      glider.x_before_m = std::exchange(glider.x_m, glider.x_m + glider.speed_m_s * step.step_s);
    }
  });
}

// Runs once per frame, before the engine reads the pose: moves the camera to the glider.
void follow(const scene::FixedStep& step, const Trip& trip, ecs::Query<const Glider> gliders,
            scene::Input& input) {
  gliders.each([&](auto, std::span<const Glider> all) {
    const Glider& glider = all[0];
    input.pose = trip.start;
    input.pose.yaw = 1.57;  // east
    input.pose.position.local.x += std::lerp(glider.x_before_m, glider.x_m, step.share);
  });
}

// Runs once per frame. Each event arrives exactly once, in batches.
void count(Trip& trip, ecs::EventReader<scene::ModelCreated>& created) {
  trip.models_seen += created.drain([](std::span<const scene::ModelCreated>) {});
}

core::Result<void> play(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 5;
  const auto world = core::data_file("worlds/five_species.toml");
  if (!world) return tl::unexpected(world.error());

  Trip* trip = nullptr;
  app::Plugin plugin;
  plugin.name = "glider";
  plugin.add_systems = [&trip](scene::Systems& systems) -> core::Result<void> {
    trip = &systems.resource<Trip>();
    systems.entities.create<Glider>(1);
    systems.step.add("glide", glide);
    systems.frame.add("follow", follow, ecs::before("input"));
    systems.frame.add("count", count, ecs::after("streaming"));
    return {};
  };
  app::SessionOptions options;
  options.world_file = *world;
  options.headless = true;
  options.size = {320, 180};
  options.plugins.push_back(plugin);
  auto session = app::Session::create(options);
  if (!session) return tl::unexpected(session.error());
  trip->start = (*session)->home();

  if (auto ok = (*session)->prepare(trip->start); !ok) return tl::unexpected(ok.error());
  for (double now_s = 0; now_s < seconds; now_s += 1.0 / 30) {
    if (auto ok = (*session)->tick(trip->start, 1.0 / 30); !ok) return tl::unexpected(ok.error());
  }
  const scene::Scene& scene = (*session)->scene();
  const core::WorldPosition& at = scene.camera().pose.position;
  std::printf("%llu steps, block %d, %zu models seen\n",
              static_cast<unsigned long long>(scene.step().index), at.block.x, trip->models_seen);
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  return program::run("example_systems", [&] { return play(argc, argv); });
}
