// Time until all meshes around a camera are ready on the ranks of mpirun, including meshes of a
// slow model type. Rank 0 ticks a scene without drawing, 60 times a second, with one modeler. The
// other ranks synthesise meshes for it with one thread each. Without mpirun, rank 0 is alone. The
// slow type computes on rank 0. On the other ranks it computes or sleeps equally long; sleeping
// suits machines with fewer processors than ranks, and leaves only the cost of sharing.
//
//   mpirun -n RANKS psygen_bench_ranks [compute|wait [MS]]
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include "engine/cluster/meeting.hpp"
#include "engine/cluster/model_server.hpp"
#include "engine/cluster/remote_modeler_pool.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/clock.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/meshes/requested_places.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/settings.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/engine/synthesis/fake_models.hpp"

namespace psygen {
namespace {

constexpr double kFrame_s = 1.0 / 60, kView_m = 160;

constexpr const char* kWorld = R"(format = 1

[world]
name = "slow"
seed = 3
blocks = [64, 64]

[[scatter]]
model = "slow"
count = 6
vertices = 4500

[[scatter]]
model = "tree"
count = 20
)";

// A model type with meshes of 100 KB and a given synthesis time.
class SlowType final : public synthesis::testing::FakeModel {
 public:
  SlowType(double seconds, bool waits) : FakeModel("slow", 1), seconds_(seconds), waits_(waits) {}
  bool is_seen_from_far() const override { return false; }
  core::Bounds synthesise(const models::Parameters& p, int level,
                          const models::MeshView& out) const override {
    if (waits_) std::this_thread::sleep_for(std::chrono::duration<double>(seconds_));
    const double begin_s = core::thread_cpu_seconds();
    while (!waits_ && core::thread_cpu_seconds() - begin_s < seconds_) {
    }
    return FakeModel::synthesise(p, level, out);
  }

 private:
  const double seconds_;
  const bool waits_;
};

core::CameraPose middle() {
  core::CameraPose pose;
  pose.position = {{32, 32}, {31.5, 60, 31.5}};
  return pose;
}

// Ticks until everything around the camera is ready. Returns seconds and the number of meshes.
struct Filled {
  double seconds = 0;
  std::uint32_t meshes = 0;
};
Filled fill(scene::Scene& scene) {
  const double begin_s = core::monotonic_seconds();
  for (double next_s = begin_s;; next_s += kFrame_s) {
    scene.input().pose = middle();
    if (auto ok = scene.tick(); !ok) return {};
    scene.set_now(scene.clock().now_s + kFrame_s);
    const auto there = scene.readiness(middle().position, kView_m).value();
    if (there.ready()) return {core::monotonic_seconds() - begin_s, there.meshes};
    std::this_thread::sleep_for(
        std::chrono::duration<double>(next_s + kFrame_s - core::monotonic_seconds()));
  }
}

int fly(world::World world, models::Registry registry, cluster::RemoteModelerPool* remote) {
  scene::SceneSettings settings;
  settings.modelers = 1;
  settings.view_distance_m = kView_m;
  auto scene = scene::Scene::create(std::move(world), std::move(registry), settings, nullptr,
                                    nullptr, {}, remote);
  if (!scene) {
    fmt::print(stderr, "{}\n", scene.error().message);
    return EXIT_FAILURE;
  }
  const Filled filled = fill(**scene);
  scene->reset();
  const cluster::RemoteStats figures = remote ? remote->figures() : cluster::RemoteStats{};
  fmt::print(
      "{} ranks: {} meshes are there after {:.2f} s; other ranks made {} ({:.1f} MB); there and "
      "back {:.0f} µs, with 100 KB {:.0f} µs\n",
      figures.ranks + 1, filled.meshes, filled.seconds, figures.meshes,
      static_cast<double>(figures.bytes) * 1e-6, figures.way.latency_s * 1e6,
      figures.way.seconds(1e5) * 1e6);
  return EXIT_SUCCESS;
}

int run(bool waits, double seconds) {
  const auto peers = cluster::is_rank() ? cluster::join_communicator().value() : nullptr;
  models::Registry registry = models::make_standard_registry();
  const bool is_first = !peers || peers->rank() == 0;
  (void)registry.add(std::make_unique<SlowType>(seconds, waits && !is_first));
  world::World world = world::parse_world(kWorld, "slow.toml", registry).value();
  if (!peers) return fly(std::move(world), std::move(registry), nullptr);
  const cluster::CompatibilityKey key = cluster::compatibility_key(world, registry, "bench");
  const auto threads = cluster::meet(key, 1, *peers).value();
  int code = EXIT_SUCCESS;
  if (is_first) {
    const auto remote = cluster::RemoteModelerPool::start(key, threads, *peers).value();
    code = fly(std::move(world), std::move(registry), remote.get());
    if (!remote->end()) peers->abort();
  } else {
    (void)cluster::run_model_server(registry, 1, *peers);
  }
  peers->finish();
  return code;
}

}  // namespace
}  // namespace psygen

int main(int argc, char** argv) {
  const bool waits = argc > 1 && std::string(argv[1]) == "wait";
  return psygen::run(waits, argc > 2 ? std::atof(argv[2]) * 1e-3 : 20e-3);
}
