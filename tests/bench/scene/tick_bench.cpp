// Cost of each system of a tick along a flight on the null device, without drawing. The flight runs
// several times, and the table shows the median of each tick, so that other programs do not count.
// After each tick the modelers finish their requests, as they do during a drawn frame. With EDITS,
// flights alternate with flights through a world with that many edits (removals, moves and raised
// ground), and a second table follows. With "draw", frames of 1280 × 720 are rendered, and `render`
// and the last row include them.
//
//   psygen_bench_scene [PATH [WORLD [HZ [FLIGHTS [EDITS [draw]]]]]]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/core/hash.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/state.hpp"
#include "engine/world/camera_path.hpp"
#include "engine/world/files/path_file.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/source_file.hpp"

namespace psygen::scene {
namespace {

const std::string kGame = source_file("game/");

// Returns the quantile `share` of the values, 0 to 1.
double percentile(std::vector<double> values, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(at));
  return values[at];
}

// Returns `count` edits, spread evenly over the world, or over 512 × 512 blocks of an endless one.
world::Edits edits_of(const world::World& world, const models::Registry& registry, long count) {
  world::Edits edits;
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kPosition);
  const double size_m = world.block_size_m();
  const auto block = [&](std::int64_t blocks) {
    return static_cast<std::int32_t>(random.next_integer(0, (blocks > 0 ? blocks : 512) - 1));
  };
  const auto models = static_cast<std::int64_t>(world::models_per_block(world));
  for (long i = 0; i < count; ++i) {
    const core::WorldPosition at{{block(world.blocks_x), block(world.blocks_z)},
                                 {random.next_real(0, size_m), 0, random.next_real(0, size_m)}};
    const world::InstanceName model{at.block, static_cast<std::uint32_t>(random.next_integer(
                                                  0, std::max<std::int64_t>(models - 1, 0)))};
    if (i % 16 == 0) {
      (void)edits.move(world, registry, model, at);
    } else if (i % 4 == 0) {
      const double radius_m = random.next_real(1, 12);
      (void)edits.raise(world, at, radius_m, random.next_real(-1, 1));
    } else {
      (void)edits.remove(world, model);
    }
  }
  return edits;
}

// Returns times by system and tick. The path follows the ground without edits. `renderer` may be
// null.
std::vector<std::vector<double>> fly(const world::World& world, const world::Edits& edits,
                                     const world::CameraPath& path, double hz,
                                     render::Renderer* renderer, std::vector<std::string>& names) {
  SceneSettings settings;
  settings.modelers = 1;
  auto made = Scene::create(world, models::make_standard_registry(), settings, renderer);
  if (!made) return {};
  Scene& scene = **made;
  scene.edit(edits);
  State& state = state_of(scene);
  scene.settle(path.pose_at(0, world));
  names = system_names(state);
  std::vector<std::vector<double>> times(names.size());
  const auto ticks = static_cast<int>(path.duration_seconds() * hz);
  for (int i = 0; i < ticks; ++i) {
    state.clock.now_s = i / hz;
    state.input.pose = path.pose_at(state.clock.now_s, world);
    tick(state);
    for (std::size_t k = 0; k < names.size(); ++k)
      times[k].push_back(static_cast<double>(state.system_ms[k]));
    state.supply.wait();
  }
  return times;
}

// Returns the median over the flights for each tick.
std::vector<double> typical(const std::vector<std::vector<double>>& flights) {
  std::vector<double> result(flights.front().size()), tick;
  for (std::size_t i = 0; i < result.size(); ++i) {
    tick.clear();
    for (const std::vector<double>& flight : flights)
      tick.push_back(flight[i]);
    result[i] = percentile(tick, 0.5);
  }
  return result;
}

void print(const std::string& name, const std::vector<double>& ms) {
  fmt::print("{:<16} {:9.3f} {:9.3f} {:9.3f} {:9.3f}\n", name, percentile(ms, 0.5),
             percentile(ms, 0.95), percentile(ms, 0.99), percentile(ms, 1.0));
}

// Times of the flights with edits.
struct Flights {
  std::vector<std::vector<std::vector<double>>> systems;  // by system, by flight, by tick
  std::vector<std::vector<double>> sums;  // all systems; includes render if it draws

  bool fly(const world::World& world, const world::Edits& edits, const world::CameraPath& path,
           double hz, render::Renderer* renderer, std::vector<std::string>& names) {
    auto times = scene::fly(world, edits, path, hz, renderer, names);
    if (times.empty()) return false;
    systems.resize(names.size());
    std::vector<double> sum(times.front().size(), 0.0);
    for (std::size_t k = 0; k < names.size(); ++k) {
      for (std::size_t i = 0; i < sum.size(); ++i)
        sum[i] += names[k] == "render" && renderer == nullptr ? 0.0 : times[k][i];
      systems[k].push_back(std::move(times[k]));
    }
    sums.push_back(std::move(sum));
    return true;
  }

  void print(const std::vector<std::string>& names, const std::string& title,
             const std::string& sum) const {
    fmt::print("{:<16} {:>9} {:>9} {:>9} {:>9}\n", title, "p50", "p95", "p99", "max");
    for (std::size_t k = 0; k < names.size(); ++k)
      scene::print(names[k], typical(systems[k]));
    scene::print(sum, typical(sums));
  }
};

int run(const std::string& path_file, const std::string& world_file, double hz, int flights,
        long edit_count, bool draws) {
  const models::Registry registry = models::make_standard_registry();
  const auto world = world::load_world(world_file, registry);
  const auto path = world::load_camera_path(path_file);
  if (!world || !path || hz <= 0 || flights < 1) {
    fmt::print(stderr, "{}\n",
               !world  ? world.error().message
               : !path ? path.error().message
                       : "HZ and FLIGHTS must be above 0");
    return 2;
  }
  std::unique_ptr<render::Renderer> renderer;
  if (draws) {
    auto made = render::Renderer::create({});
    if (!made) {
      fmt::print(stderr, "{}\n", made.error().message);
      return 1;
    }
    renderer = std::move(*made);
  }
  std::vector<std::string> names;
  Flights plain, edited;
  const core::Stopwatch making(false);
  const world::Edits edits = edits_of(*world, registry, edit_count);
  if (edit_count > 0) fmt::print("{} edits in {:.1f} s\n", edit_count, making.seconds());
  for (int flight = 0; flight < flights; ++flight) {
    if (!plain.fly(*world, {}, *path, hz, renderer.get(), names)) return 1;
    if (edit_count > 0 && !edited.fly(*world, edits, *path, hz, renderer.get(), names)) return 1;
  }
  const std::string sum = draws ? "all" : "all but render";
  plain.print(names, "system, ms", sum);
  if (edit_count > 0) edited.print(names, "edited, ms", sum);
  return 0;
}

}  // namespace
}  // namespace psygen::scene

int main(int argc, char** argv) {
  using psygen::scene::kGame;
  const auto argument = [&](int i, const std::string& otherwise) {
    return argc > i ? std::string(argv[i]) : otherwise;
  };
  return psygen::scene::run(
      argument(1, kGame + "paths/walk27.toml"), argument(2, kGame + "worlds/paper.toml"),
      std::atof(argument(3, "30").c_str()), std::atoi(argument(4, "5").c_str()),
      std::atol(argument(5, "0").c_str()), argument(6, "") == "draw");
}
