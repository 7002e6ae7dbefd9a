
#include "engine/scene/frame/input.hpp"

#include <array>

#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/clock.hpp"

namespace psygen::scene {
namespace {
// Prediction times: synthesis latency, then up to some seconds.
constexpr std::array kPredictionSeconds{0.25F, 0.75F, 1.5F, 3.0F};
}  // namespace

void fit_to_size(const core::Extent& size, Camera& camera) {
  if (size.width > 0 && size.height > 0) camera.size = size;
  camera.projection.aspect =
      static_cast<float>(camera.size.width) / static_cast<float>(camera.size.height);
  camera.pixels_per_radian =
      camera.projection.pixels_per_radian(static_cast<float>(camera.size.height));
}

void input_system(const Input& input, const Clock& clock, const WorldFacts& facts, Camera& camera) {
  const double block_size_m = facts.world.block_size_m();
  if (core::is_valid(input.pose)) {
    camera.pose = input.pose;
    camera.pose.position = core::normalised(input.pose.position, block_size_m);
  } else {
    ++camera.rejected_poses;
  }
  fit_to_size(input.size, camera);

  camera.predictor.observe(clock.now_s, camera.pose, block_size_m);
  camera.predictions.clear();
  for (const float tau_s : kPredictionSeconds) {
    camera.predictions.push_back({tau_s, camera.predictor.predict(tau_s)});
  }
}

}  // namespace psygen::scene
