// Settings of a scene that users choose, with defaults. Values only.
#pragma once

#include <cstdint>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/synthesis/policy.hpp"
#include "engine/visibility/plp.hpp"

namespace psygen::scene {

// The paper's three ways to get geometry from parameters (sections 3.3 and 4).
enum class Paradigm : std::uint8_t {
  kParallelLazyAmplification,  // on demand, in parallel, cached, prefetched
  kDataAmplification,          // a region is synthesised before the first frame, nothing later
  kLazyEvaluation,             // visible meshes are made again in every frame; none is kept
};
std::string_view to_string(Paradigm paradigm);  // "pla", "amplify", "lazy"
core::Result<Paradigm> paradigm_from(std::string_view name);

// The modes of Prioritized-Layered Projection: "layers", "solidity".
std::string_view to_string(visibility::PlpMode mode);
core::Result<visibility::PlpMode> plp_mode_from(std::string_view name);

// The defaults suit a machine with a few cores.
struct SceneSettings {
  Paradigm paradigm = Paradigm::kParallelLazyAmplification;
  synthesis::Policy policy = synthesis::Policy::kDeadline;
  visibility::PlpMode plp_mode = visibility::PlpMode::kLayers;
  std::uint32_t modelers = 0;  // threads; 0: usable processors − 1, at least 1; virtual time has 1
  // True if modelers run at the lowest priority of the operating system. Otherwise they take
  // processor time from frames; for comparison only.
  bool modelers_yield = true;
  std::uint64_t budget_bytes = 512ull << 20;  // all geometry: resident, in flight, retired
  // Vertices and indices of the meshes of objects that the host keeps; more is an error.
  std::uint64_t object_budget_bytes = 1ull << 30;
  double view_distance_m = 16'000;  // maximum distance of drawn objects
  double max_error_pixels = 4.0;    // allowed screen-space error
  // Held by a lower resolution of the landscape, then by a larger error; 0: both are fixed.
  double target_frame_ms = 0;
  double min_resolution = 0.6;         // fraction of width and height, 0.25 … 1
  double max_error_factor = 4;         // maximum factor on the error
  double min_size_pixels = 1.5;        // smaller models are not drawn
  double fade_seconds = 0.25;          // duration of fades; 0: no fades
  bool levels_of_detail = true;        // false: full detail everywhere, as in the paper
  bool occlusion = true;               // horizon culling behind ridges
  double calibration_seconds = 0.4;    // maximum at the start, whether or not all was measured
  double watchdog_seconds = 10;        // requests that take longer are abandoned
  double main_thread_budget_ms = 2.0;  // per tick, for missing meshes in view
  double plan_seconds_ahead = 0.05;    // synthesis time per modeler in one plan
  std::uint32_t plan_max_requests = 4096;
  std::uint32_t plan_max_new = 256;  // new reservations per tick
  double streaming_budget_ms = 2.0;  // per tick, for creating nodes
  std::uint32_t streaming_ticks =
      8;  // maximum ticks over which new nodes and their meshes are spread
  std::uint64_t upload_budget_bytes = 16ull << 20;  // per tick
  double step_hz = 60;                              // fixed steps of the simulation a second
  // The virtual clock replaces all others: synthesis and streaming take their predicted times, and
  // results are identical on every machine. Nothing is calibrated.
  bool virtual_time = false;
};

}  // namespace psygen::scene
