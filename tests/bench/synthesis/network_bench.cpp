// Time of a river network: patches, the first question anywhere, and the ground of a block.
#include <benchmark/benchmark.h>

#include <vector>

#include "engine/models/kit/simd_targets.hpp"
#include "engine/models/network/network.hpp"

namespace psygen::synthesis {
namespace {

using models::RiverNetwork;

std::shared_ptr<const RiverNetwork> network_of(std::shared_ptr<models::NetworkStore> store) {
  return *RiverNetwork::create({.sea_share = 0.1}, {.relief_m = 2000, .sea_level_m = 200},
                               std::move(store));
}

// Nothing is cached: every iteration is far from all others.
void first_question_anywhere(benchmark::State& state) {
  std::int64_t place = 0;
  for (auto _ : state) {
    const auto network = network_of(std::make_shared<models::NetworkStore>());
    place += 1'000'003;
    benchmark::DoNotOptimize(network->patch(network->tile_of(place, -place / 3, {})));
  }
}
BENCHMARK(first_question_anywhere)->Unit(benchmark::kMillisecond)->Iterations(50);

// The root is cached, patches are not.
void patch_of_32_blocks_squared(benchmark::State& state) {
  const auto store = std::make_shared<models::NetworkStore>();
  const auto network = network_of(store);
  network->patch(network->tile_of(0, 30'000, {}));
  std::int64_t i = 0;
  for (auto _ : state) {
    ++i;
    benchmark::DoNotOptimize(
        network->patch(network->tile_of(2016 * (i % 30), 30'000 + 2016 * (i / 30), {})));
  }
}
BENCHMARK(patch_of_32_blocks_squared)->Unit(benchmark::kMillisecond)->Iterations(60);

// Heights and water of 64 × 64 vertices with a warm patch. The argument selects the instruction
// set: 0 is the best.
void ground_of_a_block(benchmark::State& state) {
  const auto targets = models::simd_targets();
  const auto number = static_cast<std::size_t>(state.range(0));
  if (number >= targets.size()) return state.SkipWithError("no such instruction set");
  models::pin_simd_target(targets[number]);
  state.SetLabel(std::string(targets[number]));
  const auto network = network_of(std::make_shared<models::NetworkStore>());
  std::vector<float> height(64 * 64), water(64 * 64);
  std::vector<std::int64_t> x(64), z(64);
  std::int64_t block = 0;
  for (auto _ : state) {
    const std::int64_t i = block % 30, k = block / 30 % 30;
    ++block;
    for (std::int64_t v = 0; v < 64; ++v) {
      x[static_cast<std::size_t>(v)] = 63 * i + v;
      z[static_cast<std::size_t>(v)] = 30'240 + 63 * k + v;
    }
    network->evaluate({x, z}, {},
                      {.height_m = height.data(), .water_m = water.data(), .stride = 64});
    benchmark::DoNotOptimize(height.data());
  }
  models::unpin_simd_target();
}
BENCHMARK(ground_of_a_block)
    ->ArgName("set")
    ->DenseRange(0, 3)
    ->Unit(benchmark::kMicrosecond)
    ->Iterations(900);

template <class Ask>
void ask_of_places(benchmark::State& state, const Ask& ask) {
  const auto network = network_of(std::make_shared<models::NetworkStore>());
  std::int32_t i = 0;
  for (auto _ : state) {
    i = (i + 1) % 900;
    const core::WorldPosition at{{i % 30, 480 + i / 30}, {i % 63 + 0.3, 0, i % 59 + 0.7}};
    benchmark::DoNotOptimize(ask(*network, at));
  }
}
void water_at_a_place(benchmark::State& state) {
  ask_of_places(state, [](const RiverNetwork& n, const auto& at) { return n.water_at(at); });
}
BENCHMARK(water_at_a_place);
void inland_water_at_a_place(benchmark::State& state) {
  ask_of_places(state, [](const RiverNetwork& n, const auto& at) { return n.inland_water_at(at); });
}
BENCHMARK(inland_water_at_a_place);
void inland_water_in_a_block(benchmark::State& state) {
  ask_of_places(state, [](const RiverNetwork& n, const auto& at) {
    return n.may_have_water(n.square_of(at.block, 0));
  });
}
BENCHMARK(inland_water_in_a_block);

}  // namespace
}  // namespace psygen::synthesis
