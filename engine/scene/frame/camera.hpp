// The camera of a tick and its predicted poses. Values; main thread only.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/camera.hpp"
#include "engine/core/surface_provider.hpp"
#include "engine/visibility/camera_predictor.hpp"

namespace psygen::scene {

struct Camera {
  core::CameraPose pose;  // the last valid one
  core::Projection projection;
  core::Extent size;  // of the frame in pixels
  float pixels_per_radian = 0;
  std::uint64_t rejected_poses = 0;
  visibility::CameraPredictor predictor;
  // The pose in tau_s seconds.
  struct Prediction {
    float tau_s = 0;
    core::CameraPose pose;
  };
  std::vector<Prediction> predictions;
};

struct Clock;
struct Input;
struct WorldFacts;

// System: takes over the requested pose and predicts poses. Rejects an invalid pose and keeps the
// last valid one.
void input_system(const Input& input, const Clock& clock, const WorldFacts& facts, Camera& camera);
// Adapts the camera to the size of the frame. An empty size changes nothing.
void fit_to_size(const core::Extent& size, Camera& camera);

}  // namespace psygen::scene
