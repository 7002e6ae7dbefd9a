// Resolution and allowed errors of a tick. One control loop decides both: from the time that the
// last frames took (Governor), and from the memory that meshes in view lacked (coarsening). Values;
// main thread only.
#pragma once

#include <cstdint>
#include <limits>

#include "engine/scene/frame/governor.hpp"

namespace psygen::synthesis {
class MeshSupply;
}

namespace psygen::scene {

struct Quality {
  Governor governor;
  double resolution = 1;    // render::FrameInput::resolution
  double error_pixels = 0;  // allowed screen-space error of nodes
  // Allowed error of individual models: the governor's factor counts by its square root, because
  // these models are near, in the focus of attention, and a small part of a frame's triangles.
  double model_error_pixels = 0;
  float coarsening = 1;  // >= 1: factor on both errors while the geometry budget is too small
  bool draft = false;    // Input::draft
  // Real time since when every frame has lacked meshes that can still be synthesised; +inf: the
  // last frame lacked none, or there was no frame.
  double awaiting_since_s = std::numeric_limits<double>::infinity();
  bool warned_budget = false;
};

// Shortages of the last tick. The cache and render systems write them; the quality system answers
// them in the next tick.
struct MemoryPressure {
  std::uint32_t refused_visible = 0;  // requests for meshes in view that found no memory
  std::uint32_t waiting = 0;          // requests whose memory is about to be free
  std::uint32_t awaited = 0;          // DrawCounts::awaited
  double seen_share = 0;              // fraction of the mesh memory that meshes in view take
  double at_s = 0;                    // the real clock at that time
};

struct FrameContext;
struct Input;
struct SceneSettings;

// System: decides how fine this frame is.
void quality_system(FrameContext frame, const Input& input, const MemoryPressure& pressure,
                    const synthesis::MeshSupply& supply, Quality& quality);
// Sets the resolution and the allowed errors from governor and coarsening.
void set_detail(const SceneSettings& settings, Quality& quality);
// The load reduction that the minimum resolution gives: 1 / min_resolution².
double resolution_reduction_of(const SceneSettings& settings);

}  // namespace psygen::scene
