// Time of a stamp for all heights of a block of the paper's terrain, with each part of a mask. The
// argument selects the part; the case without a stamp is the time of the noise.
#include <benchmark/benchmark.h>

#include <numeric>
#include <vector>

#include "engine/models/edits.hpp"
#include "engine/models/terrain/shape.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "tests/bench/synthesis/per_target.hpp"

namespace psygen::models {
namespace {

enum Part { kNoStamp, kNoMask, kStrength, kPicture, kPatches, kHeight, kSlope };

std::shared_ptr<const GroundEdit> stamp_with(std::int64_t part) {
  GroundEdit stamp;
  stamp.change = GroundChange::kStampAdd;
  stamp.square = true;
  stamp.radius_m = 500;
  stamp.map =
      std::make_shared<const Heightmap>(Heightmap{64, 64, std::vector<float>(64 * 64, 5.0F)});
  GroundMask mask;
  if (part == kPicture)
    mask.picture = std::make_shared<const GreyPicture>(
        GreyPicture{64, 64, std::vector<std::uint16_t>(64 * 64, 30'000), 1});
  if (part == kPatches) mask.noise_m = 40;
  if (part == kHeight) mask.height_m = {20, 5, 60, 5};
  if (part == kSlope) mask.slope.max = 0.5;
  if (part == kStrength) stamp.strength = 0.5;
  if (part > kStrength) stamp.mask = std::make_shared<const GroundMask>(mask);
  seal(stamp);
  return std::make_shared<const GroundEdit>(stamp);
}

void stamp_on_a_block(benchmark::State& state) {
  const auto type = make_terrain_type();
  Parameters terrain = default_parameters(*type);
  EditLayer layer;
  if (state.range(0) != kNoStamp) layer.ground.shapes.add(stamp_with(state.range(0)), 63);
  terrain.set_edits(&layer, 1);
  const TerrainShape shape(terrain);
  std::vector<std::int64_t> at(64);
  std::iota(at.begin(), at.end(), 0);
  std::vector<float> values(at.size() * at.size());
  for (auto _ : state) {
    shape.evaluate(at, at, values, at.size(), {});
    benchmark::DoNotOptimize(values.data());
  }
  bench::report_seconds_each(state, static_cast<double>(values.size()));
}
BENCHMARK(stamp_on_a_block)->ArgName("part")->DenseRange(kNoStamp, kSlope);

}  // namespace
}  // namespace psygen::models
