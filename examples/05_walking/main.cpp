// Walking with collision: a physics character, rebindable actions, and a first-person camera. Keys:
// W A S D, mouse, space to jump, shift to run. With a number, it walks for that many seconds
// without a window and prints the distance.
//   example_walking [seconds]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <utility>

#include "engine/app/session.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/data_file.hpp"
#include "engine/input/actions.hpp"
#include "engine/models/registry.hpp"
#include "engine/physics/world.hpp"
#include "engine/platform/window.hpp"
#include "engine/program/program.hpp"
#include "engine/query/world.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/world.hpp"

using namespace psygen;

namespace {

constexpr double kEyesM = 1.65;

struct Game {
  std::optional<query::World> query;
  std::optional<physics::World> physics;
  physics::CharacterId player;
  double yaw = 0, pitch = 0, walked_m = 0;
  glm::dvec3 moved{0.0};  // metres, in the last step
  input::ActionId ahead = 0, aside = 0, run = 0, jump = 0, look_x = 0, look_y = 0;
};

core::Result<void> add_actions(input::Actions& actions, Game& game) {
  using platform::Key;
  const auto add = [&](input::ActionId& id, const char* name, std::vector<input::Binding> keys) {
    const auto added = actions.add(name, std::move(keys));
    if (added) id = *added;
    return added.has_value();
  };
  using Way = input::MouseDirection;
  const bool ok = add(game.ahead, "ahead", {{Key::kW}, {Key::kS, -1}}) &&
                  add(game.aside, "aside", {{Key::kD}, {Key::kA, -1}}) &&
                  add(game.run, "run", {{Key::kLeftShift}}) &&
                  add(game.jump, "jump", {{Key::kSpace}}) &&
                  add(game.look_x, "look_x", {{Way::kRight, 0.002F}, {Way::kLeft, -0.002F}}) &&
                  add(game.look_y, "look_y", {{Way::kUp, 0.002F}, {Way::kDown, -0.002F}});
  return ok ? core::Result<void>()
            : core::fail(core::ErrorCode::kInternal, "an action has an invalid name");
}

// Runs one fixed step.
void step(Game& game, const input::Actions& actions, bool by_itself, double step_s) {
  const auto value = [&](input::ActionId id) { return double{actions.state(id).value}; };
  game.yaw += value(game.look_x);
  game.pitch = std::clamp(game.pitch + value(game.look_y), -1.5, 1.5);
  const double ahead = by_itself ? 1 : value(game.ahead), aside = value(game.aside);
  const double s = std::sin(game.yaw), c = std::cos(game.yaw);
  physics::CharacterInput wanted;
  wanted.direction = {s * ahead + c * aside, -c * ahead + s * aside};
  wanted.run = by_itself || actions.state(game.run).held;
  wanted.jump = actions.state(game.jump).pressed;
  const core::WorldPosition before = game.physics->state(game.player)->feet;
  (void)game.physics->tell(game.player, wanted);
  (void)game.physics->step(step_s);
  const core::WorldPosition feet = game.physics->state(game.player)->feet;
  game.moved = feet.local + core::offset_m(feet.block, before, game.query->world().block_size_m());
  game.walked_m += std::hypot(game.moved.x, game.moved.z);
}

// Returns the eyes, interpolated between the last two steps.
core::CameraPose eyes(const Game& game, double share) {
  core::CameraPose pose;
  pose.position = game.physics->state(game.player)->feet;
  pose.position.local -= game.moved * (1 - share);
  pose.position.local.y += kEyesM;
  pose.yaw = game.yaw;
  pose.pitch = game.pitch;
  return pose;
}

core::Result<void> play(int argc, char** argv) {
  const bool by_itself = argc > 1;
  const auto world = core::data_file("worlds/five_species.toml");
  if (!world) return tl::unexpected(world.error());
  Game game;
  app::Plugin plugin;
  plugin.name = "walking";
  plugin.on_step = [&](app::Session& session, double step_s) {
    step(game, session.actions(), by_itself, step_s);
  };
  app::SessionOptions options;
  options.world_file = *world;
  options.headless = by_itself;
  if (by_itself) options.size = {320, 180};
  options.plugins.push_back(plugin);
  auto session = app::Session::create(options);
  if (!session) return tl::unexpected(session.error());
  if (auto ok = add_actions((*session)->actions(), game); !ok) return tl::unexpected(ok.error());

  scene::Scene& scene = (*session)->scene();
  game.query.emplace(scene.world(), scene.registry());
  auto physics = physics::World::create(*game.query);
  if (!physics) return tl::unexpected(physics.error());
  game.physics.emplace(std::move(*physics));
  const auto player =
      game.physics->add(physics::CharacterSettings{.feet = (*session)->home().position});
  if (!player) return tl::unexpected(player.error());
  game.player = *player;
  if ((*session)->window() != nullptr) (*session)->window()->capture_cursor(true);
  if (auto ok = (*session)->prepare(eyes(game, 1)); !ok) return tl::unexpected(ok.error());

  using Clock = std::chrono::steady_clock;
  Clock::time_point last = Clock::now();
  double dt_s = 1.0 / 60;
  while ((*session)->poll() && !(by_itself && (*session)->now_s() >= std::atof(argv[1]))) {
    const auto drawn = (*session)->tick(eyes(game, scene.step().share), dt_s);
    if (!drawn) return tl::unexpected(drawn.error());
    const Clock::time_point now = Clock::now();
    if (!by_itself) dt_s = std::chrono::duration<double>(now - std::exchange(last, now)).count();
  }
  const core::WorldPosition feet = game.physics->state(game.player)->feet;
  const auto ground = game.query->ground(feet);
  const double above_m = ground ? feet.local.y - ground->height_m : -1;
  std::printf("walked %.0f m, %.2f m above the ground\n", game.walked_m, above_m);
  if (above_m > -0.01) return {};
  return core::fail(core::ErrorCode::kInternal, "the walker is below the ground");
}

}  // namespace

int main(int argc, char** argv) {
  return program::run("example_walking", [&] { return play(argc, argv); });
}
