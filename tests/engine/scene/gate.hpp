// Modelers that wait at a gate, so that tests control how many meshes become ready, at any speed of
// the machine.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "tests/engine/scene/fixture.hpp"
#include "tests/engine/scene/forwarding_type.hpp"

namespace psygen::scene {

// Lets modelers through one by one.
class Gate {
 public:
  // `for_modelers_only`: the main thread must not make the meshes that wait here.
  explicit Gate(bool for_modelers_only = false) : for_modelers_only_(for_modelers_only) {}
  bool for_modelers_only() const { return for_modelers_only_; }
  void pass() {
    std::unique_lock lock(mutex_);
    ++waiting_;
    opened_.wait(lock, [this] { return open_ || passes_ > 0; });
    --waiting_;
    if (!open_) --passes_;
  }
  void let_through(int passes) {
    change([&] { passes_ += passes; });
  }
  // Lets only this many pass from now on.
  void let_only(int passes) {
    change([&] { passes_ = passes; });
  }
  // True if a modeler waits and none may pass.
  bool blocks() {
    const std::lock_guard lock(mutex_);
    return waiting_ > 0 && !open_ && passes_ == 0;
  }
  void set_open(bool open) {
    change([&] {
      open_ = open;
      passes_ = 0;
    });
  }

 private:
  template <class Change>
  void change(const Change& change) {
    {
      const std::lock_guard lock(mutex_);
      change();
    }
    opened_.notify_all();
  }

  const bool for_modelers_only_;
  std::mutex mutex_;
  std::condition_variable opened_;
  bool open_ = true;
  int passes_ = 0, waiting_ = 0;
};

// A model type whose synthesis in a modeler waits at a gate.
class SlowType final : public ForwardingType {
 public:
  SlowType(std::string name, const models::ModelType& fast, Gate& gate)
      : ForwardingType(std::move(name), fast), gate_(gate) {}
  core::Bounds synthesise(const models::Parameters& p, int level,
                          const models::MeshView& out) const override {
    if (std::this_thread::get_id() != main_thread_) gate_.pass();
    return of().synthesise(p, level, out);
  }
  bool may_run_on_main_thread() const override {
    return !gate_.for_modelers_only() && of().may_run_on_main_thread();
  }

 private:
  Gate& gate_;
  const std::thread::id main_thread_ = std::this_thread::get_id();
};

// Latencies are those of the flight, though modelers are real.
inline void tell_time_of_flight(Scene& scene) {
  Clock& clock = state_of(scene).clock;
  clock.read_real_s = [&clock] { return clock.now_s; };
}

// The paper's world whose ground and trees wait at a gate. Latencies are those of the flight.
inline std::unique_ptr<Scene> slow_scene(const SceneSettings& settings, Gate& gate) {
  models::Registry registry = models::make_standard_registry();
  world::World world = paper_world(registry);
  const auto slow = [&](models::ModelIndex model) {
    const std::string name = "slow_" + std::string(registry[model].name());
    const auto added = registry.add(std::make_unique<SlowType>(name, registry[model], gate));
    EXPECT_TRUE(added);
    return *added;
  };
  world.terrain_model = slow(world.terrain_model);
  world.scatter[0].model = slow(world.scatter[0].model);
  std::unique_ptr<Scene> scene = make_scene(world, settings, std::move(registry));
  tell_time_of_flight(*scene);
  return scene;
}

// A view of a kilometre for slow_scene(): the main thread does not help, and requests that wait at
// the gate are not abandoned.
inline SceneSettings gated_settings() {
  SceneSettings settings = small_settings();
  settings.virtual_time = false;  // modelers are real, and wait at the gate
  settings.view_distance_m = 1000;
  settings.max_error_pixels = 12;
  settings.budget_bytes = 128ull << 20;
  settings.main_thread_budget_ms = 0;
  settings.watchdog_seconds = 1e6;
  return settings;
}

// slow_scene() with its gate, which opens when the modelers end.
struct GatedScene {
  explicit GatedScene(const SceneSettings& settings, bool for_modelers_only = false)
      : gate(for_modelers_only), scene(slow_scene(settings, gate)) {}
  ~GatedScene() { gate.set_open(true); }
  // Waits until the only modeler has made this many of the meshes that wait at the gate, and those
  // between them, or is idle.
  void make(int meshes) {
    gate.let_only(meshes);
    while (state_of(*scene).supply.outstanding() > 0 && !gate.blocks())
      std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
  GatedScene(const GatedScene&) = delete;
  GatedScene& operator=(const GatedScene&) = delete;

  Gate gate;
  std::unique_ptr<Scene> scene;
};

}  // namespace psygen::scene
