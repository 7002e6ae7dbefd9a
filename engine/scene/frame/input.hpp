// Requests for the next tick, and the camera that follows them. Values; main thread only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/camera.hpp"
#include "engine/core/surface_provider.hpp"
#include "engine/render/types.hpp"
#include "engine/visibility/camera_predictor.hpp"

struct ImDrawData;

namespace psygen::scene {

// Requests from the game, the app or the editor.
struct Input {
  core::CameraPose pose;
  core::Extent size{1280, 720};  // of the frame in pixels
  // Drawn over the frame, in this order (docs/hud.md).
  render::HudDrawing hud;
  std::vector<render::TextPanel> panels;
  float text_scale = 1;             // of the panels' text
  const ImDrawData* gui = nullptr;  // null: none; valid during the tick
  render::View view = render::View::kNormal;
  // True while a user tries values one after another: meshes of the replaced world get coarse
  // replacements, and no mesh gets finer (meshes/mesh_choice.hpp).
  bool draft = false;
  std::span<const render::Line> lines;  // drawn over the frame, camera space; valid during the tick
  // Time of the last frame without waits for a display, and its triangles; 0: unknown.
  double frame_ms = 0, frame_triangles = 0;
};

// The camera of a tick and its predicted poses.
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
struct WorldFacts;

// System: takes over the requested pose and predicts poses. Rejects an invalid pose and keeps the
// last valid one.
void input_system(const Input& input, const Clock& clock, const WorldFacts& facts, Camera& camera);
// Adapts the camera to the size of the frame. An empty size changes nothing.
void fit_to_size(const core::Extent& size, Camera& camera);

}  // namespace psygen::scene
