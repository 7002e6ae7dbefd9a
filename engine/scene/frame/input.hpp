// Requests from the game, the app or the editor for the next tick. Values; main thread only.
#pragma once

#include <span>
#include <vector>

#include "engine/core/camera.hpp"
#include "engine/render/types.hpp"

struct ImDrawData;

namespace psygen::scene {

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

}  // namespace psygen::scene
