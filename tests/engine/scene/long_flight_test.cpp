// A flight of an hour, or of PSYGEN_LONG_FLIGHT_HOURS, over a random path with a small budget, on
// the virtual clock and without drawing (docs/frame-tests.md). Not part of the default run: label
// "long".
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <numbers>

#include "engine/core/hash.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

constexpr double kStepS = 0.1, kSpeedMps = 50;
constexpr std::uint64_t kSeed = 20, kTicksPerHour = 36'000;

double hours_wanted() {
  const char* text = std::getenv("PSYGEN_LONG_FLIGHT_HOURS");
  return text != nullptr ? std::atof(text) : 1.0;
}

std::uint64_t resident_bytes() {
  std::uint64_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * 4096;
}

// Turns at random for some seconds each, and sometimes jumps anywhere.
class RandomPath {
 public:
  core::CameraPose next(const world::World& world) {
    if (left_ == 0) choose(world);
    --left_;
    yaw_ += turn_ * kStepS;
    x_ += std::sin(yaw_) * kSpeedMps * kStepS;
    z_ -= std::cos(yaw_) * kSpeedMps * kStepS;
    core::CameraPose pose;
    pose.position = core::normalised({{256, 256}, {x_, 0, z_}}, world.block_size_m());
    glm::dvec3& local = pose.position.local;
    local.y =
        height_m_ + models::ground_height_m(world.terrain, pose.position.block, local.x, local.z);
    pose.yaw = yaw_;
    pose.pitch = -0.1;
    return pose;
  }

 private:
  void choose(const world::World& world) {
    left_ = 20 + static_cast<int>(random_.next_unit() * 200);
    turn_ = random_.next_real(-0.8, 0.8);
    height_m_ = random_.next_real(2, 60);
    const double reach_m = 200 * world.block_size_m();
    const bool outside = std::max(std::abs(x_), std::abs(z_)) > reach_m;
    if (!outside && random_.next_unit() > 0.05) return;
    x_ = random_.next_real(-reach_m, reach_m);
    z_ = random_.next_real(-reach_m, reach_m);
  }

  core::RandomStream random_{kSeed, 0, 0, 0, core::Purpose::kParameters};
  int left_ = 0;
  double x_ = 0, z_ = 0, yaw_ = 0, turn_ = 0, height_m_ = 10;
};

// The result of a flight.
struct End {
  std::uint64_t hash = 0;  // of every tick's record, and of the cache
  std::uint64_t models = 0, evictions = 0;
  std::uint64_t resident_early = 0, resident_late = 0;
  std::size_t entities_early = 0, entities_late = 0;
};

std::uint64_t hash_of(const State& s, std::uint64_t hash) {
  const telemetry::FrameRecord& r = s.telemetry.record;
  for (const std::uint64_t value :
       {r.cache_bytes, r.triangles, r.triangles_synthesised, std::uint64_t{r.draws},
        std::uint64_t{r.holes}, std::uint64_t{r.coarse_nodes}, std::uint64_t{r.cache_misses},
        std::uint64_t{r.cache_evictions}, std::uint64_t{r.requests_queued}})
    hash = core::combine(hash, value);
  return hash;
}

End fly(double hours) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 400;
  settings.budget_bytes = 6ull << 20;
  const auto scene = make_scene(settings);
  State& s = state_of(*scene);
  const std::uint64_t first_tick = s.clock.tick;
  RandomPath path;
  End end;
  const auto ticks = static_cast<std::uint64_t>(hours * kTicksPerHour);
  for (std::uint64_t tick_index = 0; tick_index < ticks; ++tick_index) {
    s.input.pose = path.next(s.facts.world);
    tick(s);
    s.clock.now_s = static_cast<double>(tick_index + 1) * kStepS;
    const synthesis::CacheStats stats = s.supply.stats();
    if (stats.bytes > settings.budget_bytes || s.memory->used_bytes() > settings.budget_bytes ||
        s.output.error) {
      ADD_FAILURE() << "tick " << tick_index << ": " << stats.bytes << " bytes";
      break;
    }
    end.hash = hash_of(s, end.hash);
    end.models += s.telemetry.record.models_synthesised;
    if (tick_index == ticks / 4) {
      end.resident_early = resident_bytes();
      end.entities_early = s.entities.size();
    }
  }
  end.resident_late = resident_bytes();
  end.entities_late = s.entities.size();
  const synthesis::CacheStats stats = s.supply.stats();
  EXPECT_LE(stats.peak_bytes, settings.budget_bytes);
  EXPECT_EQ(s.clock.tick, first_tick + ticks);
  EXPECT_NEAR(s.clock.real_s, hours * 3600 - kStepS, 1e-6) << "the clock drifts";
  end.evictions = stats.evictions;
  for (const std::uint64_t value : {stats.bytes, stats.hits, stats.misses, stats.evictions,
                                    stats.regenerations, stats.triangles})
    end.hash = core::combine(end.hash, value);
  return end;
}

TEST(LongFlight, StaysWithinItsBudgetAndRepeatsExactly) {
  const double hours = hours_wanted();
  ASSERT_GT(hours, 0) << "PSYGEN_LONG_FLIGHT_HOURS";
  const End first = fly(hours);
  std::cout << hours << " h: " << first.models << " models, " << first.evictions
            << " evictions, resident " << (first.resident_early >> 20) << " and "
            << (first.resident_late >> 20) << " MiB, entities " << first.entities_early << " and "
            << first.entities_late << ", hash " << std::hex << first.hash << std::dec << "\n";
  EXPECT_GT(first.evictions, first.models / 2) << "the budget is too large to matter";
  EXPECT_LT(first.resident_late, first.resident_early + (4ull << 20)) << "memory grows";
  EXPECT_LT(first.entities_late, 2 * first.entities_early + 1000);
  EXPECT_EQ(fly(hours).hash, first.hash);
}

}  // namespace
}  // namespace psygen::scene
