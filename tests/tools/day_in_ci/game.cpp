// A game in two revisions: PSYGEN_DAY_WAYS is the number of ways that its system "paths" tries in
// each step. The slower one tries more than it needs.
#include <cmath>
#include <cstdint>

#include "engine/app/options.hpp"
#include "engine/frametest/run.hpp"
#include "engine/scene/systems.hpp"

namespace game {

// The length of the best way: fixed work, without memory.
[[gnu::noinline]] double find_path(int way) {
  double length = way;
  for (int i = 0; i < 25'000; ++i)
    length = std::sqrt(length * length + static_cast<double>(i % 7));
  return length;
}

struct Paths {
  double shortest = 0;
};

void paths_system(Paths& paths) {
  paths.shortest = find_path(1);
  for (int way = 2; way <= PSYGEN_DAY_WAYS; ++way)
    paths.shortest = std::fmin(paths.shortest, find_path(way));
}

}  // namespace game

int main(int argc, char** argv) {
  using namespace psygen;
  frametest::Hooks hooks;
  hooks.prepare = [](app::SessionOptions& session) -> core::Result<void> {
    app::Plugin plugin;
    plugin.name = "game";
    plugin.add_systems = [](scene::Systems& systems) -> core::Result<void> {
      systems.resource<game::Paths>();
      systems.step.add("paths", game::paths_system);
      return {};
    };
    session.plugins.push_back(std::move(plugin));
    return {};
  };
  return frametest::frame_test_main(argc, argv, hooks);
}
